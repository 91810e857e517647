# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated recordings against their stored truth."""

from collections import namedtuple
from pathlib import Path

import numpy as np
import pytest

from human_model.subject import Calibration, Subject
from motion_tracker.core.markers.marker_set import load_marker_set
from motion_tracker.core.tracked import DetectedEvent, MeasuredLift, TrackedFrame
from motion_tracker.core.tracker import MotionTracker

reader = pytest.importorskip('lifting_recordings.reader', reason='rosbags is not installed')

TASKS = ('symmetric_7kg', 'symmetric_12kg', 'symmetric_max', 'asymmetric_7kg')
SAGITTAL = (
    'pelvis_tilt',
    'lumbar_extension',
    'thorax_extension',
    *(
        f'{joint}_{side}'
        for side in 'rl'
        for joint in (
            'arm_flex',
            'elbow_flex',
            'hip_flexion',
            'knee_angle',
            'ankle_angle',
            'mtp_angle',
        )
    ),
)

Run = namedtuple('Run', 'truth time events lift frames')


def seconds(stamp):
    return float(stamp.sec) + float(stamp.nanosec) / 1e9


def vector(message):
    return np.array([message.x, message.y, message.z])


def subject_of(message):
    lengths = dict(zip(message.segment_length_names, message.segment_lengths, strict=True))
    offsets = np.array(message.marker_offsets).reshape(-1, 3)
    calibration = Calibration(
        message.marker_names, message.marker_segments, offsets, lengths, message.calibration_rms
    )
    return Subject(
        message.pseudonym,
        'male',
        message.mass,
        message.stature,
        message.age,
        message.strength_z,
        lengths,
        calibration,
    )


@pytest.fixture(scope='module', params=TASKS)
def run(request):
    folder = Path(__file__).resolve().parents[4] / 'bags' / request.param
    outputs, subject, task, tracker = [], None, None, None
    with reader.BagReader(folder) as bag:
        for topic, _, message in bag.messages():
            name = topic.strip('/')
            if name == 'subject':
                subject = message
            elif name == 'task':
                task = message
            if tracker is None and subject is not None and task is not None:
                tracker = MotionTracker(
                    subject_of(subject),
                    load_marker_set(subject.marker_set),
                    task.box_mass,
                    task.box_size,
                )
            if name == 'markers':
                outputs += tracker.push_markers(
                    seconds(message.header.stamp),
                    message.names.split('\n'),
                    np.reshape(message.positions, (-1, 3)),
                )
            elif name == 'box/pose':
                outputs += tracker.push_box(
                    seconds(message.header.stamp), vector(message.pose.position)
                )
            elif name.endswith('wrench'):
                outputs += tracker.push_wrench(
                    name.split('/')[-2],
                    seconds(message.header.stamp),
                    vector(message.wrench.force),
                    vector(message.wrench.torque),
                )
    outputs += tracker.flush()
    truth = np.load(folder / 'truth.npz')
    (lift,) = [o for o in outputs if isinstance(o, MeasuredLift)]
    return Run(
        truth,
        truth['time'] + 1e-9 * float(truth['start_time_ns']),
        [o for o in outputs if isinstance(o, DetectedEvent)],
        lift,
        [o for o in outputs if isinstance(o, TrackedFrame)],
    )


def at(run, times, name):
    """Truth at other times (n, ...), by linear interpolation."""
    values = np.asarray(run.truth[name], dtype=np.float64)
    flat = values.reshape(len(values), -1)
    found = np.stack([np.interp(times, run.time, column) for column in flat.T], axis=1)
    return found.reshape(len(times), *values.shape[1:])


def rms(values):
    return np.sqrt(np.mean(np.square(values), axis=0))


def test_joint_angles_of_the_sagittal_plane_within_two_degrees(run):
    motion = run.lift.lift.motion
    error = np.degrees(rms(motion.position - at(run, motion.time, 'position')))
    live_time = np.array([f.motion.time[0] for f in run.frames])
    inside = (live_time > run.time[0] + 0.5) & (live_time < run.time[-1])
    live = np.array([f.motion.position[0] for f in run.frames])[inside]
    live_error = np.degrees(rms(live - at(run, live_time[inside], 'position')))
    for name in SAGITTAL:
        column = motion.coordinates.index(name)
        assert error[column] <= 2.0, name
        assert live_error[column] <= 2.0, name


def test_start_and_end_within_twenty_milliseconds(run):
    origin = 1e-9 * float(run.truth['start_time_ns'])
    start, end = run.events
    assert abs(start.event.time - origin - float(run.truth['lift_start'])) <= 0.020
    assert abs(end.event.time - origin - float(run.truth['lift_end'])) <= 0.020


def test_centre_of_pressure_within_five_millimetres(run):
    motion = run.lift.lift.motion
    away = np.linalg.norm(
        motion.centre_of_pressure - at(run, motion.time, 'centre_of_pressure'), axis=2
    )
    assert np.isfinite(away).all()
    assert away.max() <= 5e-3
    times = np.array([f.motion.time[0] for f in run.frames])
    inside = (times > run.time[0] + 0.5) & (times < run.time[-1])
    live = np.array([f.motion.centre_of_pressure[0] for f in run.frames])[inside]
    assert (
        rms(np.linalg.norm(live - at(run, times[inside], 'centre_of_pressure'), axis=2)).max()
        <= 5e-3
    )


def test_hand_force_follows_the_truth_from_the_floor_on(run):
    """Live from standing to the end, the loading of the hands before lift-off included."""
    motion = run.lift.lift.motion
    weight = float(run.truth['box_mass']) * 9.80665
    error = rms((motion.hand_force - at(run, motion.time, 'hand_force')).reshape(-1, 6))
    assert error.max() < 0.05 * weight
    times = np.array([f.motion.time[0] for f in run.frames])
    inside = (times > run.time[0] + 0.5) & (times < run.time[-1])
    live = np.array([f.motion.hand_force[0] for f in run.frames])[inside]
    assert rms((live - at(run, times[inside], 'hand_force')).reshape(-1, 6)).max() < 0.05 * weight
    # Never a step: less than a tenth of the weight from one frame to the next.
    assert np.abs(np.diff(live.sum(axis=1)[:, 2])).max() < 0.1 * weight


def test_hands_and_feet_within_a_centimetre(run):
    motion = run.lift.lift.motion
    away = rms(np.linalg.norm(motion.points - at(run, motion.time, 'points'), axis=2))
    for name in ('hand_r', 'hand_l', 'ankle_r', 'ankle_l', 'mtp_r', 'mtp_l', 'l5_s1'):
        assert away[motion.point_names.index(name)] < 0.01, name
