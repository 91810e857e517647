# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Initial guesses, and the torque at the toes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.lift_motion import mtp_torque
from lift_predictor.core.models.sagittal.starts import make_starts, smooth_step
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.problem.sampling import sample_times

SPLINE = RestToRestSpline(10, 'acceleration')
DENSE = np.linspace(0.0, 1.0, 61)


@pytest.fixture(scope='module')
def task(outcome, person):
    result = outcome(7.0)
    return build_task(person, result.lift, result.box)


def test_smooth_step_rests_at_both_ends() -> None:
    h = 1e-4
    ends = np.array([0.0, h, 1.0 - h, 1.0])
    step = smooth_step(ends)
    assert (step[0], step[-1]) == (0.0, 1.0)
    # Position, speed and acceleration vanish: the step begins with the third power of time.
    assert step[1] == pytest.approx(10.0 * h**3, rel=1e-3)
    assert 1.0 - step[2] == pytest.approx(10.0 * h**3, rel=1e-3)


def test_all_starts_reach_the_box_at_both_ends(task) -> None:
    starts = make_starts(task, SPLINE)
    assert [start.name for start in starts] == ['recorded motion', 'smooth step', 'clearance arc']
    for start in starts:
        q = SPLINE.basis(DENSE) @ start.control
        grips = chain_positions(q[[0, -1]], task.parameters).joints['hand']
        np.testing.assert_allclose(grips, task.bounds.hand, atol=1e-4)


def test_recorded_start_stays_near_the_recording(task) -> None:
    recorded = make_starts(task, SPLINE)[0]
    q = SPLINE.basis(task.measured.time / task.parameters.duration) @ recorded.control
    assert np.abs(q - task.measured.q).max() < 0.1


def test_smooth_start_passes_the_middle_posture(task) -> None:
    control = make_starts(task, SPLINE)[1].control
    middle = (SPLINE.basis(np.array([0.5])) @ control)[0]
    assert np.all(middle >= task.bounds.posture_lower[1] - 0.02)
    assert np.all(middle <= task.bounds.posture_upper[1] + 0.02)


def test_arc_keeps_a_deep_box_clearer_than_the_smooth_step(task) -> None:
    """A box twice as deep: the arc carries it round the knees, the step through them."""
    deep = replace(task, parameters=replace(task.parameters, box_half=np.array([0.2, 0.1])))
    inner = SPLINE.basis(DENSE[6:-6])
    gaps = {
        start.name: chain_positions(inner @ start.control, deep.parameters).gaps
        for start in make_starts(deep, SPLINE)
    }
    assert gaps['smooth step'].min() < 0.0
    assert gaps['clearance arc'].min() > gaps['smooth step'].min()


def test_samples_cover_the_lift_at_100_per_second() -> None:
    times = sample_times(1.234)
    assert (times[0], times[-1]) == (0.0, 1.234)
    assert np.diff(times).mean() == pytest.approx(0.01, rel=0.01)


def test_toes_carry_only_what_acts_before_them(task, predictor) -> None:
    """Hand computation: standing still, leaning until the ZMP is ahead of the ball of the foot."""
    report, rest = predictor.sagittal.model.library, np.zeros((2, 6))
    q = np.zeros((2, 6))
    q[1, 5] = 0.22
    loads = evaluate(report, q, rest, rest, task.parameters)
    neutral = task.person.neutral
    ball = task.parameters.ankle[0] + neutral['mtp_r'][0] - neutral['ankle_r'][0]
    assert loads.zmp[0] < ball < loads.zmp[1]
    weight = task.parameters.total_mass * task.parameters.gravity
    expected = [0.0, -(loads.zmp[1] - ball) * weight]
    np.testing.assert_allclose(mtp_torque(task, loads), expected, rtol=1e-9)
