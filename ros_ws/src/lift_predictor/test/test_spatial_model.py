# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The spatial model against the skeleton, Pinocchio and finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from human_model.constants import GRAVITY
from human_model.skeleton import ExternalForce
from human_model.subject import Subject
from lift_predictor.core.models.passive import passive_hip_moment
from lift_predictor.core.models.spatial.assembly import spatial_library
from lift_predictor.core.models.spatial.coordinates import skeleton_motion
from lift_predictor.core.models.spatial.evaluation import evaluate
from lift_predictor.core.models.spatial.parameters import (
    DEPENDENT,
    SIDES,
    SPLINED,
    STRONG,
    SpatialParameters,
)
from lift_predictor.core.models.spatial.person import SpatialPerson

WIDTH = 0.305
MOST_LIST = 0.5


@pytest.fixture(scope='module')
def who(subject: Subject) -> SpatialPerson:
    return SpatialPerson.of(subject)


def placed(who: SpatialPerson, half=0.15, ahead=0.02, turns=(-0.14, 0.2)) -> SpatialParameters:
    height = who.ankle_height
    return SpatialParameters(
        **who.fields(),
        ankle=np.array([[-ahead, -half, height], [ahead, half, height]]),
        foot_turn=np.array(turns),
        box_half=np.array([0.119, 0.1525, 0.0635]),
        box_acceleration=1e3,
        box_width=WIDTH,
        box_turning=0.13,
        box_from_hand=np.array([0.02, 0.0, 0.03]),
        way=np.array([[0.3, 1.0, 0.0, 0.0], [0.3, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
    )


def random_motion(rng: np.random.Generator, n: int):
    q = np.zeros((n, len(SPLINED)))
    q[:, :6] = np.array([0.3, 1.2, 0.03, 0.1, 1.0, 0.8]) + 0.05 * rng.normal(size=(n, 6))
    q[:, 6:] = 0.4 * rng.normal(size=(n, len(SPLINED) - 6))
    return q, rng.normal(size=q.shape), 3.0 * rng.normal(size=q.shape)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    st.tuples(
        st.floats(0.0, 0.6), st.floats(-0.3, 2.2), st.floats(-0.12, 0.12), st.floats(-0.6, 0.6),
        st.floats(0.0, 2.0), st.floats(-0.15, 0.15),
    ),
    st.floats(0.06, 0.22),
    st.floats(-0.08, 0.08),
    st.tuples(st.floats(-0.5, 0.2), st.floats(-0.2, 0.5)),
)  # fmt: skip
def test_feet_stay_for_any_root(who, root, half, ahead, turns) -> None:
    """Legs in closed form: feet flat and where they belong, also with straight knees."""
    parameters = placed(who, half, ahead, turns)
    q = np.zeros((1, len(SPLINED)))
    q[0, :4] = root[:4]
    q[0, 4] = root[4]
    q[0, 5] = max(root[4] + root[5], 0.0)
    skeleton = who.skeleton
    with np.errstate(invalid='ignore'):
        position = skeleton_motion(q, 0 * q, 0 * q, parameters, skeleton.coordinates)[0][0]
    # Some roots would need a pelvis that stands on its side, or have no solution at all.
    assume(np.all(np.isfinite(position)))
    assume(abs(position[skeleton.index('pelvis_list')]) < MOST_LIST)
    frames = skeleton.forward(position)
    for k, side in enumerate(SIDES):
        foot = frames[skeleton.parameters.index(f'foot_{side}')]
        np.testing.assert_allclose(foot[:3, 3], parameters.ankle[k], atol=1e-10)
        c, s = np.cos(turns[k]), np.sin(turns[k])
        flat = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
        np.testing.assert_allclose(foot[:3, :3], flat, atol=1e-10)
    for name in ('knee_angle_r', 'knee_angle_l'):
        assert position[skeleton.index(name)] == q[0, SPLINED.index(name)]


def test_turned_laboratory_turns_the_pelvis_only(who) -> None:
    rng = np.random.default_rng(5)
    parameters, motion = placed(who), random_motion(np.random.default_rng(5), 3)
    names = who.skeleton.coordinates
    here = skeleton_motion(*motion, parameters, names)
    origin = rng.normal(size=3)
    there = skeleton_motion(*motion, parameters, names, 0.4, origin)
    np.testing.assert_allclose(there[0][:, 6:], here[0][:, 6:], atol=1e-12)
    turn = np.array([[np.cos(0.4), -np.sin(0.4), 0], [np.sin(0.4), np.cos(0.4), 0], [0, 0, 1]])
    for i in range(3):
        moved = who.skeleton.points(here[0][i])
        for name, point in who.skeleton.points(there[0][i]).items():
            np.testing.assert_allclose(point, turn @ moved[name] + origin, atol=1e-12)


def test_rates_are_derivatives_of_the_closed_form(who) -> None:
    """Central differences of positions along a motion give velocity and acceleration."""
    rng = np.random.default_rng(2)
    parameters = placed(who)
    q, dq, ddq = random_motion(rng, 1)
    h = 1e-4
    t = np.array([-h, 0.0, h])[:, None]
    path = q + t * dq + 0.5 * t**2 * ddq
    names = who.skeleton.coordinates
    _, velocity, acceleration = skeleton_motion(q, dq, ddq, parameters, names)
    along = skeleton_motion(path, 0 * path, 0 * path, parameters, names)[0]
    np.testing.assert_allclose((along[2] - along[0]) / (2 * h), velocity[0], atol=2e-6)
    np.testing.assert_allclose(
        (along[2] - 2 * along[1] + along[0]) / h**2, acceleration[0], atol=2e-4
    )


def external_forces(loads, i: int) -> list[ExternalForce]:
    forces = []
    for k, side in enumerate(SIDES):
        free = (0.0, 0.0, loads.free_moment[i, k])
        forces.append(
            ExternalForce(f'foot_{side}', loads.ground_force[i, k], loads.pressure[i, k], free)
        )
        forces.append(ExternalForce(f'hand_{side}', loads.hand_force[i, k], loads.hand[i, k]))
    return forces


def test_torques_and_limits_are_those_of_the_skeleton(who) -> None:
    """Moving far from equilibrium: no residual at the pelvis, same torques and limits to 1e-9."""
    parameters, motion = placed(who), random_motion(np.random.default_rng(0), 6)
    loads = evaluate(spatial_library(), *motion, 7.0, parameters)
    skeleton = who.skeleton
    full = skeleton_motion(*motion, parameters, skeleton.coordinates)
    columns = [skeleton.index(name) for name in STRONG]
    low, high = who.strength.limit_arrays(skeleton.coordinates, full[0], full[1])
    for side in SIDES:
        hip = skeleton.index(f'hip_flexion_{side}')
        knee = full[0][:, skeleton.index(f'knee_angle_{side}')]
        passive = passive_hip_moment(full[0][:, hip], knee, np.exp)
        low[:, hip] += passive
        high[:, hip] += passive
    np.testing.assert_allclose(loads.lower, low[:, columns], atol=1e-9)
    np.testing.assert_allclose(loads.upper, high[:, columns], atol=1e-9)
    for i in range(6):
        torque = skeleton.inverse_dynamics(*(part[i] for part in full), external_forces(loads, i))
        np.testing.assert_allclose(torque[:6], 0.0, atol=1e-9)
        np.testing.assert_allclose(torque[columns], loads.torque[i], atol=1e-9)
        points = skeleton.points(full[0][i])
        for k, side in enumerate(SIDES):
            np.testing.assert_allclose(points[f'hand_{side}'], loads.hand[i, k], atol=1e-12)
    own = [skeleton.index(name) for name in DEPENDENT]
    np.testing.assert_allclose(full[0][:, own], loads.angles, atol=1e-12)


def test_torques_are_those_of_pinocchio(who) -> None:
    pin = pytest.importorskip('pinocchio', reason='Pinocchio (package pin) is not installed')
    parameters, motion = placed(who), random_motion(np.random.default_rng(9), 3)
    loads = evaluate(spatial_library(), *motion, 12.0, parameters)
    skeleton = who.skeleton
    tree, body = skeleton.tree, skeleton.parameters
    model, ids = pin.Model(), {-1: 0}
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    for j, name in enumerate(skeleton.coordinates):
        kind = (pin.JointModelRevoluteUnaligned, pin.JointModelPrismaticUnaligned)[tree.kind[j]]
        place = pin.SE3(np.eye(3), tree.offset[j])
        ids[j] = model.addJoint(ids[int(tree.parent[j])], kind(*tree.axis[j]), place, name)
    for i in range(len(body.segments)):
        parts = np.array(body.com[i]), np.array(body.inertia[i])
        inertia = pin.Inertia(float(body.mass[i]), *parts)
        at = pin.SE3(np.eye(3), tree.segment_offset[i])
        model.appendBodyToJoint(ids[int(tree.segment_body[i])], inertia, at)
    data = model.createData()
    order = [model.joints[ids[j]].idx_q for j in range(len(skeleton.coordinates))]
    full = skeleton_motion(*motion, parameters, skeleton.coordinates)
    for i in range(3):
        vectors = np.empty((3, len(order)))
        vectors[:, order] = [part[i] for part in full]
        pin.forwardKinematics(model, data, vectors[0])
        forces = [pin.Force.Zero() for _ in range(model.njoints)]
        for load in external_forces(loads, i):
            joint = ids[int(tree.segment_body[body.index(load.segment)])]
            moment = np.cross(load.point, load.force) + np.asarray(load.moment)
            forces[joint] += data.oMi[joint].actInv(pin.Force(np.asarray(load.force), moment))
        theirs = np.asarray(pin.rnea(model, data, *vectors, forces))[order]
        np.testing.assert_allclose(theirs[:6], 0.0, atol=1e-9)
        columns = [skeleton.index(name) for name in STRONG]
        np.testing.assert_allclose(theirs[columns], loads.torque[i], atol=1e-9)


def test_ground_is_divided_so_that_both_feet_together_are_the_whole(who) -> None:
    """Centres of pressure at one share of the feet, their weighted mean that of the whole."""
    parameters = placed(who, ahead=0.0, turns=(-0.1, 0.1))
    q = np.zeros((1, len(SPLINED)))
    q[0, :6] = [0.12, 0.25, 0.03, 0.0, 0.2, 0.2]
    loads = evaluate(spatial_library(), q, 0 * q, 0 * q, 0.0, parameters)
    weight = parameters.body_mass * parameters.gravity
    np.testing.assert_allclose(loads.ground_force[0].sum(axis=0), [0, 0, weight], atol=1e-9)
    assert loads.ground_force[0, 1, 2] > loads.ground_force[0, 0, 2] > 0.0, 'leans to the left'
    centre = who.skeleton.centre_of_mass(
        skeleton_motion(q, 0 * q, 0 * q, parameters, who.skeleton.coordinates)[0][0]
    )
    np.testing.assert_allclose(loads.zmp[0], centre[:2], atol=1e-9)
    back, front = parameters.sole
    for k in range(2):
        c, s = np.cos(parameters.foot_turn[k]), np.sin(parameters.foot_turn[k])
        along = back + loads.fraction[0] * (front - back)
        expected = parameters.ankle[k, :2] + along * np.array([c, s])
        np.testing.assert_allclose(loads.pressure[0, k], [*expected, 0.0], atol=1e-12)
    assert loads.ground_force[0, 0, 1] > 0.0 > loads.ground_force[0, 1, 1], 'forces lean inwards'


def test_box_turns_with_its_own_inertia(who) -> None:
    """Force and yaw moment of the hands are those of a cuboid that moves with them."""
    parameters, motion = placed(who), random_motion(np.random.default_rng(4), 1)
    h = 1e-4
    q, dq, ddq = motion
    t = np.array([-h, 0.0, h])[:, None]
    path = q + t * dq + 0.5 * t**2 * ddq
    library = spatial_library()
    hands = evaluate(library, path, 0 * path, 0 * path, 7.0, parameters).hand
    loads = evaluate(library, *motion, 7.0, parameters)
    push = (hands[2] - 2 * hands[1] + hands[0]) / h**2
    force = -loads.hand_force[0]
    np.testing.assert_allclose(
        force.sum(axis=0), 7.0 * (push.mean(axis=0) + [0, 0, GRAVITY]), atol=2e-3
    )
    line = hands[1, 1] - hands[1, 0]
    across = np.array([-line[1], line[0], 0.0]) / np.linalg.norm(line[:2])
    difference = (force[1] - force[0]) @ across
    expected = 2.0 * 7.0 * parameters.box_turning * across @ (push[1] - push[0])
    assert difference == pytest.approx(expected, abs=1e-3)
