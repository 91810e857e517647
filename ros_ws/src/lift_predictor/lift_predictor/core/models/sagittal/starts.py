# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Initial guesses: several, as there are local minima (box round or in front of the knees)."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.models.sagittal.kinematics import chain_positions, reach
from lift_predictor.core.models.sagittal.plane import SagittalMotion
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.problem.run import Start, smooth_step

_DENSE: Final = 41
_ARC_POSTURES: Final = 9


def make_starts(task: SagittalTask, spline: RestToRestSpline) -> tuple[Start, ...]:
    """Return the recorded lift, a smooth step, and an arc clear of the body, as control values.

    All begin and end with the postures that reach the box. Without a recording (a planned lift)
    the first is left out.
    """
    s = np.linspace(0.0, 1.0, _DENSE)
    step = smooth_step(s)[:, None]
    first, last = task.ends

    plain = first + step * (last - first)
    middle = np.clip(
        plain[_DENSE // 2], task.bounds.posture_lower[1], task.bounds.posture_upper[1]
    )
    bump = (16.0 * s**2 * (1.0 - s) ** 2)[:, None]
    through_middle = plain + bump * (middle - plain[_DENSE // 2])
    generated = (
        Start('smooth step', spline.fit(s, through_middle)),
        Start('clearance arc', _arc(task, spline, s, through_middle)),
    )
    if task.measured is None:
        return generated
    recorded = _resampled(task.measured, task.parameters.duration, s)
    recorded = recorded + (1.0 - step) * (first - recorded[0]) + step * (last - recorded[-1])
    return (Start('recorded motion', spline.fit(s, recorded)), *generated)


def _resampled(measured: SagittalMotion, duration: float, s: Array) -> Array:
    return np.stack([np.interp(s, measured.time / duration, c) for c in measured.q.T], axis=1)


def _arc(task: SagittalTask, spline: RestToRestSpline, s: Array, guide: Array) -> Array:
    """Raise the hands before they go forward; push them where the box would touch the body."""
    begin, finish = task.bounds.hand
    lower, upper = task.bounds.angle_lower, task.bounds.angle_upper
    at = np.linspace(0.0, 1.0, _ARC_POSTURES)
    w = smooth_step(at)
    postures = [task.ends[0]]
    for i in range(1, _ARC_POSTURES - 1):
        reference = np.array([np.interp(at[i], s, column) for column in guide.T])
        grip = np.array(
            [
                begin[0] + (finish[0] - begin[0]) * w[i] ** 2,
                begin[1] + (finish[1] - begin[1]) * w[i],
            ]
        )
        posture, _ = reach(grip, reference, lower, upper, task.parameters)
        deficit = float(
            max(-chain_positions(posture, task.parameters, grip[None]).gaps.min(), 0.0)
        )
        if deficit > 0.0:
            grip = grip + np.array([deficit, 0.0])
            posture, _ = reach(grip, reference, lower, upper, task.parameters)
        postures.append(posture)
    postures.append(task.ends[1])
    path = np.stack(postures)
    return spline.fit(s, np.stack([np.interp(s, at, column) for column in path.T], axis=1))
