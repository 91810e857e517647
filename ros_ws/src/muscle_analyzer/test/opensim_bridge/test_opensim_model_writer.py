# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A written model is read back as the same model, in its parts and in what it computes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muscle_analyzer.core.exceptions import ModelWriteError
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.opensim_bridge.meshes import read_meshes, scaled_meshes
from muscle_analyzer.core.opensim_bridge.model_writer import write_osim
from muscle_analyzer.core.opensim_bridge.xml_functions import function_element, xyz_angles
from muscle_analyzer.core.osim.functions import (
    PiecewisePolynomial,
    constant,
    linear,
    piecewise_linear,
    polynomial,
    simm_spline,
    smooth_step,
)
from muscle_analyzer.core.osim.model import PathPoint
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.osim.xml import body_fixed_xyz

angle = st.floats(-np.pi, np.pi)


@pytest.fixture(scope='module')
def again(lifting_model, tmp_path_factory):
    """Return the lifting full-body model written and read back."""
    path = tmp_path_factory.mktemp('written') / 'model.osim'
    write_osim(path, lifting_model)
    return read_osim(path)


def test_all_parts_are_there_in_their_order(lifting_model, again):
    for part in ('bodies', 'joints', 'couplers', 'muscles', 'markers'):
        names = [item.name for item in getattr(lifting_model, part)]
        assert [item.name for item in getattr(again, part)] == names, part
    assert {w.name for w in again.wrap_objects} == {w.name for w in lifting_model.wrap_objects}
    np.testing.assert_array_equal(again.gravity, lifting_model.gravity)
    assert again.left_out == ()


def test_bodies_and_coordinates_are_equal(lifting_model, again):
    for body, other in zip(lifting_model.bodies, again.bodies, strict=True):
        assert other.mass == body.mass
        np.testing.assert_array_equal(other.mass_center, body.mass_center)
        np.testing.assert_array_equal(other.inertia, body.inertia)
    for joint, other in zip(lifting_model.joints, again.joints, strict=True):
        assert other.coordinates == joint.coordinates
        assert (other.parent.body, other.child.body) == (joint.parent.body, joint.child.body)


def test_muscle_parameters_are_equal(lifting_model, again):
    for muscle, other in zip(lifting_model.muscles, again.muscles, strict=True):
        assert other.properties == muscle.properties
        assert other.wraps == muscle.wraps
        for field in (
            'kind', 'max_isometric_force', 'optimal_fiber_length', 'tendon_slack_length',
            'pennation_angle',
        ):  # fmt: skip
            assert getattr(other, field) == getattr(muscle, field)


def same_mechanics(model, other):
    """Compare poses, lengths and moment arms of two models in random postures."""
    models = [compile_model(model), compile_model(other)]
    first = models[0]
    low, high = (np.clip(side, -2.0, 2.0) for side in (first.lower, first.upper))
    rng = np.random.default_rng(4)
    for _ in range(3):
        q = low + (high - low) * rng.uniform(0.2, 0.8, low.size)
        found = []
        for each in models:
            state = forward_kinematics(each.tree, q, 0.1 * q, 0.2 * q)
            jacobian = body_jacobians(each.tree, state)
            paths = posture_paths(path_table(each), state, jacobian)
            found.append((state.position, state.acceleration, paths.length, paths.moment_arm))
        for ours, theirs in zip(*found, strict=True):
            np.testing.assert_allclose(theirs, ours, rtol=0.0, atol=1e-10)


def test_poses_lengths_and_moment_arms_are_equal(lifting_model, again):
    same_mechanics(lifting_model, again)


def test_a_model_with_one_of_everything_comes_back(tmp_path):
    """All joints, functions, surfaces, points and muscles that the reader knows."""
    model = read_osim(Path(__file__).parents[1] / 'reference' / 'specimens.osim')
    path = tmp_path / 'specimens.osim'
    write_osim(path, model)
    same_mechanics(model, read_osim(path))


def test_conditional_and_moving_points_come_back(write_model, tmp_path):
    model = read_osim(write_model())
    muscle = model.muscles[0]
    spline = simm_spline([0.0, 0.5, 1.0, 2.0], [0.01, 0.02, 0.0, 0.05])
    points = (
        muscle.points[0],
        PathPoint('there', 'conditional', 'upper', np.array([0.0, -0.1, 0.02]), 'q1', (-0.5, 0.7)),
        PathPoint(
            'slides', 'moving', 'lower', np.array([0.01, -0.1, 0.0]),
            location_functions=(spline, linear(0.01, -0.1), constant(0.0)),
            location_coordinates=('q2', 'q2', 'q1'),
        ),
    )  # fmt: skip
    path = tmp_path / 'points.osim'
    write_osim(path, replace(model, muscles=(replace(muscle, points=points),)))
    again = read_osim(path).muscles[0].points
    there = again[1]
    assert (there.kind, there.coordinate, there.range) == ('conditional', 'q1', (-0.5, 0.7))
    assert again[2].location_coordinates == ('q2', 'q2', 'q1')
    for x in (-0.3, 0.2, 1.4, 3.0):
        ours = [f.derivatives(x) for f in points[2].location_functions]
        assert [f.derivatives(x) for f in again[2].location_functions] == [
            pytest.approx(values) for values in ours
        ]


@pytest.mark.parametrize(
    ('function', 'tag'),
    [
        (constant(0.3), 'Constant'),
        (linear(-2.0, 0.5), 'LinearFunction'),
        (polynomial([0.1, -0.3, 0.4, 2.0]), 'PolynomialFunction'),
        (PiecewisePolynomial(np.empty(0), np.array([0.7]), np.array([[1.0, 2.0, 3.0]])),
         'PolynomialFunction'),
        (piecewise_linear([0.0, 1.0, 3.0], [0.0, 2.0, 1.0]), 'PiecewiseLinearFunction'),
        (simm_spline([0.0, 1.0, 2.0], [0.0, 1.0, 0.0]), 'SimmSpline'),
        (smooth_step(-0.2, 0.9, 1.5, -0.5).scaled(2.0), 'StepFunction'),
        (simm_spline([-1.0, 0.0, 0.4, 2.0, 3.0], [0.2, 1.0, 0.0, 0.5, 4.0]).scaled(1.3),
         'SimmSpline'),
    ],
)  # fmt: skip
def test_functions_come_back(write_model, tmp_path, function, tag):
    assert function_element(function).tag == tag
    model = read_osim(write_model())
    joint = model.joints[1]
    name = joint.coordinates[0].name
    moved = replace(joint.translations[0], coordinate=name, function=function)
    joints = (model.joints[0], replace(joint, translations=(moved, *joint.translations[1:])))
    path = tmp_path / 'function.osim'
    write_osim(path, replace(model, joints=joints))
    again = read_osim(path).joints[1].translations[0].function
    for x in (-2.0, -0.1, 0.0, 0.3, 1.7, 5.0):
        assert again.derivatives(x) == pytest.approx(function.derivatives(x), abs=1e-12)


def test_a_function_of_unknown_pieces_is_refused():
    broken = simm_spline([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 0.0, 2.0])
    bent = replace(broken, coefficients=broken.coefficients + np.eye(5, 4))
    with pytest.raises(ModelWriteError, match='5 pieces is no broken line, step or SimmSpline'):
        function_element(bent)


def test_a_fixed_joint_that_is_not_straight_is_refused(write_model, tmp_path):
    model = read_osim(write_model())
    joint = model.joints[1]
    turned = replace(joint.rotations[0], coordinate=None, function=constant(0.1))
    bent = replace(joint, coordinates=(), rotations=(turned, *joint.rotations[1:]))
    with pytest.raises(ModelWriteError, match="joint 'elbow': a fixed joint with a turn"):
        write_osim(tmp_path / 'bent.osim', replace(model, joints=(model.joints[0], bent)))


@given(angle, st.floats(-np.pi / 2, np.pi / 2), angle)
def test_turns_give_the_rotation_again(x, y, z):
    rotation = body_fixed_xyz(np.array([x, y, z]))
    np.testing.assert_allclose(body_fixed_xyz(xyz_angles(rotation)), rotation, atol=1e-7)


def test_turns_where_two_axes_are_one():
    rotation = body_fixed_xyz(np.array([0.4, np.pi / 2, 0.3]))
    np.testing.assert_allclose(body_fixed_xyz(xyz_angles(rotation)), rotation, atol=1e-9)


def test_bones_come_back_stretched_with_their_bodies(lifting_model, tmp_path):
    """Twice as deep, tall and wide a shank has a mesh twice as large, twice as far off."""
    meshes = read_meshes(Path(lifting_model.source))
    assert len(meshes) > 80
    factors = {body.name: np.ones(3) for body in lifting_model.bodies}
    factors['tibia_r'] = np.full(3, 2.0)
    path = tmp_path / 'bones.osim'
    write_osim(path, lifting_model, scaled_meshes(meshes, factors))
    again = read_meshes(path)
    assert sorted(m.file for m in again) == sorted(m.file for m in meshes)
    # The writer goes through the bodies; those on a body's own frames come last when read.
    bodies = [body.name for body in lifting_model.bodies]
    order = sorted(meshes, key=lambda mesh: bodies.index(mesh.frame.body))
    for mesh, other in zip(order, again, strict=True):
        assert (other.file, other.frame.body) == (mesh.file, mesh.frame.body)
        size = 2.0 if mesh.frame.body == 'tibia_r' else 1.0
        np.testing.assert_allclose(other.scale, size * mesh.scale)
        np.testing.assert_allclose(other.frame.translation, size * mesh.frame.translation)
        np.testing.assert_allclose(other.frame.rotation, mesh.frame.rotation, atol=1e-12)
    assert len(read_osim(path).muscles) == len(lifting_model.muscles)
