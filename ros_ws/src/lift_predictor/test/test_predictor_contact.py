# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The box of true size against round parts of the body, and the ranges of people."""

from __future__ import annotations

import numpy as np
import pytest

from lift_predictor.core.models.contact import clearance, gaps, semi_axes
from lift_predictor.core.models.passive import passive_hip_moment
from lift_predictor.core.models.ranges import hamstring_room, hip_range, ranges
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.parameters import HIP, JOINTS, KNEE


@pytest.mark.parametrize('half', [(0.119, 0.0635), (0.119, 0.1525, 0.0635), (0.2, 0.35, 0.3)])
def test_exact_distance_is_that_of_the_nearest_point_of_the_box(half) -> None:
    size, rng = np.array(half), np.random.default_rng(1)
    centre = rng.uniform(-0.6, 0.6, (50, len(half)))
    nearest = np.clip(centre, -size, size)
    outside = np.any(np.abs(centre) > size, axis=1)
    expected = np.linalg.norm(centre - nearest, axis=1) - 0.05
    found = gaps(centre, size, np.full(50, 0.05))
    np.testing.assert_allclose(found[outside], expected[outside], atol=1e-12)
    assert np.all(found[~outside] <= -0.05)
    assert np.isinf(gaps(centre[:1], size, np.zeros(1))).all()


@pytest.mark.parametrize('half', [(0.119, 0.0635), (0.119, 0.1525, 0.0635), (0.2, 0.35, 0.3)])
@pytest.mark.parametrize('radius', [0.03, 0.06, 0.12])
def test_smooth_shape_contains_the_box_grown_by_the_radius(half, radius) -> None:
    size, rng = np.array(half), np.random.default_rng(2)
    axes = semi_axes(size, np.array([radius]))[0]
    centre = rng.uniform(-1.2, 1.2, (20000, len(half))) * axes
    clear = clearance(list(centre.T), list(axes), np.sqrt) > 0.0
    exact = gaps(centre[:, None], size, np.array([radius]))[:, 0]
    # Directions are sampled every 7.5 degrees.
    assert exact[clear].min() > -5e-4
    assert np.all(axes < 1.15 * (size + radius))


def test_hips_flex_less_over_straight_knees() -> None:
    limit = np.array(hip_range())
    straight, bent = hamstring_room(np.radians([90.0, 90.0]), np.radians([0.0, 90.0]), limit)
    assert straight < 0.0 < bent
    assert np.degrees(-straight) == pytest.approx(90.0 - 69.4)


def test_passive_moment_is_the_published_one() -> None:
    hip, knee = np.radians([0.0, 120.0, 90.0]), np.radians([0.0, 65.0, 20.0])
    np.testing.assert_allclose(
        passive_hip_moment(hip, knee, np.exp), [8.6, -26.1, -29.8], atol=0.1
    )


def test_spine_turns_no_more_than_people_can() -> None:
    both = ranges('3d_40dof')
    turn = sum(both[f'{joint}_rotation'][1] for joint in ('lumbar', 'thorax'))
    assert np.degrees(turn) == pytest.approx(39.2, abs=0.2)
    bend = sum(both[f'{joint}_extension'][0] for joint in ('lumbar', 'thorax'))
    assert np.degrees(bend) == pytest.approx(-60.0, abs=0.1)


@pytest.mark.parametrize('mass', [7.0, 12.0])
def test_predicted_lift_is_possible_for_a_body(outcome, predictor, subject, mass) -> None:
    result = outcome(mass)
    predicted = result.predicted
    assert predicted.report.ok, predicted.report.message
    motion = predicted.lift.motion
    parameters = predictor.sagittal.model.recorded_task(
        subject, result.lift, result.box
    ).parameters
    q = np.stack([motion.position[:, motion.coordinates.index(joint)] for joint in JOINTS], 1)
    state = chain_positions(q, parameters)
    assert state.gaps.min() > -1e-3
    room = hamstring_room(q[:, HIP], q[:, KNEE], parameters.hip_range)
    assert room.min() > -1e-3
    box = motion.box_position
    step = motion.time[1] - motion.time[0]
    acceleration = np.linalg.norm(np.diff(box, 2, axis=0), axis=1) / step**2
    assert acceleration.max() < parameters.box_acceleration + 0.1
    assert acceleration[[0, -1]].max() < 0.25 * parameters.box_acceleration
