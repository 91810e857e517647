# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays of a block from one set of axes to the other, against the same in numpy."""

import numpy as np
import pytest

from human_model.frames import from_opensim, to_opensim
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.loads.block_arrays import (
    ANGLE_GOAL,
    DISTANCE_GOAL,
    OutsideForces,
    Places,
    outside_wrenches,
    solved_arrays,
)

N, N_J, N_P, N_F = 3, 4, 6, 5
RNG = np.random.default_rng(2)
PLACES = Places(
    n_bodies=7,
    feet=np.array([1, 2]),
    hands=np.array([5, 6]),
    lumbosacral=2,
    hand_points=np.array([[0, 1], [2, 1]]),
    foot_points=np.array([[3, 4, 5], [5, 4, 0]]),
    thorax=4,
    hand_frames=np.array([1, 0]),
    foot_frames=np.array([2, 3]),
)


@pytest.fixture(scope='module')
def held():
    return boxed(PLACES)


@pytest.fixture
def forces():
    return OutsideForces(
        *(RNG.normal(size=(N, 2, 3)) for _ in range(4)), RNG.normal(size=(N, 8, 3)),
        np.array([6, 3]),
    )  # fmt: skip


def test_wrench_is_moment_about_the_origin_and_force(held, forces):
    given = outside_wrenches(held, forces)
    assert given.loaded.all() and given.complete.all()
    for side, body in enumerate(PLACES.feet):
        force, place = forces.ground_force[:, side], forces.centre_of_pressure[:, side]
        moment = np.cross(place, force) + forces.free_moment[:, side]
        np.testing.assert_allclose(given.external[:, body, 3:], to_opensim(force))
        np.testing.assert_allclose(given.external[:, body, :3], to_opensim(moment), atol=1e-12)
    for side, body in enumerate(PLACES.hands):
        force, place = forces.hand_force[:, side], forces.points[:, forces.hands[side]]
        np.testing.assert_allclose(given.external[:, body, 3:], to_opensim(force))
        moment = to_opensim(np.cross(place, force))
        np.testing.assert_allclose(given.external[:, body, :3], moment, atol=1e-12)
    assert not given.external[:, [0, 3, 4]].any()


@pytest.mark.parametrize('axis', [0, 1, 2])
def test_foot_without_centre_of_pressure_is_not_pushed(held, forces, axis):
    forces.centre_of_pressure[1, 0, axis] = np.nan
    given = outside_wrenches(held, forces)
    assert given.loaded.tolist() == [[True, True], [False, True], [True, True]]
    assert given.complete.tolist() == [True, False, True]
    assert not given.external[1, PLACES.feet[0]].any()
    assert np.isfinite(given.external).all()


def solved(held, distance, angle):
    joint_force, joint_moment = RNG.normal(size=(2, N, N_J, 3))
    net, residual = RNG.normal(size=(N, 2, 3)), RNG.normal(size=(N, 6))
    pose = np.tile(np.eye(3, 4), (N, 1, 1))
    out = solved_arrays(held, pose, joint_force, joint_moment, net, residual, distance, angle)
    return out, joint_force, joint_moment, net, residual


def test_results_are_in_the_axes_of_motions(held):
    distance, angle = RNG.random((N, N_P)), RNG.random((N, N_F))
    out, force, moment, net, residual = solved(held, distance, angle)
    np.testing.assert_array_equal(out.l5_s1_force, force[:, 2])
    np.testing.assert_array_equal(out.l5_s1_moment, moment[:, 2])
    np.testing.assert_allclose(out.compression_per_degree, np.deg2rad(force[:, 2, 0]))
    np.testing.assert_allclose(out.anterior_shear_per_degree, np.deg2rad(force[:, 2, 2]))
    np.testing.assert_array_equal(out.net_moment_top_down, from_opensim(net[:, 0]))
    np.testing.assert_array_equal(out.net_moment_bottom_up, from_opensim(net[:, 1]))
    np.testing.assert_array_equal(out.pelvis_residual[:, :3], from_opensim(residual[:, 3:]))
    np.testing.assert_array_equal(out.pelvis_residual[:, 3:], from_opensim(residual[:, :3]))
    for name, places in (('hand', PLACES.hand_points), ('foot', PLACES.foot_points)):
        largest = distance[:, places].max(axis=2)
        np.testing.assert_array_equal(getattr(out, f'{name}_distance'), largest)
    np.testing.assert_array_equal(out.trunk_angle, angle[:, 4])
    np.testing.assert_array_equal(out.hand_angle, angle[:, PLACES.hand_frames])
    np.testing.assert_array_equal(out.foot_angle, angle[:, PLACES.foot_frames])


@pytest.mark.parametrize('place', [*range(N_P), *range(-N_F, 0)])
def test_each_missed_goal_counts(held, place):
    distance, angle = np.full((N, N_P), DISTANCE_GOAL), np.full((N, N_F), ANGLE_GOAL)
    assert not solved(held, distance, angle)[0].missed.any()
    for value in (np.nan, 2.0):
        (distance if place >= 0 else angle)[1, place] = value
        assert solved(held, distance, angle)[0].missed.tolist() == [False, True, False]
