# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A model with one of everything against OpenSim 4.6, and against derivatives of its own lengths.

``reference/make_specimens.py`` writes the model: every joint type and function in a chain, and
muscles at random over surfaces of every type and half.  What is known to differ, and is measured:

* OpenSim's moment arms about the coordinate that moves a path point are not the derivatives of its
  lengths (with which ours agree); the lengths are the same;
* its speeds of ball and free joints are components of the angular velocity;
* for some tangents on a half of a cylinder, a sphere or a torus it takes the arc the other way
  round, or of negative length; tangents and moment arms are the same;
* over ellipsoids it fails now and then (no number);
* its search for the point of a torus nearest to a segment may end where the residual turns without
  reaching zero (one path here, at -0.024 m, 0.115 m from the end it started at): no point of the
  segment is nearest there, and OpenSim takes it if it looks nearer than the one found from the
  other end.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import UnsupportedElementError
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.osim.reader import read_osim

FOLDER = Path(__file__).parents[1] / 'reference'
REFERENCE = dict(np.load(FOLDER / 'model_specimens.npz'))
#: Joints whose speeds OpenSim defines otherwise.
ANGULAR = ('ball', 'free')


@cache
def specimens():
    return compile_model(read_osim(FOLDER / 'specimens.osim'))


@cache
def postures():
    order = [list(REFERENCE['coordinates']).index(n) for n in specimens().coordinate_names]
    return REFERENCE['posture'][:, order], order


def paths_at(table, q):
    zero = np.zeros_like(q)
    state = forward_kinematics(specimens().tree, q, zero, zero)
    return posture_paths(table, state, body_jacobians(specimens().tree, state))


@cache
def errors():
    """Return the differences of lengths (n, n_m) and moment arms (n, n_m, n_q) from OpenSim's."""
    q, order = postures()
    table = path_table(specimens())
    found = [paths_at(table, posture) for posture in q]
    names = specimens().coordinate_names
    arms = np.array([p.moment_arm for p in found]) - REFERENCE['moment_arm'][:, :, order]
    arms[:, :, [name.startswith(ANGULAR) for name in names]] = 0.0
    for m, muscle in enumerate(specimens().source.muscles):
        for point in muscle.points:
            for coordinate in point.location_coordinates:
                arms[:, m, names.index(coordinate)] = 0.0
    return np.array([p.length for p in found]) - REFERENCE['length'], np.abs(arms)


def muscles_of(*kinds):
    """Tell which muscles are of a kind, by their names."""
    return np.array([m.name.startswith(kinds) for m in specimens().source.muscles])


def test_every_type_is_there():
    model = specimens().source
    kinds = {joint.kind for joint in model.joints}
    fixed = {'Pin', 'Slider', 'Universal', 'Ball', 'Gimbal', 'Planar', 'Free', 'Weld', 'Custom'}
    assert kinds == {f'{kind}Joint' for kind in fixed}
    assert {w.kind for w in model.wrap_objects} == {'cylinder', 'sphere', 'ellipsoid', 'torus'}
    assert {w.quadrant for w in model.wrap_objects} == {'all', 'x', '-x', 'y', '-y', 'z', '-z'}
    points = {point.kind for muscle in model.muscles for point in muscle.points}
    assert points == {'fixed', 'conditional', 'moving'}


def test_frames_and_markers_equal_opensim():
    model = specimens()
    bodies = [model.body_index(name) for name in REFERENCE['bodies']]
    for k, q in enumerate(postures()[0]):
        zero = np.zeros_like(q)
        state = forward_kinematics(model.tree, q, zero, zero)
        np.testing.assert_allclose(state.position[bodies], REFERENCE['position'][k], atol=1e-14)
        np.testing.assert_allclose(state.rotation[bodies], REFERENCE['rotation'][k], atol=1e-14)
        (tip,) = model.source.markers
        at = model.body_index(tip.body)
        place = state.position[at] + state.rotation[at] @ tip.location
        np.testing.assert_allclose(place, REFERENCE['marker'][k, 0], atol=1e-14)


def test_conditional_and_moving_points_equal_opensim():
    lengths, arms = errors()
    chosen = muscles_of('conditional', 'moving')
    assert chosen.sum() == 6
    assert np.abs(lengths[:, chosen]).max() < 1e-14
    assert arms[:, chosen].max() < 1e-8


@pytest.mark.parametrize(('kind', 'other_way'), [('cylinder', 0.05), ('sphere', 0.01)])
def test_cylinders_and_spheres_equal_opensim(kind, other_way):
    lengths, arms = errors()
    chosen = muscles_of(kind)
    assert arms[:, chosen].max() < 1e-8
    differ = np.abs(lengths[:, chosen]) > 1e-12
    assert differ.mean() < other_way
    whole = np.array([m.name.startswith(f'{kind}_hybrid_all') for m in specimens().source.muscles])
    assert np.abs(lengths[:, whole]).max() < 1e-14


def test_tori_equal_opensim():
    lengths, arms = errors()
    chosen = muscles_of('torus')
    assert np.mean(arms[:, chosen].max(axis=2) > 1e-8) < 0.01
    assert arms[:, chosen].max() < 7e-3
    assert np.mean(np.abs(lengths[:, chosen]) > 1e-12) < 0.05


def test_ellipsoids_equal_opensim():
    lengths, arms = errors()
    chosen = muscles_of('ellipsoid')
    assert np.median(arms[:, chosen].max(axis=2)) < 1e-6
    assert arms[:, chosen].max() < 0.05e-3
    failed = np.isnan(lengths[:, chosen])
    assert failed.mean() < 0.02
    assert np.nanmax(np.abs(lengths[:, chosen])) < 0.02e-3


def test_moment_arms_are_the_derivatives_of_the_lengths():
    """Of points of all kinds, and of geodesics on cylinders and spheres, whatever the half."""
    table = path_table(specimens(), geodesic=True)
    chosen = muscles_of('conditional', 'moving', 'cylinder', 'sphere')
    for q in postures()[0][:4]:
        arms = paths_at(table, q).moment_arm[chosen]
        derivative = np.empty_like(arms)
        for j in range(q.size):
            shift = 1e-6 * (np.arange(q.size) == j)
            longer, shorter = paths_at(table, q + shift).length, paths_at(table, q - shift).length
            derivative[:, j] = (longer - shorter)[chosen] / 2e-6
        assert np.abs(arms + derivative).max() < 1e-8


@pytest.mark.parametrize(
    ('name', 'old', 'new', 'named'),
    [
        ('torus_hybrid_x', '<quadrant>x<', '<quadrant>w<', 'torus_hybrid_x: quadrant w'),
        ('ellipsoid_hybrid_x', 'hybrid</method>', 'axial</method>', 'method axial on quadrant x'),
        ('ellipsoid_hybrid_x', 'hybrid</method>', 'midpoint</method>', 'method midpoint on'),
    ],
)
def test_ways_to_wrap_that_are_not_modelled_are_named(tmp_path, name, old, new, named):
    text = (FOLDER / 'specimens.osim').read_text(encoding='utf-8')
    begin = '<wrap_object>' if 'method' in old else 'name="'
    at = text.index(old, text.index(f'{begin}{name}'))
    path = tmp_path / 'changed.osim'
    path.write_text(text[:at] + new + text[at + len(old) :], encoding='utf-8')
    with pytest.raises(UnsupportedElementError, match=f'changed.osim: muscle {name}_.*{named}'):
        path_table(compile_model(read_osim(path)))
