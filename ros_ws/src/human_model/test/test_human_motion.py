# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Motion blocks and lifts."""

import io

import numpy as np
import pytest

from human_model.errors import MotionError
from human_model.motion import BodyMotion, Lift, concatenate
from human_model.report import SolveReport


@pytest.fixture
def motion(body, rng):
    q = body.standing() + 0.1 * rng.normal(size=(10, 40))
    return body.body_motion(np.arange(10) / 100, q, 0 * q, 0 * q,
                            box_position=np.full((10, 3), 0.5))


def fields(motion):
    return dict(motion.to_dict())


def test_slices_and_joins(motion):
    assert len(motion[2:5]) == 3
    assert motion[-1].time == pytest.approx([0.09])
    whole = concatenate([motion[:4], motion[4:]])
    for name, value in motion.to_dict().items():
        assert np.array_equal(whole.to_dict()[name], value, equal_nan=value.dtype.kind == 'f')
    assert [block.time[0] for block in motion] == pytest.approx(motion.time)
    with pytest.raises(MotionError, match='not increasing'):
        concatenate([motion[4:], motion[:4]])
    with pytest.raises(MotionError, match='no block'):
        concatenate([])


def test_through_a_file(motion):
    file = io.BytesIO()
    np.savez(file, **motion.to_dict())
    file.seek(0)
    with np.load(file) as stored:
        again = BodyMotion.from_dict(stored)
    assert again.coordinates == motion.coordinates
    assert again.skeleton == '3d_40dof'
    assert np.array_equal(again.points, motion.points)
    assert np.all(np.isnan(again.cop))


def test_columns_by_name(motion, body):
    assert motion.point('l5_s1').shape == (10, 3)
    assert motion.frame('thorax').shape == (10, 4)
    assert motion.coordinate('knee_angle_r') == pytest.approx(
        motion.position[:, body.index('knee_angle_r')])
    with pytest.raises(MotionError, match="no point named 'nose'"):
        motion.point('nose')


def test_arrays_cannot_be_written(motion):
    with pytest.raises(ValueError, match='read-only'):
        motion.points[0, 0, 0] = 1.0


@pytest.mark.parametrize(('name', 'change', 'words'), [
    ('points', lambda a: a[:, :-1], r'motion.points: shape \(10, 24, 3\)'),
    ('time', lambda a: a[::-1], 'motion.time: not increasing'),
    ('time', lambda a: a * np.nan, 'motion.time: not finite'),
    ('position', lambda a: np.where(np.arange(10)[:, None] == 3, np.nan, a),
     'motion.position: not finite in sample 3'),
    ('frames', lambda a: 2 * a, 'motion.frames.*length 2'),
    ('skeleton', lambda a: 'stick', 'motion.skeleton'),
    ('hand_force', lambda a: 'much', 'motion.hand_force: not an array'),
])
def test_bad_arrays_are_named(motion, name, change, words):
    changed = fields(motion)
    changed[name] = change(changed[name])
    with pytest.raises(MotionError, match=words):
        BodyMotion.from_dict(changed)


def test_missing_field_is_named(motion):
    changed = fields(motion)
    del changed['cop']
    with pytest.raises(MotionError, match=r'motion\.cop: missing'):
        BodyMotion.from_dict(changed)


def test_lift_cuts_its_window(motion):
    lift = Lift('7', 'measured', 0.02, 0.05, 7.0, motion, SolveReport())
    assert lift.window.time == pytest.approx([0.02, 0.03, 0.04, 0.05])
    file = io.BytesIO()
    np.savez(file, **lift.to_dict())
    file.seek(0)
    with np.load(file) as stored:
        again = Lift.from_dict(stored)
    assert (again.lift_id, again.end, again.report) == ('7', 0.05, SolveReport())
    assert np.array_equal(again.motion.position, motion.position)
    with pytest.raises(MotionError, match=r'lift\.lift_id: missing'):
        Lift.from_dict({})
    for changes, words in (({'source': 'guessed'}, 'lift.source'), ({'end': 0.01}, 'lift.end'),
                           ({'box_mass': -1.0}, 'lift.box_mass'), ({'lift_id': ''}, 'lift_id')):
        with pytest.raises(MotionError, match=words):
            Lift(**{**lift.__dict__, **changes})
    with pytest.raises(MotionError, match='no sample'):
        _ = Lift('7', 'measured', 5.0, 6.0, 7.0, motion, SolveReport()).window
