# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Models of other groups against OpenSim 4.6 in random postures: frames, markers, muscles.

The models are in wheels of PyPI; ``scripts/reference_models.py`` takes them out of there, and
without it these tests are skipped.  The reference files were made by
``reference/make_model_references.py``.

Three differences have a known cause and are measured apart:

* OpenSim rewrites a file of version 3 through text of six digits, so that the frames of such a
  model differ by some 1e-6;
* of paths over two cylinders OpenSim's tangent points may leave the surface (gastrocnemii: it
  reports moment arms of up to 0.5 mm about the hips, which these muscles do not cross);
* of some paths over the half of a cylinder (supinators) OpenSim adds the arc the other way round
  to the same tangents. Its lengths are then up to 34 mm longer and do not have its moment arms
  for derivatives; ours have.
"""

from functools import cache
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.osim.reader import read_osim

HERE = Path(__file__).parents[1]
MODELS = HERE.parents[3] / '.cache' / 'reference_models'
#: Bodies, independent coordinates, muscles, and the accuracy of the frames.
NAMES = {
    'Rajagopal2015': (22, 29, 80, 5e-6),
    'Full_Body_with_ball': (53, 45, 573, 1e-12),
    'GPK_generic': (24, 23, 100, 1e-12),
    'Neck_model': (15, 5, 72, 1e-12),
    'arm26_ball': (4, 8, 6, 1e-12),
}
ELLIPSOID, SEVERAL = 'ellipsoid', 'several'


@cache
def reference(name):
    return dict(np.load(HERE / 'reference' / f'model_{name}.npz'))


@cache
def compiled(name):
    """Compile a model; the neck's bushings act besides its muscles and are left out."""
    path = MODELS / f'{name}.osim'
    if not path.is_file():
        pytest.skip(f'{path.name} is not in {MODELS}: run scripts/reference_models.py')
    if sha256(path.read_bytes()).hexdigest() != str(reference(name)['sha256']):
        pytest.skip(f'{path} is not the file that the reference was made from')
    return compile_model(read_osim(path, {'BushingForce'}))


def state_at(model, q):
    zero = np.zeros_like(q)
    return forward_kinematics(model.tree, q, zero, zero)


def postures(name):
    """Return the reference's postures (n, n_q) in the model's order, and that order."""
    model, data = compiled(name), reference(name)
    order = [list(data['coordinates']).index(c) for c in model.coordinate_names]
    return data['posture'][:, order], order


@cache
def our_paths(name):
    model = compiled(name)
    table = path_table(model)
    found = []
    for q in postures(name)[0]:
        state = state_at(model, q)
        found.append(posture_paths(table, state, body_jacobians(model.tree, state)))
    return np.array([p.length for p in found]), np.array([p.moment_arm for p in found])


def surfaces(model):
    """Tell of each muscle what it wraps over: '', a kind, or `SEVERAL`."""
    kinds = {surface.name: surface.kind for surface in model.source.wrap_objects}
    return np.array(
        [
            SEVERAL if len(m.wraps) > 1 else ''.join(kinds[w.wrap_object] for w in m.wraps)
            for m in model.source.muscles
        ]
    )


@pytest.mark.parametrize('name', NAMES)
def test_model_is_read_whole(name):
    model, data = compiled(name), reference(name)
    counts = len(model.source.bodies), len(model.coordinate_names), len(model.source.muscles)
    assert counts == NAMES[name][:3]
    assert set(model.coordinate_names) == set(data['coordinates'])
    assert {body.name for body in model.source.bodies} == set(data['bodies'])
    assert [muscle.name for muscle in model.source.muscles] == list(data['muscles'])
    assert [marker.name for marker in model.source.markers] == list(data['markers'])


@pytest.mark.parametrize('name', NAMES)
def test_frames_and_markers_equal_opensim(name):
    model, data = compiled(name), reference(name)
    bodies = [model.body_index(body) for body in data['bodies']]
    for k, q in enumerate(postures(name)[0]):
        state = state_at(model, q)
        tolerance = NAMES[name][3]
        np.testing.assert_allclose(state.position[bodies], data['position'][k], atol=tolerance)
        np.testing.assert_allclose(state.rotation[bodies], data['rotation'][k], atol=tolerance)
        for i, marker in enumerate(model.source.markers):
            at = model.body_index(marker.body)
            place = state.position[at] + state.rotation[at] @ marker.location
            np.testing.assert_allclose(place, data['marker'][k, i], atol=tolerance)


@pytest.mark.parametrize('name', NAMES)
def test_moment_arms_equal_opensim(name):
    _, arms = our_paths(name)
    expected = reference(name)['moment_arm'][:, :, postures(name)[1]]
    error = np.abs(arms - expected)
    active = error[np.abs(expected) > 1e-6]
    assert np.median(active) < 1e-8
    assert np.percentile(active, 99) < 0.25e-3
    assert error.max() < 0.6e-3
    kinds = surfaces(compiled(name))
    rounding = 2e-7 if name == 'Rajagopal2015' else 1e-8
    plain = ~np.isin(kinds, [ELLIPSOID, SEVERAL])
    assert error[:, plain].max() < rounding
    if np.any(kinds == ELLIPSOID):
        assert np.percentile(error[:, kinds == ELLIPSOID], 99.9) < 0.03e-3


def supinators(model):
    return np.array([muscle.name.startswith('supinator') for muscle in model.source.muscles])


@pytest.mark.parametrize('name', NAMES)
def test_lengths_equal_opensim(name):
    lengths, _ = our_paths(name)
    error = np.abs(lengths - reference(name)['length'])
    kinds = surfaces(compiled(name))
    rounding = 1e-7 if name == 'Rajagopal2015' else 1e-12
    plain = ~np.isin(kinds, [ELLIPSOID, SEVERAL]) & ~supinators(compiled(name))
    assert error[:, plain].max() < rounding
    assert error[:, kinds == ELLIPSOID].max(initial=0.0) < 0.03e-3
    assert error[:, kinds == SEVERAL].max(initial=0.0) < 5.5e-3


def test_where_arcs_go_the_other_way_round_moment_arms_agree():
    """Both have the same tangents; ours has the arc that goes on smoothly from them."""
    model = compiled('Full_Body_with_ball')
    lengths, arms = our_paths('Full_Body_with_ball')
    data, (q, order) = reference('Full_Body_with_ball'), postures('Full_Body_with_ball')
    other_way = data['length'] - lengths > 1e-3
    assert other_way.any()
    assert not np.any(other_way[:, ~supinators(model)])
    expected = data['moment_arm'][:, :, order]
    np.testing.assert_allclose(arms[other_way], expected[other_way], atol=1e-8)
    # Geodesics, whose moment arms are the derivatives of their lengths if nothing jumps.
    table = path_table(model, geodesic=True)
    posture, muscle = np.argwhere(other_way)[0]
    moving = np.flatnonzero(np.abs(arms[posture, muscle]) > 1e-4)
    assert moving.size > 0
    for j in moving:
        step = 1e-6 * (np.arange(len(order)) == j)
        here, longer, shorter = (
            posture_paths(table, state, body_jacobians(model.tree, state))
            for state in (state_at(model, q[posture] + share * step) for share in (0, 1, -1))
        )
        derivative = (longer.length[muscle] - shorter.length[muscle]) / 2e-6
        assert here.moment_arm[muscle, j] == pytest.approx(-derivative, abs=1e-8)


def test_conditional_points_come_and_go_in_the_postures():
    """The comparison covers both sides of the ranges."""
    model = compiled('Full_Body_with_ball')
    points = [p for m in model.source.muscles for p in m.points if p.kind == 'conditional']
    assert len(points) == 34
    names, (q, _) = list(model.coordinate_names), postures('Full_Body_with_ball')
    there = [
        p.range[0] <= angle <= p.range[1]
        for p in points
        for angle in q[:, names.index(p.coordinate)]
    ]
    assert 0.1 < np.mean(there) < 0.9
