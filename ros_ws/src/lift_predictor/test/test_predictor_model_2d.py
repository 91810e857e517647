# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The chain from the feet against the skeleton of human_model, and the balance of power."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from thesis_parameters import named_parameters

from human_model.named_subjects import named_subject
from human_model.skeleton import ExternalForce
from human_model.strength import JointStrength, coefficient_sets
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.passive import passive_hip_moment
from lift_predictor.core.models.sagittal.assembly import sagittal_library
from lift_predictor.core.models.sagittal.evaluation import SagittalLoads, evaluate
from lift_predictor.core.models.sagittal.grid import CENTRES, HAND_SCALE, NODE_CONSTRAINTS
from lift_predictor.core.models.sagittal.kinematics import chain_positions, pelvis_motion
from lift_predictor.core.models.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.models.sagittal.person import Person

N = 12
LIBRARY = sagittal_library()


@pytest.fixture(scope='module')
def motion() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(5)
    low, high = np.radians([-60, -20, 5, 0, 5, -20]), np.radians([20, 120, 100, 100, 100, 30])
    return rng.uniform(low, high, (N, 6)), rng.normal(size=(N, 6)), 5.0 * rng.normal(size=(N, 6))


@pytest.fixture(scope='module')
def loads(parameters: LiftParameters, motion) -> SagittalLoads:
    return evaluate(LIBRARY, *motion, parameters)


def full_motion(person: Person, parameters: LiftParameters, motion) -> list[np.ndarray]:
    blocks = []
    for joints, root in zip(motion, pelvis_motion(*motion, parameters), strict=True):
        block = np.zeros((N, 10))
        block[:, [person.skeleton.index(j) for j in JOINTS]] = joints
        block[:, :3] = root
        blocks.append(block)
    return blocks


def test_torques_and_ground_force_agree_with_the_skeleton(
    person: Person, parameters: LiftParameters, motion, loads: SagittalLoads
) -> None:
    """With the predicted ground force at the predicted ZMP, the other recursion closes."""
    skeleton = person.skeleton
    q, dq, ddq = full_motion(person, parameters, motion)
    assert skeleton.coordinates[:3] == ('pelvis_tx', 'pelvis_ty', 'pelvis_tilt')
    for i in range(N):
        up, down = loads.ground_force[i], loads.hand_force[i]
        hand = loads.centres[i, CENTRES.index('hand')]
        external = [
            ExternalForce('foot', (up[0], 0.0, up[1]), (loads.zmp[i], 0.0, 0.0)),
            ExternalForce('forearm', (down[0], 0.0, down[1]), (hand[0], 0.0, hand[1])),
        ]
        forces = skeleton.inverse_dynamics(q[i], dq[i], ddq[i], external)
        np.testing.assert_allclose(forces[:3], 0.0, atol=1e-8)
        own = [forces[skeleton.index(joint)] for joint in JOINTS]
        np.testing.assert_allclose(loads.torque[i], own, atol=1e-8)


def test_joint_centres_agree_with_the_skeleton(
    person: Person, parameters: LiftParameters, motion, loads: SagittalLoads
) -> None:
    q = full_motion(person, parameters, motion)[0]
    names = ('ankle_r', 'knee_r', 'hip_r', 'l5_s1', 'shoulder_r', 'elbow_r', 'hand_r')
    positions = chain_positions(motion[0], parameters)
    for i in range(N):
        points = person.skeleton.points(q[i])
        for name, centre in zip(names, CENTRES, strict=True):
            expected = points[name][[0, 2]]
            np.testing.assert_allclose(
                loads.centres[i, CENTRES.index(centre)], expected, atol=1e-12
            )
            np.testing.assert_allclose(positions.joints[centre][i], expected, atol=1e-12)


def test_power_balance(parameters: LiftParameters, motion) -> None:
    """Power of the joint torques = rate of kinetic and potential energy of body and box."""
    q, dq, ddq = (block[:1] for block in motion)
    torque = evaluate(LIBRARY, q, dq, ddq, parameters).torque[0]

    def energy(t: float) -> float:
        def centres(at: float) -> np.ndarray:
            return mass_centres(q + at * dq + 0.5 * at**2 * ddq, parameters)

        h = 1e-5
        velocity = (centres(t + h) - centres(t - h)) / (2.0 * h)
        rate = (dq + t * ddq)[0]
        lumbar, arm, elbow, hip, knee, ankle = rate
        spin = np.cumsum([0.0, -ankle, knee, -hip, lumbar, arm, elbow])
        masses = np.append(parameters.body[:, 0], parameters.box_mass)
        kinetic = 0.5 * masses @ (velocity**2).sum(axis=1)
        turning = 0.5 * parameters.body[:, 3] @ spin**2
        return float(kinetic + turning + parameters.gravity * masses @ centres(t)[:, 1])

    h = 1e-4
    rate = (energy(h) - energy(-h)) / (2.0 * h)
    assert torque @ dq[0] == pytest.approx(rate, rel=1e-4)


def mass_centres(q: np.ndarray, parameters: LiftParameters) -> np.ndarray:
    state = chain_positions(q, parameters)
    origin = ('ankle', 'knee', 'hip', 'hip', 'lumbar', 'shoulder', 'elbow')
    rows = []
    for row, (name, joint) in enumerate(zip(state.angles, origin, strict=True)):
        c, s = np.cos(state.angles[name][0]), np.sin(state.angles[name][0])
        x, y = parameters.body[row, 1:3]
        rows.append(state.joints[joint][0] + (c * x - s * y, s * x + c * y))
    return np.array([*rows, state.joints['hand'][0]])


def test_standing_still_puts_the_zmp_under_the_centre_of_mass(parameters: LiftParameters) -> None:
    posture, rest = np.radians([[-20.0, 30.0, 20.0, 30.0, 30.0, 10.0]]), np.zeros((1, 6))
    loads = evaluate(LIBRARY, posture, rest, rest, parameters)
    weight = parameters.total_mass * parameters.gravity
    np.testing.assert_allclose(loads.ground_force[0], [0.0, weight], atol=1e-9)
    expected = chain_positions(posture, parameters).centre_of_mass[0]
    assert loads.zmp[0] == pytest.approx(expected, abs=1e-12)


def test_held_box_pulls_at_the_hands(parameters: LiftParameters) -> None:
    """Hand computation: arms straight forward, still: the elbow carries forearm and box."""
    posture = np.array([[0.0, np.pi / 2, 0.0, 0.0, 0.0, 0.0]])
    rest = np.zeros((1, 6))
    loads = evaluate(LIBRARY, posture, rest, rest, parameters)
    mass, com_down, reach = parameters.body[6, 0], -parameters.body[6, 2], -parameters.body[6, 5]
    forward = parameters.body[6, 1]
    # In this posture the forearm points forward: "down" of the segment is forward in the world.
    assert forward < com_down
    expected = parameters.gravity * (mass * com_down + parameters.box_mass * reach)
    assert loads.torque[0, JOINTS.index('elbow_flex')] == pytest.approx(expected, rel=1e-12)
    assert loads.hand_force[0] == pytest.approx([0.0, -7.0 * parameters.gravity])


def test_torque_limits_are_those_of_human_model(
    subject: Subject, loads: SagittalLoads, motion
) -> None:
    strength = JointStrength('2d_10dof', subject)
    knee = motion[0][:, JOINTS.index('knee_angle')]
    for column, joint in enumerate(JOINTS):
        lower, upper = strength.limits(joint, motion[0][:, column], motion[1][:, column])
        if joint == 'hip_flexion':
            passive = 2.0 * passive_hip_moment(motion[0][:, column], knee, np.exp)
            lower, upper = lower + passive, upper + passive
        np.testing.assert_allclose(loads.lower[:, column], lower, rtol=1e-12)
        np.testing.assert_allclose(loads.upper[:, column], upper, rtol=1e-12)
    assert loads.lower.max() < 0.0 < loads.upper.min()


def test_clearance_row_is_the_distance_of_box_and_circle(
    parameters: LiftParameters, motion, loads: SagittalLoads
) -> None:
    gaps = chain_positions(motion[0], parameters).gaps
    first = NODE_CONSTRAINTS.index('collision (4.5) of the box with the foot')
    rows = loads.constraints[:, first : first + len(parameters.circle)]
    used = parameters.circle[:, 2] > 0.0
    # The smooth shape contains the box grown by the radius, and is at most 9 % larger.
    assert np.all(gaps[:, used][rows[:, used] >= 0.0] > -1e-9)
    largest = parameters.semi_axes[used].max(axis=1)
    far = gaps[:, used] > 0.2 * largest
    assert far.any()
    assert np.all(rows[:, used][far] > 0.0)
    np.testing.assert_array_equal(rows[:, ~used], 1.0)


def test_height_row_is_the_grip_over_its_lowest_place(parameters: LiftParameters, motion) -> None:
    rows = evaluate(LIBRARY, *motion, replace(parameters, lowest_grip=0.3)).constraints
    hand = chain_positions(motion[0], parameters).joints['hand'][:, 1]
    at = NODE_CONSTRAINTS.index('height of the box over the lower of its places')
    np.testing.assert_allclose(rows[:, at] * HAND_SCALE, hand - 0.3, atol=1e-12)


def test_circle_switched_off_does_not_constrain(parameters: LiftParameters, motion) -> None:
    off = replace(parameters, circle=np.zeros_like(parameters.circle))
    rows = evaluate(LIBRARY, *motion, off).constraints
    np.testing.assert_array_equal(rows[:, 8 : 8 + len(off.circle)], 1.0)
    assert np.all(np.isinf(chain_positions(motion[0], off).gaps))


def test_pelvis_motion_against_finite_differences(parameters: LiftParameters, motion) -> None:
    q, dq, ddq = motion
    h = 1e-4

    def at(t: float) -> np.ndarray:
        return pelvis_motion(q + t * dq + 0.5 * t**2 * ddq, dq, ddq, parameters)[0]

    _, velocity, acceleration = pelvis_motion(q, dq, ddq, parameters)
    np.testing.assert_allclose(velocity, (at(h) - at(-h)) / (2.0 * h), atol=1e-6)
    np.testing.assert_allclose(acceleration, (at(h) - 2.0 * at(0.0) + at(-h)) / h**2, atol=2e-5)


def test_published_link_table_can_be_used(motion) -> None:
    """Table 2.2 has no mass between hips and spine: there both joints carry the same moment."""
    person = Person.of(named_subject('thesis_2d'), segments=named_parameters('thesis_2d'))
    assert person.body[:, 0].sum() == pytest.approx(83.73, abs=0.01)
    parameters = LiftParameters(
        body=person.body,
        strength_lower=person.strength_lower,
        strength_upper=person.strength_upper,
        circle=person.circle,
        hip_range=person.hip_range,
        ankle=np.array([0.0, person.ankle_height]),
        support=np.array([-0.05, 0.2]),
        ground_height=0.0,
        gravity=person.gravity,
        duration=1.2,
        box_mass=20.0,
        box_half=np.array([0.1, 0.1]),
        box_acceleration=1e3,
        box_from_hand=np.zeros(2),
        lowest_grip=0.0,
    )
    torque = evaluate(LIBRARY, *motion, parameters).torque
    spine, hip = JOINTS.index('lumbar_extension'), JOINTS.index('hip_flexion')
    np.testing.assert_allclose(torque[:, spine], -torque[:, hip], rtol=1e-12)


def test_strength_that_can_change_sign_is_refused(subject: Subject) -> None:
    signed = [name for name in coefficient_sets() if 'unconstrained' in name]
    assert signed
    with pytest.raises(TaskError, match='negative coefficients'):
        Person.of(subject, signed[0])
