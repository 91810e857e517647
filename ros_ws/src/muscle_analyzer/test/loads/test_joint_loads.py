# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads of lumbar levels, hips and knees in their frames: by hand, and against OpenSim."""

from dataclasses import replace

import numpy as np
import pytest

from muscle_analyzer.core.loads.disc_frame import FORWARD_LEFT_UP, DiscOption, disc_rotation
from muscle_analyzer.core.loads.joint_loads import JointLoadFrames, loaded_joints, lumbosacral_body
from muscle_analyzer.core.multibody.inverse_dynamics import inverse_dynamics
from muscle_analyzer.core.multibody.joint_reaction import joint_reactions
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import body_wrenches, muscle_paths

LUMBAR_TILT = {'l5_s1': 21.0, 'l4_l5': 3.0, 'l3_l4': -9.0, 'l2_l3': -16.0, 'l1_l2': -22.0}
REFERENCE = {
    'l5_s1': 'L5_S1_IVDjnt_on_lumbar5_in_lumbar5',
    'l3_l4': 'L3_L4_IVDjnt_on_lumbar3_in_lumbar3',
    'hip_r': 'hip_r_on_femur_r_in_femur_r',
    'knee_r': 'walker_knee_r_on_tibia_r_in_tibia_r',
}


def upright(model, reactions, option=DiscOption.BRUNO2015):
    zero = np.zeros(len(model.coordinate_names))
    state = forward_kinematics(model.tree, zero, zero, zero)
    l5, thorax = model.body_index('lumbar5'), model.body_index('torso')
    disc = disc_rotation(option, state.rotation[l5], state.rotation[thorax], 0.0)
    frames = JointLoadFrames(model, option)
    loads = frames.loads(reactions, state.joint_position, state.rotation, disc)
    return frames, loads, state


def test_weight_above_compresses_and_pushes_forward_by_the_lean_of_each_disc(lifting_multibody):
    """Standing upright, 500 N up on each vertebra: compression cos, anterior shear sin of lean."""
    model = lifting_multibody
    reactions = np.zeros((len(model.body_names), 6))
    frames = JointLoadFrames(model, DiscOption.BRUNO2015)
    for body in ('lumbar5', 'lumbar4', 'lumbar3', 'lumbar2', 'lumbar1', 'torso'):
        reactions[model.body_index(body), 4] = 500.0
    frames, loads, _ = upright(model, reactions)
    for name, tilt in LUMBAR_TILT.items():
        force = loads.force[frames.names.index(name)]
        # The normal leans forward: the upper vertebra slides forward, the joint holds it back.
        assert force[2] == pytest.approx(500.0 * np.cos(np.radians(tilt)))
        assert -force[0] == pytest.approx(500.0 * np.sin(np.radians(tilt)))
        assert force[1] == pytest.approx(0.0, abs=1e-9)


def test_femur_carries_the_pelvis(lifting_multibody):
    """The pelvis pushes the femur down with 400 N: compression at the hip, whatever the side."""
    model = lifting_multibody
    reactions = np.zeros((len(model.body_names), 6))
    zero = np.zeros(len(model.coordinate_names))
    state = forward_kinematics(model.tree, zero, zero, zero)
    for body in ('femur_r', 'femur_l'):
        i = model.body_index(body)
        reactions[i, 3:] = (30.0, -400.0, 0.0)
        reactions[i, :3] = np.cross(state.joint_position[i], reactions[i, 3:])
    frames, loads, _ = upright(model, reactions)
    for name in ('hip_r', 'hip_l'):
        k = frames.names.index(name)
        # The pelvis, pushed forward on the femur, pushes the femur forward.
        assert loads.force[k] == pytest.approx([-30.0, 0.0, 400.0], abs=1e-9)
        assert loads.moment[k] == pytest.approx(np.zeros(3), abs=1e-9)


def test_vertebral_frames_are_not_turned(lifting_multibody):
    reactions = np.zeros((len(lifting_multibody.body_names), 6))
    reactions[lifting_multibody.body_index('lumbar3'), 3:] = (10.0, 500.0, 20.0)
    frames, loads, _ = upright(lifting_multibody, reactions, DiscOption.VERTEBRAL)
    # OpenSim's axes (forward, up, right) as forward, left, up.
    force = loads.force[frames.names.index('l3_l4')]
    assert force == pytest.approx([10.0, -20.0, 500.0])


def test_squat_loads_are_those_of_opensim(squats):
    """With OpenSim's muscle forces: lumbar levels, hips and knees, in the frames of the bodies."""
    model = squats.model
    table = path_table(model)
    names, reference = squats.reference('joint_reaction_loads.sto')
    muscles, forces = squats.reference('static_optimization_force.sto')
    columns = [muscles.index(muscle.name) for muscle in model.source.muscles]
    frames = JointLoadFrames(model, DiscOption.VERTEBRAL)
    l5 = model.body_index('lumbar5')
    peak = {}
    for row, muscle_force in zip(reference, forces[:, columns], strict=True):
        i = squats.sample(row[0])
        state = forward_kinematics(model.tree, squats.q[i], squats.qd[i], squats.qdd[i])
        paths = muscle_paths(
            table, state.position, state.rotation, body_jacobians(model.tree, state)
        )
        pull = body_wrenches(table, paths.wrench, muscle_force, len(model.body_names))
        needed = inverse_dynamics(model.tree, state, squats.external[i])
        reactions = joint_reactions(model.tree, needed.joint_wrench, pull)
        disc = state.rotation[l5] @ FORWARD_LEFT_UP
        loads = frames.loads(reactions, state.joint_position, state.rotation, disc)
        for name, label in REFERENCE.items():
            theirs = np.array([row[names.index(f'{label}_{c}')] for c in ('fx', 'fy', 'fz')])
            theirs = theirs @ FORWARD_LEFT_UP
            if name.startswith(('hip', 'knee')):
                theirs = -theirs
            ours = loads.force[frames.names.index(name)]
            assert np.abs(ours - theirs).max() <= 6.0, name
            peak[name] = max(peak.get(name, 0.0), ours[2])
    # A squat compresses all of them by more than the body weights that rest on them.
    assert min(peak.values()) > 700.0


def test_without_vertebrae_the_torso_stands_above_l5_s1(lifting_multibody):
    """As in gait models: no lumbar levels, hips and knees as before."""
    others = {'Abdomen': 'belly'}
    names = tuple(
        others.get(name, name.replace('lumbar', 'level')) for name in lifting_multibody.body_names
    )
    model = replace(lifting_multibody, body_names=names)
    assert lumbosacral_body(model) == 'torso'
    assert lumbosacral_body(lifting_multibody) == 'lumbar5'
    joints = {joint.name: joint.body for joint in loaded_joints(model)}
    assert joints == {
        'l5_s1': 'torso', 'hip_r': 'femur_r', 'hip_l': 'femur_l', 'knee_r': 'tibia_r',
        'knee_l': 'tibia_l',
    }  # fmt: skip
    assert JointLoadFrames(model, DiscOption.BRUNO2015).names == tuple(joints)
