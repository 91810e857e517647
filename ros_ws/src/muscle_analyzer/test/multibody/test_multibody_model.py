# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiling a model: order of bodies, couplers, locked coordinates, models that are no tree."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import ModelCompilationError, UnknownNameError
from muscle_analyzer.core.multibody.kinematics import coordinate_state
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.osim.reader import read_osim


def test_parents_come_before_children(write_model):
    """Bodies do, whatever the file's order; coordinates keep the file's."""
    model = compile_model(read_osim(write_model(elbow_first=True)))
    assert model.body_names == ('ground', 'upper', 'lower')
    assert model.joint_names == ('', 'shoulder', 'elbow')
    assert model.coordinate_names == ('q2', 'q1')
    assert model.tree.parent.tolist() == [-1, 0, 1]
    assert (model.lower.tolist(), model.upper.tolist()) == ([-3.0, -3.0], [3.0, 3.0])


def test_coupled_coordinate_is_a_function_of_its_driver(coupled_pendulum):
    """q2 = 0.4 q1^2 - 0.3 q1 + 0.1, differentiated by hand."""
    assert coupled_pendulum.coordinate_names == ('q1',)
    q, qd, qdd = 0.7, 1.3, -0.4
    state = coordinate_state(coupled_pendulum.tree, np.array([q]), np.array([qd]), np.array([qdd]))
    at = coupled_pendulum.tree_coordinate_names.index('q2')
    gain = 0.8 * q - 0.3
    assert state.value[at] == pytest.approx(0.4 * q**2 - 0.3 * q + 0.1)
    assert state.gain[at] == pytest.approx(gain)
    assert state.rate[at] == pytest.approx(gain * qd)
    assert state.acceleration[at] == pytest.approx(gain * qdd + 0.8 * qd**2)


def test_locked_coordinate_stays_at_its_default(write_model):
    path = write_model(
        (
            '<Coordinate name="q2"><default_value>0',
            '<Coordinate name="q2"><locked>true</locked><default_value>0.5',
        )
    )
    model = compile_model(read_osim(path))
    assert model.coordinate_names == ('q1',)
    zero = np.zeros(1)
    state = coordinate_state(model.tree, zero, zero, zero)
    assert state.value[model.tree_coordinate_names.index('q2')] == 0.5


def test_body_without_joint_is_named(write_model):
    path = write_model(
        (
            '<socket_parent>/bodyset/lower</socket_parent>',
            '<socket_parent>/bodyset/upper</socket_parent>',
        )
    )
    with pytest.raises(ModelCompilationError, match="'upper' is the child of 2 joints"):
        compile_model(read_osim(path))


def test_bodies_in_a_circle_are_named(write_model):
    path = write_model(('<socket_parent>/ground', '<socket_parent>/bodyset/lower'))
    with pytest.raises(ModelCompilationError, match='does not hang on the ground'):
        compile_model(read_osim(path))


def test_coupler_on_a_coupled_coordinate_is_named(write_model):
    coupler = """<CoordinateCouplerConstraint name="{}"><coupled_coordinates_function>
      <LinearFunction><coefficients>1 0</coefficients></LinearFunction>
      </coupled_coordinates_function>
      <independent_coordinate_names>{}</independent_coordinate_names>
      <dependent_coordinate_name>{}</dependent_coordinate_name></CoordinateCouplerConstraint>"""
    both = coupler.format('a', 'q1', 'q2') + coupler.format('b', 'q2', 'q1')
    with pytest.raises(ModelCompilationError, match="coupler 'a' is itself coupled"):
        compile_model(read_osim(write_model(constraints=both)))


def test_unknown_names_are_refused(pendulum):
    for look_up in (pendulum.body_index, pendulum.coordinate_index):
        with pytest.raises(UnknownNameError, match='nobody'):
            look_up('nobody')


def test_lifting_model_has_forty_independent_coordinates(lifting_multibody):
    assert len(lifting_multibody.coordinate_names) == 40
    assert len(lifting_multibody.tree_coordinate_names) == 62
    assert not any(name.startswith(('L4_', 'Abs_')) for name in lifting_multibody.coordinate_names)
