# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The dense check finds what is put in its way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.models.sagittal.verify import verify
from lift_predictor.core.problem.verification import DENSITY


@pytest.fixture(scope='module')
def solved(outcome, predictor, person):
    result = outcome(7.0)
    task = build_task(person, result.lift, result.box)
    control = result.predicted.runs[0].control

    def check(control=control, parameters=task.parameters, bounds=task.bounds):
        model = predictor.sagittal.model
        return verify(model.library, model.grid, control, parameters, bounds)

    return check, control, task


def test_solution_passes(solved) -> None:
    check = solved[0]()
    assert DENSITY >= 10
    assert check.passed
    assert check.failures() == ''


def test_finds_what_a_moved_control_point_breaks(solved) -> None:
    check, control, _ = solved
    moved = control.copy()
    moved[0, 4] += 0.5
    result = check(control=moved)
    assert not result.passed
    assert result.violation['posture [rad]'] > 0.3
    assert 'knee_angle at 0 %' in result.failures()
    assert result.violation['hand_position [m]'] > 0.05


@pytest.mark.parametrize(
    ('family', 'change'),
    [
        ('joint_torque [N m]', lambda p: replace(p, strength_upper=0.5 * p.strength_upper)),
        ('balance [m]', lambda p: replace(p, support=p.support - 0.15)),
        ('collision [m]', lambda p: replace(p, box_half=p.box_half + 0.1)),
        ('height [m]', lambda p: replace(p, lowest_grip=p.lowest_grip + 0.1)),
    ],
)
def test_finds_a_harder_task(solved, family: str, change) -> None:
    check, _, task = solved
    result = check(parameters=change(task.parameters))
    assert result.violation[family] > 0.01
    assert family in result.failures()
    assert result.excess.max() > 0.0


def test_finds_a_narrower_joint(solved) -> None:
    check, control, task = solved
    limit = float(control[:, 4].max()) - 0.2
    narrow = replace(task.bounds, angle_upper=np.where(np.arange(6) == 4, limit, 9.0))
    result = check(bounds=narrow)
    assert result.violation['joint_angle [rad]'] > 0.05
    assert 'knee_angle' in result.worst['joint_angle [rad]']


def test_excess_sits_at_the_nodes_of_its_interval(solved) -> None:
    check, _, task = solved
    hard = replace(task.parameters, strength_upper=0.8 * task.parameters.strength_upper)
    excess = check(parameters=hard).excess
    assert excess.shape == (2, 25, 35)
    torque_above = excess[1, :, 0]
    assert torque_above.max() > 0.0
    assert torque_above[-1] == 0.0, 'standing with the box does not load the spine to its limit'
