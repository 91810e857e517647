# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Shared core types survive a message unchanged."""

import numpy as np
import pytest

from human_model.exceptions import MotionError, SubjectError
from human_model.motion import FRAMES, POINTS, BodyMotion, Lift
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Calibration, Subject
from lifting_messages import conversions, message_type


def make_motion(n=3):
    """Return a block of made-up motion with every value different."""
    rng = np.random.default_rng(1)
    frames = rng.normal(size=(n, len(FRAMES), 4))
    frames /= np.linalg.norm(frames, axis=-1, keepdims=True)
    cop = rng.normal(size=(n, 2, 3))
    cop[0, 1] = np.nan
    return BodyMotion(
        time=1_763_000_000.5 + 0.01 * np.arange(n),
        skeleton='3d_40dof',
        coordinates=('hip_flexion_r', 'knee_angle_r'),
        position=rng.normal(size=(n, 2)),
        velocity=rng.normal(size=(n, 2)),
        acceleration=rng.normal(size=(n, 2)),
        point_names=POINTS,
        points=rng.normal(size=(n, len(POINTS), 3)),
        frame_names=FRAMES,
        frames=frames,
        ground_force=rng.normal(size=(n, 2, 3)),
        centre_of_pressure=cop,
        free_moment=rng.normal(size=(n, 2, 3)),
        hand_force=rng.normal(size=(n, 2, 3)),
        box_position=np.full((n, 3), np.nan),
    )


SUBJECT = Subject(
    'p07',
    'female',
    61.0,
    1.66,
    44.0,
    -0.5,
    {'thigh': 0.4},
    Calibration(('C7', 'LASI'), ('thorax', 'pelvis'), np.arange(6.0).reshape(2, 3), {}, 0.004),
)


def test_motion_survives_a_message():
    """Every array comes back, NaN included."""
    motion = make_motion()
    quality = conversions.MotionQuality(
        0.07, np.array([0, 0, 101]), np.array([0.01, 0.011, np.nan]), np.full(3, 0.03)
    )
    message = conversions.motion_to_msg(motion, quality)
    back = conversions.motion_from_msg(message)
    np.testing.assert_allclose(back.time, motion.time, atol=1e-6)
    for name in (
        'position',
        'velocity',
        'points',
        'frames',
        'ground_force',
        'centre_of_pressure',
        'hand_force',
    ):
        np.testing.assert_array_equal(getattr(back, name), getattr(motion, name))
    assert conversions.quality_from_msg(message).status.tolist() == [0, 0, 101]


def test_a_motion_message_of_the_wrong_size_is_refused_by_field():
    """A short array names itself."""
    message = conversions.motion_to_msg(make_motion(), conversions.MotionQuality.exact(3))
    message.points = message.points[:-1]
    with pytest.raises(MotionError, match='points'):
        conversions.motion_from_msg(message)


def test_lift_survives_a_message():
    """Window, masses and report come back."""
    motion = make_motion()
    lift = Lift(
        'lift_001',
        'measured',
        motion.time[0],
        motion.time[-1],
        7.0,
        motion,
        SolveReport(SolveStatus.TRACKER_NOT_CONVERGED, 'frame 2', 40, 1.0, 2.0, 3.0, 4.0, 5.0),
    )
    back = conversions.lift_from_msg(
        conversions.lift_to_msg(lift, conversions.MotionQuality.exact(3), SUBJECT)
    )
    assert back.report == lift.report
    assert back.end - back.start == pytest.approx(0.02, abs=1e-6)
    assert (back.lift_id, back.box_mass) == ('lift_001', 7.0)


def test_subject_survives_a_message_with_its_calibration():
    """Pseudonym, measures and marker offsets come back."""
    message = conversions.subject_to_msg(SUBJECT, 0.0, 'plug_in_gait_58', 'test')
    back = conversions.subject_from_msg(message)
    assert (back.pseudonym, back.sex, back.mass) == ('p07', 'female', 61.0)
    assert back.lengths == {'thigh': 0.4}
    np.testing.assert_array_equal(
        back.calibration.local_offsets, SUBJECT.calibration.local_offsets
    )


def test_a_subject_message_with_an_impossible_mass_is_refused():
    """Grams are not kilograms."""
    message = conversions.subject_to_msg(SUBJECT, 0.0, 'plug_in_gait_58', 'test')
    message.mass = 61_000.0
    with pytest.raises(SubjectError, match='mass'):
        conversions.subject_from_msg(message)


def test_status_codes_of_message_and_model_are_the_same():
    """A code never means one thing in a bag and another in the code."""
    for status in SolveStatus:
        assert getattr(message_type('SolveReport'), status.name) == int(status)
