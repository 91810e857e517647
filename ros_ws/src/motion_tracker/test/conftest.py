# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A person with markers, recordings, and where the data are."""

from collections import namedtuple
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from motion_tracker.core.calibration import calibrate
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.markers.marker_model import from_anthropometry
from motion_tracker.core.markers.marker_set import load_marker_set

ROOT = Path(__file__).resolve().parents[4]
SQUATS = ROOT.parent / 'shared' / 'data' / 'squats_bodyweight'

# Stamp [s] at which the made-up lift begins, mass [kg] of its box.
LIFT_START, LIFT_MASS, GRAVITY = 1.7e9, 10.0, 9.80665

Squats = namedtuple('Squats', 'subject marker_set calibrated names time markers wrenches')


@pytest.fixture(scope='session')
def person():
    """Marker model of a person of common size; no calibration."""
    return Subject('P01', 'male', 72.0, 1.78, 33.0)


@pytest.fixture(scope='session')
def marker_set():
    return load_marker_set('plug_in_gait_58')


@pytest.fixture(scope='session')
def skeleton(person):
    return Skeleton3D.of(person)


@pytest.fixture(scope='session')
def solver(person, skeleton, marker_set):
    return InverseKinematics(skeleton, from_anthropometry(marker_set, person))


@pytest.fixture(scope='session')
def crouch(skeleton):
    """Coordinates of a slightly uneven crouch with arms forward."""
    values = {
        'pelvis_tx': 0.1,
        'pelvis_ty': 0.6,
        'pelvis_tz': -0.05,
        'pelvis_tilt': -0.6,
        'lumbar_extension': -0.38,
        'thorax_extension': -0.22,
        'lumbar_rotation': 0.1,
        'thorax_rotation': 0.08,
    }
    for side, extra in (('r', 0.0), ('l', 0.05)):
        values |= {
            f'hip_flexion_{side}': 1.3 + extra,
            f'knee_angle_{side}': 1.2 - extra,
            f'ankle_angle_{side}': 0.3,
            f'arm_flex_{side}': 1.0 + extra,
            f'elbow_flex_{side}': 0.4,
            f'pro_sup_{side}': 0.2,
            f'hip_adduction_{side}': -0.1,
            f'mtp_angle_{side}': 0.05,
        }
    return skeleton.vector(values)


def step(time, begin, duration):
    """Return a smooth step from 0 to 1."""
    s = np.clip((time - begin) / duration, 0.0, 1.0)
    return 10 * s**3 - 15 * s**4 + 6 * s**5


@pytest.fixture(scope='session')
def lift(skeleton, solver, crouch, person):
    """Frames of a crouching person who rises with a box between the hands, as (kind, ...)."""
    rng = np.random.default_rng(6)
    stand = skeleton.vector(
        {'arm_flex_r': 0.5, 'arm_flex_l': 0.5, 'elbow_flex_r': 0.5, 'elbow_flex_l': 0.5},
        skeleton.standing(),
    )
    markers, box, wrench = [], [], []
    for i in range(300):
        t = i / 100.0
        q = crouch + float(step(t, 1.0, 1.0)) * (stand - crouch)
        points = skeleton.points(q)
        centre = (points['hand_r'] + points['hand_l']) / 2
        positions = solver.predict(q) + rng.normal(0.0, 5e-4, (54, 3))
        markers.append(('markers', LIFT_START + t, positions))
        box.append(('box', LIFT_START + t, centre + rng.normal(0.0, 3e-4, 3)))
        weight = (person.mass + LIFT_MASS) * GRAVITY / 2
        for k in range(2):
            for side, y in (('right', -0.15), ('left', 0.15)):
                force = np.array([0.0, 0.0, weight]) + rng.normal(0.0, 1.0, 3)
                wrench.append(
                    (side, LIFT_START + t + k / 200.0, force, np.cross([0.1, y, 0.0], force))
                )
    return markers, box, wrench


@pytest.fixture(scope='session')
def sides(lift):
    """Return the right and left plate as streams of their own."""
    return tuple([m for m in lift[2] if m[0] == side] for side in ('right', 'left'))


def read_trc(path):
    """Return names, time [s] and positions in REP-103 axes [m] of a file in metres, y up."""
    lines = path.read_text(encoding='utf-8').splitlines()
    names = [name for name in lines[3].split('\t')[2:] if name.strip()]
    rows = [line.split('\t') for line in lines[5:] if line.split('\t')[0].strip()]
    table = np.array([[float(cell) for cell in row[1 : 2 + 3 * len(names)]] for row in rows])
    xyz = table[:, 1:].reshape(len(table), -1, 3)
    return names, table[:, 0], np.stack([xyz[..., 0], -xyz[..., 2], xyz[..., 1]], axis=-1)


def read_wrenches(path):
    """Return time and the wrenches about the origin of right and left plate, REP-103."""
    body = path.read_text(encoding='utf-8').split('endheader\n')[1].strip().splitlines()[1:]
    table = np.array([[float(cell) for cell in line.split('\t')] for line in body])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    wrenches = {}
    for k, side in enumerate(('right', 'left')):
        force, at, free = (table[:, 1 + 9 * k + 3 * i : 4 + 9 * k + 3 * i] for i in range(3))
        wrenches[side] = (force @ turn.T, (np.cross(at, force) + free) @ turn.T)
    return table[:, 0], wrenches


@pytest.fixture(scope='session')
def squats():
    """Return the public recording of five squats, calibrated from its static trial."""
    if not SQUATS.is_dir():
        pytest.skip(f'the recording is not at {SQUATS}')
    subject = Subject('S04', 'female', 62.6, 1.68, 30.0)
    markers = load_marker_set('opencap_lab_51')
    names, _, static = read_trc(SQUATS / 'static1.trc')
    calibrated = calibrate(markers, names, static, subject)
    names, time, positions = read_trc(SQUATS / 'squats1.trc')
    plate_time, wrenches = read_wrenches(SQUATS / 'squats1_grf.mot')
    assert np.array_equal(plate_time, time)
    return Squats(
        replace(subject, calibration=calibrated.calibration),
        markers,
        calibrated,
        names,
        time,
        positions,
        wrenches,
    )
