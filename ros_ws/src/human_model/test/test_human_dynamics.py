# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The thesis' recursion and the compiled Newton-Euler, by hand and against each other."""

import numpy as np
import pytest
from lagrangian_recursion import augmented_inertia, forward_kinematics, recursive_dynamics

from human_model import compiled
from human_model.anthropometry import SegmentParameters
from human_model.compiled_blocks import outer_force
from human_model.constants import GRAVITY
from human_model.exceptions import ChainError
from human_model.skeleton import ExternalForce
from human_model.skeletons import Skeleton2D
from human_model.tree import build_tree


def loads(skeleton):
    """Return ground reactions, a moment and hand forces on the skeleton's ends."""
    names = skeleton.segments
    foot = 'foot_r' if 'foot_r' in names else 'foot'
    hand = 'hand_l' if 'hand_l' in names else 'forearm'
    return [
        ExternalForce(foot, [12.0, -7.0, 410.0], [0.08, -0.1, 0.0], [0.0, 0.0, 3.0]),
        ExternalForce(hand, [5.0, 3.0, -60.0], [0.4, 0.2, 0.9]),
        ExternalForce(names[0], [1.0, 2.0, 3.0], [0.0, 0.1, 0.9], [4.0, 5.0, 6.0]),
    ]


def random_state(skeleton, rng):
    return rng.normal(size=(3, len(skeleton.coordinates))) * [[0.7], [2.0], [8.0]]


def test_recursion_and_newton_euler_agree(skeleton, rng):
    for _ in range(10):
        q, qd, qdd = random_state(skeleton, rng)
        external = loads(skeleton)
        fast = skeleton.inverse_dynamics(q, qd, qdd, external)
        slow = recursive_dynamics(
            skeleton.chain, skeleton.parameters, q, qd, qdd, wrench=skeleton.wrenches(external)
        )
        assert fast == pytest.approx(slow, abs=1e-9)


def test_outer_force_is_the_residual_at_the_pelvis(skeleton, rng):
    """Of a block of instants: world axes, right is -y."""
    q, qd, qdd = rng.normal(size=(3, 4, len(skeleton.coordinates))) * [[[0.7]], [[2.0]], [[8.0]]]
    force = outer_force(skeleton.tree, q, qd, qdd, GRAVITY)
    tau = np.array([skeleton.inverse_dynamics(*row) for row in zip(q, qd, qdd, strict=True)])
    assert force[:, 0] == pytest.approx(tau[:, skeleton.index('pelvis_tx')])
    assert force[:, 2] == pytest.approx(tau[:, skeleton.index('pelvis_ty')])
    if 'pelvis_tz' in skeleton.coordinates:
        assert force[:, 1] == pytest.approx(-tau[:, skeleton.index('pelvis_tz')])


def test_frames_of_both_paths_agree(skeleton, rng):
    q = rng.normal(size=len(skeleton.coordinates))
    frames = skeleton.chain.frames(q)
    neutral = skeleton.chain.frames(0 * q)
    at_rest = skeleton.forward(0 * q)
    for i, row in enumerate(skeleton.chain.rows):
        if row.segment:
            s = skeleton.parameters.index(row.segment)
            expected = frames[i] @ np.linalg.solve(neutral[i], at_rest[s])
            assert skeleton.forward(q)[s] == pytest.approx(expected, abs=1e-12)


def test_a_b_c_are_time_derivatives(skeleton, rng):
    """B and C (2.2, 2.3) by central differences of A along a trajectory."""
    q, qd, qdd = random_state(skeleton, rng)
    h = 1e-5

    def at(t):
        return forward_kinematics(skeleton.chain, q + qd * t + qdd * t**2 / 2, qd + qdd * t, qdd)

    here, plus, minus = at(0.0), at(h), at(-h)
    assert here.b == pytest.approx((plus.a - minus.a) / (2 * h), abs=1e-6)
    assert here.c == pytest.approx((plus.b - minus.b) / (2 * h), rel=1e-6, abs=1e-4)
    place, speed, acceleration = here.point(3, [0.1, 0.2, 0.3])
    assert place == pytest.approx((here.a[3] @ [0.1, 0.2, 0.3, 1])[:3])
    assert speed == pytest.approx((here.b[3] @ [0.1, 0.2, 0.3, 1])[:3])
    assert acceleration == pytest.approx((here.c[3] @ [0.1, 0.2, 0.3, 1])[:3])


def trajectory(skeleton, t):
    """Return a smooth motion of all coordinates and its two derivatives."""
    k = np.arange(len(skeleton.coordinates))
    amplitude, speed = 0.3 + 0.01 * k, 2.0 + 0.15 * k
    return (
        amplitude * np.sin(speed * t + k),
        amplitude * speed * np.cos(speed * t + k),
        -amplitude * speed**2 * np.sin(speed * t + k),
    )


def energy(skeleton, t):
    """Kinetic energy from the velocity matrices B, and potential energy."""
    q, qd, qdd = trajectory(skeleton, t)
    inertia, mass, com = augmented_inertia(skeleton.chain, skeleton.parameters)
    motion = forward_kinematics(skeleton.chain, q, qd, qdd)
    kinetic = sum(np.trace(b @ i @ b.T) / 2 for b, i in zip(motion.b, inertia, strict=True))
    potential = sum(
        m * GRAVITY * motion.point(i, c)[0][2]
        for i, (m, c) in enumerate(zip(mass, com, strict=True))
    )
    return kinetic + potential


@pytest.mark.parametrize('time', [0.1, 0.7, 1.9])
def test_power_balance(skeleton, time):
    """Power of joints and external forces is the rate of change of the energy."""
    q, qd, qdd = trajectory(skeleton, time)
    external = loads(skeleton)
    power = skeleton.inverse_dynamics(q, qd, qdd, external) @ qd
    for load in external:
        frame = skeleton.forward(q)[skeleton.parameters.index(load.segment)]
        local = frame[:3, :3].T @ (np.asarray(load.point) - frame[:3, 3])
        triad = local + np.vstack([np.zeros(3), np.eye(3)])
        jacobian = skeleton.point_jacobian(q, load.segment, triad)
        velocity = jacobian @ qd
        spin = velocity[1:] - velocity[0]  # rows: omega x (segment axis)
        omega = sum(np.cross(frame[:3, k], spin[k]) for k in range(3)) / 2
        power += np.asarray(load.force) @ velocity[0] + np.asarray(load.moment) @ omega
    h = 1e-3
    rate = (
        8 * (energy(skeleton, time + h) - energy(skeleton, time - h))
        - (energy(skeleton, time + 2 * h) - energy(skeleton, time - 2 * h))
    ) / (12 * h)
    assert power == pytest.approx(rate, rel=1e-7, abs=1e-5)


def test_weight_and_ground_reaction_balance(skeleton):
    """Standing still on the ground's reaction leaves nothing for the free pelvis to hold."""
    q = skeleton.standing()
    still = np.zeros_like(q)
    weight = skeleton.total_mass * GRAVITY
    tau = skeleton.inverse_dynamics(q, still, still)
    assert tau[skeleton.index('pelvis_ty')] == pytest.approx(weight)
    centre = skeleton.centre_of_mass(q)
    foot = 'foot_r' if 'foot_r' in skeleton.segments else 'foot'
    ground = ExternalForce(foot, [0, 0, weight], [centre[0], centre[1], 0.0])
    tau = skeleton.inverse_dynamics(q, still, still, [ground])
    pelvis = [i for i, name in enumerate(skeleton.coordinates) if name.startswith('pelvis')]
    assert tau[pelvis] == pytest.approx(np.zeros(len(pelvis)), abs=1e-10)


def leg_only(man, masses):
    """Return a sagittal skeleton whose only masses are those given (kg, com down, Iyy)."""
    given = Skeleton2D.of(man).parameters
    n = len(given.segments)
    mass, com, inertia = np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3))
    for name, (m, down, i_yy) in masses.items():
        i = given.index(name)
        mass[i], com[i] = m, [0, 0, -down]
        inertia[i] = np.diag([i_yy, i_yy, i_yy])
    return Skeleton2D(
        SegmentParameters(given.lengths, given.segments, mass, com, inertia, given.sources)
    )


def test_pendulum(man):
    """Shank on a fixed knee: tau = (I + m c^2) qdd + m g c sin q."""
    m, c, i_yy, angle, acceleration = 3.0, 0.2, 0.04, 0.6, 5.0
    skeleton = leg_only(man, {'shank': (m, c, i_yy)})
    tau = skeleton.inverse_dynamics(
        skeleton.vector({'knee_angle': angle}),
        skeleton.vector({'knee_angle': 7.0}),
        skeleton.vector({'knee_angle': acceleration}),
    )
    expected = (i_yy + m * c**2) * acceleration + m * GRAVITY * c * np.sin(angle)
    assert tau[skeleton.index('knee_angle')] == pytest.approx(expected)
    assert tau[skeleton.index('ankle_angle')] == pytest.approx(0.0, abs=1e-12)


def test_double_pendulum(man):
    """Thigh and shank: the textbook equations in absolute angles a (thigh), b (shank)."""
    m1, c1, i1, m2, c2, i2 = 8.0, 0.17, 0.11, 3.0, 0.16, 0.04
    skeleton = leg_only(man, {'thigh': (m1, c1, i1), 'shank': (m2, c2, i2)})
    length = skeleton.parameters.lengths['thigh']
    hip, knee = np.array([0.5, 1.2, -3.0]), np.array([0.9, -2.0, 4.0])  # q, qd, qdd
    a, b = hip, hip - knee  # from the vertical, forward positive
    tau_b = (
        (i2 + m2 * c2**2) * b[2]
        + m2 * c2 * GRAVITY * np.sin(b[0])
        + m2 * length * c2 * (a[2] * np.cos(b[0] - a[0]) + a[1] ** 2 * np.sin(b[0] - a[0]))
    )
    tau_a = (
        (i1 + m1 * c1**2 + m2 * length**2) * a[2]
        + (m1 * c1 + m2 * length) * GRAVITY * np.sin(a[0])
        + m2 * length * c2 * (b[2] * np.cos(a[0] - b[0]) + b[1] ** 2 * np.sin(a[0] - b[0]))
    )
    tau = skeleton.inverse_dynamics(
        *(
            skeleton.vector({'hip_flexion': h, 'knee_angle': k})
            for h, k in zip(hip, knee, strict=True)
        )
    )
    assert tau[skeleton.index('knee_angle')] == pytest.approx(-tau_b)
    assert tau[skeleton.index('hip_flexion')] == pytest.approx(tau_a + tau_b)


def test_free_fall_needs_no_torque(body):
    q = body.standing()
    fall = body.vector({'pelvis_ty': -GRAVITY})
    assert body.inverse_dynamics(q, 0 * q, fall) == pytest.approx(0 * q, abs=1e-10)


def test_body_velocities_are_those_of_the_recursion(body, rng):
    q, qd, qdd = random_state(body, rng)
    state = compiled.body_motion(body.tree, q, qd, qdd)
    motion = forward_kinematics(body.chain, q, qd, qdd)
    i = next(i for i, row in enumerate(body.chain.rows) if row.segment == 'forearm_l')
    s = body.parameters.index('forearm_l')
    b = body.tree.segment_body[s]
    arm = body.forward(q)[s, :3, 3]
    local = np.linalg.solve(motion.a[i], np.append(arm, 1))[:3]
    _, speed, acceleration = motion.point(i, local)
    r = arm - state[1][b]
    omega, alpha = state[3][b], state[4][b]
    assert state[5][b] + np.cross(omega, r) == pytest.approx(speed)
    assert state[6][b] + np.cross(alpha, r) + np.cross(omega, np.cross(omega, r)) == pytest.approx(
        acceleration
    )


def test_foreign_segments_are_refused(body, man):
    with pytest.raises(ChainError, match='differ'):
        build_tree(body.chain, Skeleton2D.of(man).parameters)
    with pytest.raises(ChainError, match="no row carries segment 'trunk'"):
        augmented_inertia(body.chain, Skeleton2D.of(man).parameters)
    with pytest.raises(ChainError, match='40 coordinates are needed'):
        body.chain.frames(np.zeros(10))
