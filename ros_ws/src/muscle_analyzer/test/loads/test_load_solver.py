# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled frame against its steps one by one, blocks against single states, bad input."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.inverse_dynamics import add_force, inverse_dynamics, wrench_at
from muscle_analyzer.core.multibody.joint_reaction import joint_reactions, net_moment
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.muscles.curves import MuscleParameters, strength
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import body_wrenches, posture_paths
from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions

BEND = {
    'pelvis_tilt': -0.3, 'hip_flexion_r': 0.9, 'hip_flexion_l': 0.8, 'knee_angle_r': 0.9,
    'knee_angle_l': 0.8, 'L5_S1_Flex_Ext': -0.3, 'L5_S1_Lat_Bending': 0.05, 'arm_flex_r': 0.6,
}  # fmt: skip


@pytest.fixture(scope='module')
def motion(lifting_multibody):
    """Return five samples of bending: coordinates, rates, accelerations, wrenches on the feet."""
    names = lifting_multibody.coordinate_names
    by = np.array([BEND.get(name, 0.0) for name in names])
    q = np.linspace(0.8, 1.0, 5)[:, None] * by
    external = np.zeros((5, len(lifting_multibody.body_names), 6))
    for k in range(5):
        state = forward_kinematics(lifting_multibody.tree, q[k], 0.0 * by, 0.0 * by)
        for body in map(lifting_multibody.body_index, ('calcn_r', 'calcn_l')):
            # Under the middle of the foot.
            place = state.position[body] + [0.1, 0.0, 0.0]
            add_force(external[k], body, np.array([0.0, 380.0, 0.0]), place, np.zeros(3))
    return q, np.repeat([by], 5, axis=0), np.repeat([-2.0 * by], 5, axis=0), external


@pytest.mark.parametrize(
    ('criterion', 'stretched'), [('squares', True), ('min_max', False), ('min_max', True)]
)
def test_frame_is_the_sum_of_its_steps(lifting_multibody, motion, criterion, stretched):
    """Kinematics to joint reaction by the functions one by one, with and without passive force."""
    options = MuscleAnalyzerOptions(
        force_length_velocity=True,
        passive_force=stretched,
        static_optimization=StaticOptimizationOptions(criterion=criterion),
    ).as_opensim()
    solver = LoadSolver(lifting_multibody, options)
    q, qd, qdd, external = (array[2] for array in motion)
    solution = solver.solve(q, qd, qdd, external)
    assert solution.balance.converged

    model, tree = lifting_multibody, lifting_multibody.tree
    table = path_table(model)
    state = forward_kinematics(tree, q, qd, qdd)
    needed = inverse_dynamics(tree, state, external)
    paths = posture_paths(table, state, body_jacobians(tree, state))
    muscles = MuscleParameters.of(model.source.muscles)
    active, passive = strength(muscles, paths.length, -paths.moment_arm @ qd, stretched)
    force = solution.balance.activation * active + passive
    assert solution.force == pytest.approx(force, rel=1e-12)
    about = [model.coordinate_index(name) for name in solver.coordinate_names]
    assert solution.torque == pytest.approx(needed.force[about], rel=1e-12)
    carried = paths.moment_arm[:, about].T @ force + solution.balance.reserve
    assert carried == pytest.approx(solution.torque, abs=1e-6)

    pulls = body_wrenches(table, paths.wrench, force, len(model.body_names))
    reactions = joint_reactions(tree, needed.joint_wrench, pulls)
    root, l5 = model.body_index('pelvis'), model.body_index('lumbar5')
    assert solution.reaction == pytest.approx(
        wrench_at(reactions[l5], state.joint_position[l5]), rel=1e-12
    )
    net = net_moment(needed.joint_wrench, state, l5, root)
    for ours, expected in zip(solution.net, net, strict=True):
        assert ours == pytest.approx(expected, abs=1e-9)
    assert solution.residual == pytest.approx(
        wrench_at(needed.joint_wrench[root], state.position[root]), abs=1e-9
    )
    # The disc frame turns the same force.
    size = np.linalg.norm(solution.reaction[3:])
    assert np.linalg.norm(solution.disc.force) == pytest.approx(size)
    assert np.array_equal(solution.joints.force[solver.lumbosacral], solution.disc.force)
    hip = solver.joint_names.index('hip_r')
    femur = model.body_index('femur_r')
    # Of the pelvis' lower neighbour on it: the opposite of the pelvis on the femur.
    assert np.linalg.norm(solution.joints.force[hip]) == pytest.approx(
        np.linalg.norm(reactions[femur, 3:])
    )


def test_block_equals_states_one_after_the_other(lifting_multibody, motion):
    one, other = (
        LoadSolver(lifting_multibody, MuscleAnalyzerOptions(force_length_velocity=True))
        for _ in range(2)
    )
    block = one.solve_block(*motion)
    for k, state in enumerate(zip(*motion, strict=True)):
        alone = other.solve(*state)
        assert np.array_equal(block.activation[k], alone.balance.activation)
        assert np.array_equal(block.joint_force[k], alone.joints.force)
        assert block.iterations[k] == alone.balance.report.iterations
    # Each frame starts from the one before: the third takes fewer steps than from nothing.
    other.reset()
    third = other.solve(*(array[2] for array in motion))
    assert block.iterations[2] < third.balance.report.iterations


@pytest.mark.parametrize('criterion', ['squares', 'min_max'])
def test_numbers_that_are_not_finite_name_their_coordinate(lifting_multibody, motion, criterion):
    options = StaticOptimizationOptions(criterion=criterion)
    solver = LoadSolver(lifting_multibody, MuscleAnalyzerOptions(static_optimization=options))
    external = motion[3].copy()
    external[3, lifting_multibody.body_index('hand_r'), 0] = np.nan
    with pytest.raises(InputArrayError, match=r'coordinate \w+: torque nan'):
        solver.solve_block(*motion[:3], external)


def test_numbers_that_are_not_finite_leave_nothing_behind(lifting_multibody, motion):
    used, fresh = (LoadSolver(lifting_multibody, MuscleAnalyzerOptions()) for _ in range(2))
    q, *others = (array[1] for array in motion)
    with pytest.raises(InputArrayError):
        used.solve(np.full_like(q, np.nan), *others)
    used.reset()
    after, expected = used.solve(q, *others), fresh.solve(q, *others)
    assert np.array_equal(after.force, expected.force)
    assert np.array_equal(after.joints.moment, expected.joints.moment)
    assert np.array_equal(after.residual, expected.residual)
