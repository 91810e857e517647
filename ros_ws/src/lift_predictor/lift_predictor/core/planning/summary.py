# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The key figures of a planned lift, and the whole of it as plain data."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from lift_predictor.core.options import SPATIAL
from lift_predictor.core.planning.planned_lift import PlannedLift


@dataclass(frozen=True)
class TorquePeak:
    """Instant at which a joint is nearest to one of its dynamic limits.

    Attributes
    ----------
    joint : str
        Joint coordinate.
    time : float
        From the start of the lift [s].
    torque, limit : float
        Both limbs together [N m]; the limit is the one that is nearer.
    share : float
        Torque by limit; 1: at the limit.
    """

    joint: str
    time: float
    torque: float
    limit: float
    share: float


@dataclass(frozen=True)
class PlanSummary:
    """A planned lift in a few numbers; empty without a lift.

    Attributes
    ----------
    box_mass, effort, duration : float
        [kg], integral of the squared normalised torques [s], [s].
    technique_index : float
        Stoop-Squat-Index of the first posture; NaN where C7 is not lowered.
    ankle, left, heading : float
        Middle of the ankles, forward and to the left [m]; direction of the feet [rad].
    peaks : tuple of TorquePeak
        One a joint, as the prediction orders them.
    active_constraints : tuple of str
        Limits that hold the effort back, the strongest first.
    peak_vertical_force, largest_horizontal_force : float
        Ground reaction of both feet [N].
    box_path : tuple of (time, forward, left, up)
        Box centre at eleven even instants [s], [m].
    """

    box_mass: float
    effort: float
    duration: float
    technique_index: float
    ankle: float
    left: float
    heading: float
    peaks: tuple[TorquePeak, ...]
    active_constraints: tuple[str, ...]
    peak_vertical_force: float
    largest_horizontal_force: float
    box_path: tuple[tuple[float, float, float, float], ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        plain = asdict(self)
        plain['binding'] = plain.pop('active_constraints')
        return plain


def summarise(planned: PlannedLift) -> PlanSummary | None:
    """Return the summary of a plan; None without a lift."""
    prediction = planned.prediction
    if not prediction.report.ok or prediction.lift is None:
        return None
    motion = prediction.lift.motion
    time = motion.time - motion.time[0]
    ground = motion.ground_force.sum(axis=1)
    rows = np.round(np.linspace(0, len(motion) - 1, 11)).astype(int)
    hands = motion.points[:, [motion.point_names.index(f'hand_{side}') for side in 'rl']].mean(
        axis=1
    )
    box = np.where(np.isfinite(motion.box_position), motion.box_position, hands)
    spatial = prediction.model == SPATIAL
    return PlanSummary(
        box_mass=prediction.box_mass,
        effort=prediction.effort if spatial else prediction.sampled_effort,
        duration=prediction.duration,
        technique_index=planned.index,
        ankle=planned.feet.forward,
        left=planned.feet.left,
        heading=planned.feet.heading,
        peaks=tuple(_peak(planned, time, j) for j in range(len(prediction.torque_names))),
        active_constraints=prediction.active_constraints,
        peak_vertical_force=float(ground[:, 2].max()),
        largest_horizontal_force=float(np.abs(ground[:, 0]).max()),
        box_path=tuple(
            (float(time[i]), float(box[i, 0]), float(box[i, 1]), float(box[i, 2])) for i in rows
        ),
    )


def _peak(planned: PlannedLift, time: np.ndarray[Any, Any], column: int) -> TorquePeak:
    prediction = planned.prediction
    torque = prediction.torque[:, column]
    limit = np.where(
        torque >= 0.0, prediction.torque_upper[:, column], prediction.torque_lower[:, column]
    )
    share = torque / limit
    row = int(np.argmax(share))
    return TorquePeak(
        prediction.torque_names[column],
        float(time[row]),
        float(torque[row]),
        float(limit[row]),
        float(share[row]),
    )
