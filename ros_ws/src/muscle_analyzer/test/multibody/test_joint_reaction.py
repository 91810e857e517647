# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint reactions by hand, and against OpenSim on real squats with OpenSim's muscle forces."""

import numpy as np
import pytest

from muscle_analyzer.core.multibody.inverse_dynamics import inverse_dynamics, wrench_at
from muscle_analyzer.core.multibody.joint_reaction import joint_reactions, net_moment
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import body_wrenches, muscle_paths

G = 9.81
JOINTS = (
    ('hip_r', 'femur_r', 0.1, 0.1),
    ('L5_S1_IVDjnt', 'lumbar5', 3.0, 1.2),
    ('L4_L5_IVDjnt', 'lumbar4', 4.0, 1.2),
    ('L3_L4_IVDjnt', 'lumbar3', 6.0, 1.2),
)


def express(wrench, point, rotation):
    """Return a wrench about the ground's origin as one about a point, in another frame's axes."""
    moved = wrench_at(wrench, point)
    return np.append(rotation.T @ moved[:3], rotation.T @ moved[3:])


def test_muscle_adds_its_pull_to_the_joint(pendulum):
    """Hanging at rest; a muscle of 100 N from (0.1, 0, 0) on the ground to (0.02, -0.2, 0)."""
    zero = np.zeros(2)
    state = forward_kinematics(pendulum.tree, zero, zero, zero)
    paths = muscle_paths(
        path_table(pendulum), state.position, state.rotation, body_jacobians(pendulum.tree, state)
    )
    pull = body_wrenches(path_table(pendulum), paths.wrench, np.array([100.0]), 3)
    needed = inverse_dynamics(pendulum.tree, state, np.zeros((3, 6)))
    reaction = joint_reactions(pendulum.tree, needed.joint_wrench, pull)
    direction = np.array([0.08, 0.2]) / np.hypot(0.08, 0.2)
    force = np.array([0.0, 3.5 * G]) - 100.0 * direction
    moment = -100.0 * (0.02 * direction[1] + 0.2 * direction[0])
    upper = express(reaction[1], state.joint_position[1], np.eye(3))
    assert upper == pytest.approx([0.0, 0.0, moment, force[0], force[1], 0.0])
    # The muscle does not cross the elbow.
    lower = express(reaction[2], state.joint_position[2], np.eye(3))
    assert lower == pytest.approx([0.0, 0.0, 0.0, 0.0, 1.5 * G, 0.0], abs=1e-12)


def test_both_sides_agree_when_the_ground_carries_the_weight(lifting_multibody):
    """A plate force that balances the weight leaves no residual; 1 N more shows with its arm."""
    model = lifting_multibody
    zero = np.zeros(len(model.coordinate_names))
    state = forward_kinematics(model.tree, zero, zero, zero)
    external = np.zeros((len(model.body_names), 6))
    weight = inverse_dynamics(model.tree, state, external).joint_wrench
    root, l5 = model.body_index('pelvis'), model.body_index('lumbar5')
    external[model.body_index('calcn_r')] = weight[root]
    balanced = inverse_dynamics(model.tree, state, external).joint_wrench
    net = net_moment(balanced, state, l5, root)
    assert net.difference == pytest.approx(np.zeros(3), abs=1e-9)
    assert net.bottom_up == pytest.approx(net.top_down, abs=1e-9)
    external[model.body_index('calcn_r')] += [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]
    pushed = inverse_dynamics(model.tree, state, external).joint_wrench
    height = state.joint_position[l5, 1]
    assert net_moment(pushed, state, l5, root).difference[2] == pytest.approx(-height)


def test_squats_both_sides_of_l5_s1(squats):
    """Measured 13.8 N m rms on OpenSim's kinematics, nearly all of it in flexion."""
    model = squats.model
    root, l5 = model.body_index('pelvis'), model.body_index('lumbar5')
    differences = []
    for i in range(squats.sample(0.7), squats.sample(3.8) + 1):
        state = forward_kinematics(model.tree, squats.q[i], squats.qd[i], squats.qdd[i])
        needed = inverse_dynamics(model.tree, state, squats.external[i])
        differences.append(net_moment(needed.joint_wrench, state, l5, root).difference)
    rms = np.sqrt(np.mean(np.sum(np.square(differences), axis=1)))
    assert rms <= 15.0


@pytest.mark.parametrize(('joint', 'body', 'force_limit', 'moment_limit'), JOINTS)
def test_squat_reactions_are_those_of_opensim(squats, joint, body, force_limit, moment_limit):
    """With OpenSim's muscle forces.

    The hip agrees to 0.03 N; L5-S1 to 2.9 N of 2190 N (0.13 %), L3-L4 to 5.3 N. OpenSim's
    optimisation leaves up to 6 N m on the coupled lumbar coordinates unbalanced, which its joint
    reaction analysis turns into accelerations: that explains the moments' differences. The limits
    are the differences found, far below the 3 % that are asked for.
    """
    model = squats.model
    table = path_table(model)
    names, reference = squats.reference('joint_reaction_loads.sto')
    muscles, forces = squats.reference('static_optimization_force.sto')
    columns = [muscles.index(muscle.name) for muscle in model.source.muscles]
    at = model.body_index(body)
    for row, force in zip(reference, forces[:, columns], strict=True):
        i = squats.sample(row[0])
        state = forward_kinematics(model.tree, squats.q[i], squats.qd[i], squats.qdd[i])
        paths = muscle_paths(
            table, state.position, state.rotation, body_jacobians(model.tree, state)
        )
        pull = body_wrenches(table, paths.wrench, force, len(model.body_names))
        needed = inverse_dynamics(model.tree, state, squats.external[i])
        reaction = joint_reactions(model.tree, needed.joint_wrench, pull)
        ours = express(reaction[at], state.joint_position[at], state.rotation[at])
        label = f'{joint}_on_{body}_in_{body}_'
        theirs = [row[names.index(label + c)] for c in ('mx', 'my', 'mz', 'fx', 'fy', 'fz')]
        assert np.abs(ours[3:] - theirs[3:]).max() <= force_limit
        assert np.abs(ours[:3] - theirs[:3]).max() <= moment_limit
