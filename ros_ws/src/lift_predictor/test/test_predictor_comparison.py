# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""RMSE and Pearson r of recorded against predicted lifts."""

from __future__ import annotations

import numpy as np
import pytest

from lift_predictor.core.models.sagittal.lift_model import COMPARED_JOINTS
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.problem.comparison import compare, pearson, rms_difference


def test_pearson_and_rms() -> None:
    a = np.array([1.0, 2.0, 4.0, 3.0])
    assert pearson(a, 2.0 * a + 1.0) == pytest.approx(1.0)
    assert pearson(a, -a) == pytest.approx(-1.0)
    assert pearson(a, a[::-1]) == pytest.approx(np.corrcoef(a, a[::-1])[0, 1])
    assert np.isnan(pearson(a, np.ones(4)))
    assert rms_difference(a, a + 3.0) == pytest.approx(3.0)


def test_a_lift_against_itself_is_no_distance(make_lift, outcome, predictor, person) -> None:
    result = outcome(7.0)
    task = build_task(person, result.lift, result.box)
    model = predictor.sagittal.model
    recorded = task.measured
    coordinates = (recorded.q, recorded.dq, recorded.ddq)
    loads = model.loads(task, coordinates, task.parameters.box_mass)
    same = compare(model.compared_curves(task, recorded.time, recorded.q, loads, 1.0))
    np.testing.assert_allclose(same.joint_rmse, 0.0, atol=1e-9)
    np.testing.assert_allclose(same.joint_pearson, 1.0)
    # The recorded forces come from exact derivatives, these from the recorded angles.
    assert same.vertical_force_rmse < 5.0
    assert same.vertical_force_pearson > 0.999


def test_comparison_is_that_of_the_published_tables(outcome) -> None:
    result = outcome(12.0)
    comparison, motion = result.comparison, result.predicted.lift.motion
    assert COMPARED_JOINTS == ('spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle')
    for column, joint in enumerate(JOINTS):
        apart = np.degrees(motion.coordinate(joint) - result.lift.motion.coordinate(joint))
        expected = np.sqrt(np.mean(apart**2))
        assert comparison.joint_rmse[column] == pytest.approx(expected, abs=1e-3)
    force, recorded = (m.ground_force.sum(axis=1) for m in (motion, result.lift.motion))
    expected = np.corrcoef(force[:, 2], recorded[:, 2])[0, 1]
    assert comparison.vertical_force_pearson == pytest.approx(expected, abs=1e-6)
    expected = np.sqrt(np.mean((force[:, 0] - recorded[:, 0]) ** 2))
    assert comparison.horizontal_force_rmse == pytest.approx(expected, abs=1e-6)
    assert comparison.measured.torque.shape == (len(comparison.time), 6)
