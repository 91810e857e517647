# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Differences between this project's answer and OpenSim's, quantity by quantity.

Both get the same positions and the same forces from outside. The torques are those of splines
through the positions on both sides; how far the rates that the analysis itself uses lead from
them is a row of its own. Rows that say "equal torques" or "equal muscle forces" put OpenSim's
result of the step before into this project's step, so that they show one step alone.

OpenSim minimises the sum of squared activations; it has no min/max. With another criterion of the
analysis, activations, muscle forces and the load under them answer another question: they are
left out and named (`DIFFERENT_PROBLEM`), and all rows that take OpenSim's activations or forces
stay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array
from muscle_analyzer.core.loads.disc_frame import disc_load
from muscle_analyzer.core.loads.joint_loads import lumbosacral_body
from muscle_analyzer.core.loads.lumbar_balance import ROOT_COORDINATES
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel
from muscle_analyzer.core.opensim_bridge.own_results import OwnSide
from muscle_analyzer.core.opensim_bridge.results import Answer, OpenSimRun
from muscle_analyzer.core.recruitment.static_optimization import Criterion

Rows = NDArray[np.int64]

_TRANSLATIONS = ('_tx', '_ty', '_tz')
_MM = 1e3
#: Rows that compare answers to the same question only if both criteria are sums of squares.
DIFFERENT_PROBLEM = ('activation', 'muscle force', 'force on L5-S1')


@dataclass(frozen=True)
class Difference:
    """How far two sets of numbers are apart.

    Attributes
    ----------
    quantity, unit : str
    count : int
        Numbers compared.
    where : str
        Place of the largest difference.
    ours, opensim : float
        The two numbers there.
    largest, rms, median : float
        Of the absolute differences.
    percent_of_peak : float
        The largest difference in per cent of OpenSim's largest absolute number.
    """

    quantity: str
    unit: str
    count: int
    where: str
    ours: float
    opensim: float
    largest: float
    rms: float
    median: float
    percent_of_peak: float


@dataclass(frozen=True)
class Instant:
    """The L5-S1 joint and the cost at one instant; loads in the disc frame, N."""

    time: float
    compression: tuple[float, float]
    anterior_shear: tuple[float, float]
    lateral_shear: tuple[float, float]
    cost_equal_torques: tuple[float, float]


@dataclass(frozen=True)
class Comparison:
    """All differences of one motion; pairs are (this project, OpenSim).

    Attributes
    ----------
    differences : tuple of Difference
    instants : tuple of Instant
    version : str
        Of OpenSim.
    seconds : mapping of str to list of float
        Wall time of OpenSim's tools.
    criterion : str
        Of the analysis; OpenSim's is the sum of squares.
    not_compared : tuple of str
        Quantities left out because the two criteria differ.
    """

    differences: tuple[Difference, ...]
    instants: tuple[Instant, ...]
    version: str
    seconds: dict[str, list[float]]
    criterion: str = Criterion.SQUARES.value
    not_compared: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain data."""
        return asdict(self)

    def difference(self, quantity: str) -> Difference:
        """Return the row of a quantity."""
        return next(row for row in self.differences if row.quantity == quantity)


def difference(
    quantity: str, unit: str, ours: Array, opensim: Array, where: Callable[[tuple[int, ...]], str]
) -> Difference:
    """Compare two arrays of one shape.

    Parameters
    ----------
    quantity, unit : str
    ours, opensim : arrays
    where : callable
        Puts the index of an element into words.
    """
    gap = np.abs(ours - opensim)
    index = tuple(int(i) for i in np.unravel_index(int(np.argmax(gap)), gap.shape))
    peak = float(np.abs(opensim).max())
    return Difference(
        quantity=quantity,
        unit=unit,
        count=int(gap.size),
        where=where(index),
        ours=float(ours[index]),
        opensim=float(opensim[index]),
        largest=float(gap[index]),
        rms=float(np.sqrt(np.mean(gap**2))),
        median=float(np.median(gap)),
        percent_of_peak=100.0 * float(gap[index]) / peak if peak else float(gap[index] != 0.0),
    )


def compare(
    motion: MotionOnModel,
    splined: MotionOnModel,
    rows: Rows,
    run: OpenSimRun,
    options: MuscleAnalyzerOptions,
) -> Comparison:
    """Compare a motion's analysis with OpenSim's.

    Parameters
    ----------
    motion : MotionOnModel
        With the rates that the analysis uses.
    splined : MotionOnModel
        The same with those of splines through its positions.
    rows : (k,) int array
        Samples that OpenSim solved.
    run : OpenSimRun
        Of the exported motion.
    options : MuscleAnalyzerOptions

    Raises
    ------
    OpenSimError
        If a sample cannot be solved on this side.
    """
    own = OwnSide(splined, options)
    mine, other = own.answer(rows), run.answer
    at = [f'{time:.3f} s' for time in splined.time[rows]]
    optima = [
        own.optimum(int(k), *given)
        for k, *given in zip(rows, other.force, other.activation, other.reserve, strict=True)
    ]
    equal = np.array(
        [own.reactions(int(k), force) for k, force in zip(rows, other.force, strict=True)]
    )
    # What OpenSim's activations make of this project's muscles and reactions.
    borrowed = other.activation * mine.force / mine.activation
    carried = np.array(
        [own.reactions(int(k), force) for k, force in zip(rows, borrowed, strict=True)]
    )

    def muscle(index: tuple[int, ...]) -> str:
        return f'{own.muscle_names[index[1]]}, {at[index[0]]}'

    def arm(index: tuple[int, ...]) -> str:
        about = own.coordinate_names[index[2]]
        return f'{own.muscle_names[index[1]]} about {about}, {at[index[0]]}'

    def joint(index: tuple[int, ...]) -> str:
        return f'{motion.model.joint_names[1 + index[1]]}, {at[index[0]]}'

    def instant(index: tuple[int, ...]) -> str:
        return at[index[0]]

    here = motion.model.body_index(lumbosacral_body(motion.model))
    own_rates = OwnSide(motion, options).torques()
    rows_of_table = [
        *_torque_rows(splined, mine.torque, other.torque, ''),
        *_torque_rows(splined, own_rates, other.torque, ', rates of the analysis')[:1],
        difference('path length', 'mm', _MM * mine.length, _MM * other.length, muscle),
        difference('moment arm', 'mm', _MM * mine.moment_arm, _MM * other.moment_arm, arm),
        difference(
            'muscle strength', 'N', mine.force / mine.activation, other.force / other.activation,
            muscle,
        ),
        difference('activation', '1', mine.activation, other.activation, muscle),
        difference('muscle force', 'N', mine.force, other.force, muscle),
        difference('muscle force, equal activations', 'N', borrowed, other.force, muscle),
        difference(
            'muscle force, equal torques', 'N', np.array([f for *_, f in optima]), other.force,
            muscle,
        ),
        difference(
            'cost, equal torques', '1', np.array([ours for ours, *_ in optima]),
            np.array([theirs for _, theirs, _ in optima]), instant,
        ),
        difference(
            'force on L5-S1', 'N', _size(mine.reaction[:, here]), _size(other.reaction[:, here]),
            instant,
        ),
        difference(
            'force on L5-S1, equal activations', 'N', _size(carried[:, here]),
            _size(other.reaction[:, here]), instant,
        ),
        difference(
            'force on L5-S1, equal muscle forces', 'N', _size(equal[:, here]),
            _size(other.reaction[:, here]), instant,
        ),
        difference(
            'force on any joint, equal muscle forces', 'N', equal[:, 1:, 3:],
            other.reaction[:, 1:, 3:], joint,
        ),
    ]  # fmt: skip
    instants = _instants(own, rows, mine, other, optima)
    criterion = Criterion(options.static_optimization.criterion)
    left_out = () if criterion is Criterion.SQUARES else DIFFERENT_PROBLEM
    return Comparison(
        tuple(row for row in rows_of_table if row.quantity not in left_out),
        instants, run.version, run.seconds, criterion.value, left_out,
    )  # fmt: skip


def _size(wrenches: Array) -> Array:
    size: Array = np.linalg.norm(wrenches[:, 3:], axis=1)
    return size


def _torque_rows(
    motion: MotionOnModel, ours: Array, opensim: Array, label: str
) -> list[Difference]:
    """Return rows for the joints, and for what is left over at the pelvis."""
    names = motion.model.tree_coordinate_names
    root = np.array([name.startswith(ROOT_COORDINATES) for name in names])
    shift = np.array([name.endswith(_TRANSLATIONS) for name in names])
    found = []
    for quantity, unit, chosen in (
        ('joint torque', 'N m', ~root),
        ('pelvis residual moment', 'N m', root & ~shift),
        ('pelvis residual force', 'N', root & shift),
    ):
        columns = np.flatnonzero(chosen & np.isfinite(opensim).all(axis=0))
        if columns.size == 0:
            continue

        def where(index: tuple[int, ...], columns: Rows = columns) -> str:
            return f'{names[columns[index[1]]]}, {motion.time[index[0]]:.3f} s'

        found.append(
            difference(quantity + label, unit, ours[:, columns], opensim[:, columns], where)
        )
    return found


def _instants(
    own: OwnSide, rows: Rows, mine: Answer, other: Answer, optima: list[tuple[float, float, Array]]
) -> tuple[Instant, ...]:
    """Return the loads of both sides in the disc frame, instant by instant."""
    here = own.motion.model.body_index(lumbosacral_body(own.motion.model))
    found = []
    for i, k in enumerate(rows):
        rotation = own.disc_rotation(int(k))
        ours, theirs = (disc_load(a.reaction[i, here], rotation) for a in (mine, other))
        found.append(
            Instant(
                time=float(own.motion.time[k]),
                compression=(ours.compression, theirs.compression),
                anterior_shear=(ours.anterior_shear, theirs.anterior_shear),
                lateral_shear=(ours.lateral_shear, theirs.lateral_shear),
                cost_equal_torques=optima[i][:2],
            )
        )
    return tuple(found)
