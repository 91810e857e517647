# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Initial guesses of the spatial problem: several, as there are local minima."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.parameters import SPLINED
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.problem.run import Start, smooth_step

_DENSE: Final = 41
_ODD: Final = ('pelvis_aside', 'pelvis_turn', 'bending', 'rotation')
"""Coordinates that change their sign in the mirror image."""
_SWAPPED: Final = {'_r': '_l', '_l': '_r'}


def leads_right(task: SpatialTask) -> bool:
    """Whether the box's places lie more to the right than to the left."""
    return bool(task.bounds.hand.reshape(-1, 3)[:, 1].sum() < 0.0)


def mirrored(values: Array) -> Array:
    """Splined coordinates (..., 26) of the mirror image: right and left change sides.

    Random displacements of lifts to the left are mirrored for those to the right, so that both
    have the same result.
    """
    order = [SPLINED.index(name[:-2] + _SWAPPED.get(name[-2:], name[-2:])) for name in SPLINED]
    sign = np.array([-1.0 if name.endswith(_ODD) else 1.0 for name in SPLINED])
    return np.asarray(sign * values[..., order])


def recorded_starts(task: SpatialTask, grid: SpatialGrid) -> tuple[Start, ...]:
    """Return the recorded lift, and a smooth step through its first, middle and last posture.

    Parameters
    ----------
    task : SpatialTask
        With a recorded lift.
    grid : SpatialGrid
        Sizes of the NLP.
    """
    recorded = task.recorded
    assert recorded is not None
    s = np.linspace(0.0, 1.0, _DENSE)
    whole = recorded.time[-1]
    motion = np.stack([np.interp(s * whole, recorded.time, c) for c in recorded.q.T], axis=1)
    mass = float(task.bounds.box_mass.mean() if np.ptp(task.bounds.box_mass) == 0.0 else 0.0)
    return (
        Start('recorded motion', grid.spline.fit(s, motion), mass, task.duration),
        through(task, grid, (motion[0], motion[_DENSE // 2], motion[-1]), 'smooth step', mass),
    )


def through(
    task: SpatialTask,
    grid: SpatialGrid,
    postures: tuple[Array, Array | None, Array],
    name: str,
    mass: float,
) -> Start:
    """Smooth step between two postures (26,), over a middle one if it is given."""
    s = np.linspace(0.0, 1.0, _DENSE)
    first, middle, last = postures
    plain = first + smooth_step(s)[:, None] * (last - first)
    if middle is not None:
        bump = (16.0 * s**2 * (1.0 - s) ** 2)[:, None]
        plain = plain + bump * (middle - plain[_DENSE // 2])
    return Start(name, grid.spline.fit(s, plain), mass, task.duration)
