# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle paths of the lifting full-body model against OpenSim 4.6 and against derivatives.

The reference files were made by ``reference/make_moment_arms.py``.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import (
    body_wrenches,
    crossed_paths,
    muscle_paths,
    posture_paths,
)
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.subject.model_file import lifting_model_path

HERE = Path(__file__).parents[1]
SQUATS = HERE.parents[4] / 'shared' / 'data' / 'squats_bodyweight' / 'opensim46_reference'
MODELS = {'generic': lifting_model_path(), 'squats': SQUATS / 'lfb_subject4.osim'}
CASES = [
    'generic',
    pytest.param(
        'squats',
        marks=pytest.mark.skipif(
            not SQUATS.is_dir(), reason=f'the squat recording is not there: {SQUATS}'
        ),
    ),
]


@cache
def compiled(which):
    return compile_model(read_osim(MODELS[which]))


@cache
def reference(which):
    return dict(np.load(HERE / 'reference' / f'moment_arms_{which}.npz'))


def paths_at(model, table, q):
    zero = np.zeros_like(q)
    bodies = forward_kinematics(model.tree, q, zero, zero)
    return posture_paths(table, bodies, body_jacobians(model.tree, bodies))


def our_paths(which, geodesic=False):
    """Return lengths and moment arms at the reference postures, in the reference's order."""
    model, data = compiled(which), reference(which)
    names = list(model.coordinate_names)
    order = [list(data['coordinates']).index(name) for name in names]
    about = [names.index(name) for name in data['arm_coordinates']]
    table = path_table(model, geodesic)
    found = [paths_at(model, table, posture[order]) for posture in data['posture']]
    assert [muscle.name for muscle in model.source.muscles] == list(data['muscles'])
    lengths = np.array([paths.length for paths in found])
    return lengths, np.array([paths.moment_arm[:, about] for paths in found])


@pytest.mark.parametrize('which', CASES)
def test_moment_arms_equal_opensim(which):
    _, arms = our_paths(which)
    data = reference(which)
    error = np.abs(arms - data['moment_arm'])[np.abs(data['moment_arm']) > 1e-6]
    assert np.median(error) < 1e-9
    assert np.percentile(error, 99) < 0.01e-3
    assert error.max() < 0.35e-3


@pytest.mark.parametrize('which', CASES)
def test_lengths_equal_opensim(which):
    """Compare lengths; of the gastrocnemii only loosely.

    They wrap over two objects, and OpenSim then slides tangent points off the surface: its arc
    is shorter than the straight line between its ends, by up to 4.3 mm in deep knee flexion.
    """
    lengths, _ = our_paths(which)
    data = reference(which)
    error = np.abs(lengths - data['length'])
    twice = np.array([name.startswith('gas') for name in data['muscles']])
    assert error[:, ~twice].max() < 0.04e-3
    assert error[:, twice].max() < 4.5e-3
    wrapped = {muscle.name for muscle in compiled(which).source.muscles if muscle.wraps}
    free = np.array([name not in wrapped for name in data['muscles']])
    assert error[:, free].max() < 1e-9


@pytest.mark.parametrize('which', CASES)
def test_geodesics_differ_from_opensim_by_millimetres_at_most(which):
    _, arms = our_paths(which, geodesic=True)
    assert np.abs(arms - reference(which)['moment_arm']).max() < 4.5e-3


def test_moment_arms_are_minus_the_derivatives_of_the_lengths():
    """Hold for straight paths and geodesics; ellipsoid paths are plane sections and differ."""
    model, data = compiled('generic'), reference('generic')
    table = path_table(model, geodesic=True)
    names = list(model.coordinate_names)
    order = [list(data['coordinates']).index(name) for name in names]
    kinds = {o.name: o.kind for o in model.source.wrap_objects}
    smooth = np.array(
        [all(kinds[w.wrap_object] == 'cylinder' for w in m.wraps) for m in model.source.muscles]
    )
    assert smooth.sum() > 280
    step = 1e-6
    for posture in data['posture'][:4]:
        q = posture[order]
        arms = paths_at(model, table, q).moment_arm
        derivative = np.empty_like(arms)
        for j in range(q.size):
            shift = step * (np.arange(q.size) == j)
            longer = paths_at(model, table, q + shift).length
            derivative[:, j] = (longer - paths_at(model, table, q - shift).length) / (2 * step)
        error = np.abs(arms + derivative)[smooth]
        assert error.max() < 1e-6


def test_arms_of_crossed_coordinates_are_all_that_are_not_zero():
    model = compiled('generic')
    table = path_table(model)
    q = model.lower + 0.6 * (model.upper - model.lower)
    bodies = forward_kinematics(model.tree, q, np.zeros_like(q), np.zeros_like(q))
    found, whole = crossed_paths(table, bodies), paths_at(model, table, q)
    assert np.array_equal(found.length, whole.length)
    assert np.array_equal(found.wrench, whole.wrench)
    muscle = np.repeat(np.arange(found.length.size), np.diff(table.crossed_start))
    arms = np.zeros_like(whole.moment_arm)
    arms[muscle, table.crossed_index] = found.arm
    assert np.array_equal(arms, whole.moment_arm)
    # Against the definition: the wrenches' work per rate of each coordinate.
    jacobian = body_jacobians(model.tree, bodies)
    owner = np.repeat(np.arange(found.length.size), np.diff(table.body_start))
    work = np.einsum('ei,eij->ej', whole.wrench, jacobian[table.body_index])
    total = np.array([work[owner == m].sum(axis=0) for m in range(found.length.size)])
    np.testing.assert_allclose(arms, total, atol=1e-13)


def test_forces_on_the_bodies_balance_and_do_the_work_of_the_moment_arms():
    model = compiled('generic')
    table = path_table(model)
    q = 0.5 * (model.lower + model.upper)
    zero = np.zeros_like(q)
    bodies = forward_kinematics(model.tree, q, zero, zero)
    jacobian = body_jacobians(model.tree, bodies)
    paths = muscle_paths(table, bodies.position, bodies.rotation, jacobian)
    force = np.random.default_rng(1).uniform(0.0, 500.0, paths.length.size)
    wrenches = body_wrenches(table, paths.wrench, force, len(model.body_names))
    # A muscle pulls its bodies together: nothing is left for the whole.
    assert np.abs(wrenches.sum(axis=0)).max() < 1e-9
    torque = np.einsum('bi,bij->j', wrenches, jacobian)
    assert torque == pytest.approx(paths.moment_arm.T @ force, abs=1e-9)
