# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Shared body points and frames on a musculoskeletal model, and its scale factors.

`data/body_points.csv` has the body that carries each shared point. A point is a joint's
centre (`joint`), the middle of two (`middle`), or is carried by a body at the place that the
subject's own point has relative to a joint in upright standing (`registered`), as markers are
registered: so hands and feet have the subject's dimensions exactly. Registration is in upright
standing with hanging arms and palms in: all coordinates zero but those of
`data/upright_posture.csv`. That is the posture of the skeletons of `human_model` at zero
coordinates, in which all shared frames are parallel to the world's.

`data/scale_rules.csv` says which distance between points, or which length of the subject that no
two points hold (`data/model_lengths.csv` has the model's), gives a body's scale factors. The
sacrum, welded to the pelvis, takes what the pelvis' factors leave of the way to the lumbosacral
joint (`rest`), so that this joint is where the subject has it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from human_model.frames import to_opensim
from human_model.tables import Row, read_table
from human_model.typing import Array
from muscle_analyzer.core.exceptions import ScalingError
from muscle_analyzer.core.multibody.kinematics import BodyState, forward_kinematics
from muscle_analyzer.core.multibody.model import MultibodyModel

_MIDDLES = {'shoulder_mid': ('shoulder_r', 'shoulder_l')}
# Components of a difference in OpenSim's axes that a measure counts.
_MEASURES = {'distance': [0, 1, 2], 'sagittal': [0, 1], 'forward': [0], 'up': [1]}


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """Points and frames of one model that stand for those of a body motion.

    Attributes
    ----------
    names : tuple of str, n_p
    body : (n_p,) int array
        Index of the body that carries each point.
    local : (n_p, 3) array
        In the body's axes, m.
    sigma : (n_p,) array
        Distance that counts as one unit of misfit, m.
    frame_names : tuple of str, n_f
    frame_body : (n_f,) int array
    frame_upright : (n_f, 3, 3) array
        Ground <- body in upright standing, where the shared frame is parallel to the ground's.
    frame_sigma : (n_f,) array
        Angle that counts as one unit of misfit, rad.
    """

    names: tuple[str, ...]
    body: NDArray[np.int64]
    local: Array
    sigma: Array
    frame_names: tuple[str, ...]
    frame_body: NDArray[np.int64]
    frame_upright: Array
    frame_sigma: Array


def _table(name: str, columns: str) -> tuple[Row, ...]:
    return read_table('muscle_analyzer', f'{name}.csv', columns)


def _point_rows() -> tuple[Row, ...]:
    return _table('body_points', 'point rule body joints reference x y z sigma')


def upright_coordinates(model: MultibodyModel) -> Array:
    """Return the independent coordinates (n_q,) of upright standing with palms in, rad or m."""
    q = np.zeros(len(model.coordinate_names))
    for row in _table('upright_posture', 'coordinate value'):
        q[model.coordinate_index(row['coordinate'])] = row.number('value')
    return q


def upright_state(model: MultibodyModel) -> BodyState:
    """Return where the bodies are in upright standing with palms in, at rest."""
    zero = np.zeros(len(model.coordinate_names))
    return forward_kinematics(model.tree, upright_coordinates(model), zero, zero)


def generic_points(model: MultibodyModel) -> dict[str, Array]:
    """Return the points (3,) of the unscaled model standing upright, OpenSim's axes, m."""
    state = upright_state(model)
    points = {}
    for row in _point_rows():
        body = model.body_index(row['body'])
        if row['rule'] == 'joint':
            points[row['point']] = state.joint_position[body]
        elif row['rule'] == 'middle':
            points[row['point']] = _reference(model, state.joint_position, row)
        elif row['x']:
            local = np.array(row.numbers(*'xyz'))
            points[row['point']] = state.position[body] + state.rotation[body] @ local
    return points


def _reference(model: MultibodyModel, joint_position: Array, row: Row) -> Array:
    """Return the mean position of the joints that a row names by their bodies."""
    indices = [model.body_index(body) for body in row['joints'].split()]
    mean: Array = joint_position[indices].mean(axis=0)
    return mean


def _subject_points(points: Mapping[str, Array]) -> dict[str, Array]:
    """Return the subject's points in OpenSim's axes, checked, with middles added."""
    wanted = [row['point'] for row in _point_rows()]
    if missing := [name for name in wanted if name not in points]:
        raise ScalingError(f'points of the subject: {missing[0]!r} is missing')
    converted = {}
    for name in wanted:
        point = np.asarray(points[name], dtype=np.float64)
        if point.shape != (3,) or not np.all(np.isfinite(point)):
            raise ScalingError(f'points of the subject: {name!r} is {point}, want three numbers')
        converted[name] = to_opensim(point)
    return _with_middles(converted)


def _with_middles(points: dict[str, Array]) -> dict[str, Array]:
    for name, (first, second) in _MIDDLES.items():
        points[name] = 0.5 * (points[first] + points[second])
    return points


def _lengths(name: str, lengths: Mapping[str, float]) -> tuple[float, float]:
    """Return a length of the subject and the same of the unscaled model, m."""
    if name not in lengths:
        raise ScalingError(f'lengths of the subject: {name!r} is missing')
    model = {row['length']: row for row in _table('model_lengths', 'length value')}
    return float(lengths[name]), model[name].number('value')


def scale_factors(
    model: MultibodyModel, points: Mapping[str, Array], lengths: Mapping[str, float]
) -> dict[str, Array]:
    """Return the factors (3,) per body that give the model the subject's dimensions.

    Parameters
    ----------
    model : MultibodyModel
        The generic model.
    points : mapping of str to (3,) array
        The subject's shared points in upright standing with hanging arms, REP-103 axes, m.
    lengths : mapping of str to float
        The subject's segment lengths, m (`human_model.anthropometry`).

    Raises
    ------
    ScalingError
        If a point or length is missing or not finite, or a rule's distance is zero.
    """
    subject = _subject_points(points)
    generic = _with_middles(generic_points(model))
    factors = {name: np.full(3, np.nan) for name in model.body_names[1:]}
    for row in _table('scale_rules', 'body axes from to measure'):
        if row['body'] not in factors:
            raise ScalingError(f'scale rule for body {row["body"]!r}, which the model has not')
        ways = [
            source[row['to']] - source[row['from']] if row['to'] else np.zeros(3)
            for source in (subject, generic)
        ]
        for axis in row['axes']:
            k = 'xyz'.index(axis)
            match row['measure']:
                case 'length':
                    own, models = _lengths(row['from'], lengths)
                case 'rest':
                    joint = upright_state(model).joint_position[model.body_index(row['body'])]
                    before = joint[k] - generic[row['from']][k]
                    own, models = ways[0][k] - factors['pelvis'][k] * before, ways[1][k] - before
                case measure:
                    own, models = (float(np.linalg.norm(way[_MEASURES[measure]])) for way in ways)
            if not own * models > 0.0:
                between = f'{row["from"]} to {row["to"]}' if row['to'] else row['from']
                raise ScalingError(
                    f'{between} ({row["measure"]}): {own} m of the subject, '
                    f'{models} m of the model'
                )
            factors[row['body']][k] = own / models
    for name, factor in factors.items():
        if not np.all(np.isfinite(factor)):
            raise ScalingError(f'no scale rule for all axes of body {name!r}')
    return factors


def attach_points(model: MultibodyModel, points: Mapping[str, Array]) -> BodyPoints:
    """Return the shared points and frames as fixed to a scaled model's bodies.

    Parameters
    ----------
    model : MultibodyModel
        Scaled to the subject.
    points : mapping of str to (3,) array
        As for `scale_factors`.

    Raises
    ------
    ScalingError
        If a point is missing or not finite.
    """
    subject = _subject_points(points)
    state = upright_state(model)
    rows = _point_rows()
    local = np.zeros((len(rows), 3))
    bodies = np.array([model.body_index(row['body']) for row in rows], dtype=np.int64)
    for i, (row, body) in enumerate(zip(rows, bodies, strict=True)):
        if row['rule'] == 'joint':
            place = state.joint_position[body]
        else:
            place = _reference(model, state.joint_position, row)
        if row['rule'] == 'registered':
            reference = np.mean([subject[name] for name in row['reference'].split()], axis=0)
            place = place + subject[row['point']] - reference
        local[i] = state.rotation[body].T @ (place - state.position[body])
    frames = _table('body_frames', 'frame body sigma')
    frame_body = np.array([model.body_index(row['body']) for row in frames], dtype=np.int64)
    return BodyPoints(
        names=tuple(row['point'] for row in rows),
        body=bodies,
        local=local,
        sigma=np.array([row.number('sigma') for row in rows]),
        frame_names=tuple(row['frame'] for row in frames),
        frame_body=frame_body,
        frame_upright=state.rotation[frame_body],
        frame_sigma=np.array([row.number('sigma') for row in frames]),
    )
