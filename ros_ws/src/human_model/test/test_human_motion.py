# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Motion blocks and lifts."""

import io
from dataclasses import replace

import numpy as np
import pytest

from human_model.exceptions import MotionError
from human_model.motion import BodyMotion, Lift, concatenate
from human_model.report import SolveReport


@pytest.fixture
def motion(body, rng):
    q = body.standing() + 0.1 * rng.normal(size=(10, 40))
    return body.body_motion(
        np.arange(10) / 100, q, 0 * q, 0 * q, box_position=np.full((10, 3), 0.5)
    )


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
    assert np.all(np.isnan(again.centre_of_pressure))


def test_columns_by_name(motion, body):
    assert motion.point('l5_s1').shape == (10, 3)
    assert motion.frame('thorax').shape == (10, 4)
    assert motion.coordinate('knee_angle_r') == pytest.approx(
        motion.position[:, body.index('knee_angle_r')]
    )
    with pytest.raises(MotionError, match="no point named 'nose'"):
        motion.point('nose')


def test_arrays_lie_in_rows_whatever_they_were_made_from(motion):
    """Compiled functions are made for one layout: another one would hold up a running node."""
    columns = np.asfortranarray(motion.points)
    again = replace(motion, points=columns)
    assert again.points.flags.c_contiguous
    assert np.array_equal(again.points, columns)
    assert again[2:4].points.flags.c_contiguous


def test_arrays_cannot_be_written(motion):
    with pytest.raises(ValueError, match='read-only'):
        motion.points[0, 0, 0] = 1.0


@pytest.mark.parametrize(
    ('name', 'change', 'words'),
    [
        ('points', lambda a: a[:, :-1], r'motion.points: shape \(10, 24, 3\)'),
        ('time', lambda a: a[::-1], 'motion.time: not increasing'),
        ('time', lambda a: a * np.nan, 'motion.time: not finite'),
        (
            'position',
            lambda a: np.where(np.arange(10)[:, None] == 3, np.nan, a),
            'motion.position: not finite in sample 3',
        ),
        ('frames', lambda a: 2 * a, 'motion.frames.*length 2'),
        ('skeleton', lambda a: 'stick', 'motion.skeleton'),
        ('hand_force', lambda a: 'much', 'motion.hand_force: not an array'),
    ],
)
def test_bad_arrays_are_named(motion, name, change, words):
    changed = fields(motion)
    changed[name] = change(changed[name])
    with pytest.raises(MotionError, match=words):
        BodyMotion.from_dict(changed)


def test_missing_field_is_named(motion):
    changed = fields(motion)
    del changed['centre_of_pressure']
    with pytest.raises(MotionError, match=r'motion\.centre_of_pressure: missing'):
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
    for changes, words in (
        ({'source': 'guessed'}, 'lift.source'),
        ({'end': 0.01}, 'lift.end'),
        ({'box_mass': -1.0}, 'lift.box_mass'),
        ({'lift_id': ''}, 'lift_id'),
    ):
        with pytest.raises(MotionError, match=words):
            Lift(**{**lift.__dict__, **changes})
    with pytest.raises(MotionError, match='no sample'):
        _ = Lift('7', 'measured', 5.0, 6.0, 7.0, motion, SolveReport()).window


@pytest.mark.parametrize('samples', [1, 10])
@pytest.mark.parametrize('name', ['position', 'points', 'frames', 'hand_force'])
@pytest.mark.parametrize('value', [np.nan, np.inf, -np.inf])
def test_a_value_that_is_not_finite_is_found_in_one_sample_and_in_many(
    motion, samples, name, value
):
    changed = fields(motion[:samples])
    changed[name] = changed[name].copy()
    changed[name][-1].flat[-1] = value
    with pytest.raises(MotionError, match=rf'motion\.{name}: not finite in sample {samples - 1}'):
        BodyMotion.from_dict(changed)


def test_values_whose_squares_are_beyond_all_numbers_are_finite(motion):
    changed = {**fields(motion), 'velocity': np.full((10, 40), 1e200)}
    assert np.all(BodyMotion.from_dict(changed).velocity == 1e200)


@pytest.mark.parametrize('samples', [1, 10])
@pytest.mark.parametrize(
    ('length', 'refused'), [(0.9985, True), (0.9995, False), (1.0005, False), (1.0015, True)]
)
def test_the_quaternion_farthest_from_a_rotation_is_named(motion, samples, length, refused):
    changed = fields(motion[:samples])
    changed['frames'] = changed['frames'].copy()
    changed['frames'][-1, 2] *= length
    if refused:
        with pytest.raises(MotionError, match=f'a quaternion of length {length:.4f}'):
            BodyMotion.from_dict(changed)
    else:
        assert len(BodyMotion.from_dict(changed)) == samples


def test_what_the_caller_does_to_its_arrays_does_not_change_the_motion(motion):
    changed = {name: np.array(value) for name, value in fields(motion).items()}
    block = BodyMotion.from_dict(changed)
    changed['points'][:] = 7.0
    assert np.array_equal(block.points, motion.points)


def test_a_motion_without_frames_or_points_is_one(motion):
    changed = {
        **fields(motion[:1]),
        'frame_names': (),
        'frames': np.empty((1, 0, 4)),
        'point_names': (),
        'points': np.empty((1, 0, 3)),
    }
    assert BodyMotion.from_dict(changed).frames.shape == (1, 0, 4)
