# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The committed simulated recordings: physics of the truth, and sensors near the truth."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from human_model.named_subjects import named_subject
from human_model.skeletons import Skeleton3D
from lifting_messages.names import split
from lifting_recordings.reader import BagReader
from lifting_recordings.recording import centre_of_pressure

ROOT = Path(__file__).resolve().parents[4]
BAGS = ROOT / 'bags'
LIFTS = ('symmetric_7kg', 'symmetric_12kg', 'symmetric_max', 'asymmetric_7kg')
G = 9.80665
BOX_MASS = {'symmetric_7kg': 7.0, 'symmetric_12kg': 12.0, 'symmetric_max': 233.73 / G}
BOX_MASS['asymmetric_7kg'] = 7.0

pytestmark = pytest.mark.skipif(not BAGS.is_dir(), reason=f'no recordings at {BAGS}')


@pytest.fixture(scope='module', params=LIFTS)
def lift(request):
    """Return name, truth and contents of one recording."""
    truth = dict(np.load(BAGS / request.param / 'truth.npz'))
    found = {}
    with BagReader(BAGS / request.param) as bag:
        for topic, _, message in bag.messages():
            found.setdefault(topic, []).append(message)
    return request.param, truth, found


@pytest.fixture(scope='module')
def skeleton():
    return Skeleton3D.of(named_subject('thesis_ch4'))


def joined(truth, name):
    return truth[name].astype(float)


def wrenches(found, side):
    messages = found[f'/force_plates/{side}/wrench']
    return (
        np.array([(w.force.x, w.force.y, w.force.z) for w in (m.wrench for m in messages)]),
        np.array([(w.torque.x, w.torque.y, w.torque.z) for w in (m.wrench for m in messages)]),
    )


def test_says_that_it_is_simulated_and_what_is_lifted(lift):
    name, truth, found = lift
    task, subject = found['/task'][0], found['/subject'][0]
    assert task.simulated
    assert 'SIMULATED' in task.source
    assert task.task_id == name
    assert task.box_mass == pytest.approx(BOX_MASS[name], abs=1e-3)
    assert (subject.mass, subject.stature, subject.age) == (63.5, 1.69, 31.0)
    assert len(split(found['/markers'][0].names)) == 58
    assert 0.0 < subject.calibration_rms < 2e-3
    assert truth['lift_end'] - truth['lift_start'] > 1.0


def test_bag_is_small(lift):
    assert sum(f.stat().st_size for f in (BAGS / lift[0]).iterdir()) < 3_000_000


def test_momentum_of_person_equals_impulse_of_forces(lift, skeleton):
    """Newton's second law, with the centre of mass differentiated from positions alone."""
    _, truth, _ = lift
    time = truth['time']
    mass = skeleton.total_mass
    centre = np.array([skeleton.centre_of_mass(q) for q in joined(truth, 'position')])
    acceleration = make_interp_spline(time, centre, k=5)(time, nu=2)
    force = joined(truth, 'ground_force').sum(axis=1) + joined(truth, 'hand_force').sum(axis=1)
    residual = force - mass * acceleration - (0.0, 0.0, mass * G)
    # Positions are rounded to single precision (1e-7 m): twice differentiated, some 0.2 N.
    assert np.sqrt(np.mean(residual**2)) < 0.2
    assert np.abs(residual[5:-5]).max() < 1.0


def test_inverse_dynamics_leaves_nothing_at_the_pelvis(lift):
    torque = joined(lift[1], 'torque')
    assert np.abs(torque[:, :6]).max() < 1e-6


def test_hands_carry_the_box_and_take_it_over_without_a_step(lift):
    name, truth, _ = lift
    time, hand = truth['time'], joined(truth, 'hand_force').sum(axis=1)
    weight = BOX_MASS[name] * G
    np.testing.assert_allclose(hand[time < truth['grasp']], 0.0, atol=1e-6)
    at_lift_off = np.interp(truth['lift_start'], time, hand[:, 2])
    assert at_lift_off == pytest.approx(-weight, rel=0.02)
    box = joined(truth, 'box_position')
    acceleration = np.gradient(np.gradient(box, time, axis=0), time, axis=0)
    later = (time > truth['lift_start'] + 0.05) & (time < time[-1] - 0.05)
    expected = -BOX_MASS[name] * (acceleration + (0.0, 0.0, G))
    np.testing.assert_allclose(hand[later], expected[later], atol=0.04 * weight)
    # In 10 ms the force changes by no more than it would if it were built up in 0.2 s.
    assert np.abs(np.diff(hand, axis=0)).max() < weight * 0.05


def test_hands_stay_on_the_box_and_feet_on_the_floor(lift):
    _, truth, found = lift
    names = list(truth['point_names'])
    points = joined(truth, 'points')
    for foot in ('heel_r', 'heel_l', 'toe_r', 'toe_l'):
        place = points[:, names.index(foot)]
        assert np.ptp(place, axis=0).max() < 1e-5
        assert abs(place[0, 2]) < 1e-5
    held = truth['time'] >= truth['lift_start']
    hands = points[held][:, [names.index('hand_r'), names.index('hand_l')]]
    width = found['/task'][0].box_size[1]
    np.testing.assert_allclose(np.linalg.norm(hands[:, 1] - hands[:, 0], axis=1), width, atol=1e-5)
    middle = hands.mean(axis=1) - joined(truth, 'box_position')[held]
    assert np.ptp(middle, axis=0).max() < 1e-5


def test_centre_of_pressure_stays_inside_each_foot(lift):
    _, truth, _ = lift
    names = list(truth['point_names'])
    points, cop = joined(truth, 'points'), joined(truth, 'centre_of_pressure')
    for k, side in enumerate('rl'):
        heel, toe = points[0, names.index(f'heel_{side}')], points[0, names.index(f'toe_{side}')]
        share = (cop[:, k] - heel) @ (toe - heel) / ((toe - heel) @ (toe - heel))
        assert share.min() > 0.05
        assert share.max() < 0.95
        assert joined(truth, 'ground_force')[:, k, 2].min() > 50.0


def test_lift_start_and_end_are_those_of_the_box(lift):
    _, truth, _ = lift
    time, height = truth['time'], joined(truth, 'box_position')[:, 2]
    rising = time[np.flatnonzero(np.diff(height) > 1e-6)[0]]
    assert 0.0 <= rising - truth['lift_start'] < 0.02
    assert abs(time[height.argmax()] - truth['lift_end']) < 0.006


def test_plates_show_the_truth_with_their_noise(lift):
    _, truth, found = lift
    for k, side in enumerate(('right', 'left')):
        force, moment = wrenches(found, side)
        true_force = joined(truth, 'ground_force')[:, k]
        difference = force[::10] - true_force
        assert 0.9 < difference.std() < 1.1
        assert abs(difference.mean()) < 0.1
        cop = centre_of_pressure(force, moment)[::10]
        error = np.linalg.norm(cop[:, :2] - joined(truth, 'centre_of_pressure')[:, k, :2], axis=1)
        # Noise of 0.3 N m on a few hundred newtons.
        assert np.sqrt(np.mean(error**2)) < 5e-3


def test_markers_are_near_their_places_and_noisy(lift, skeleton):
    _, truth, found = lift
    markers = np.array([message.positions.reshape(-1, 3) for message in found['/markers']])
    segments = [skeleton.segments.index(s) for s in truth['marker_segments']]
    local = truth['marker_local']
    off = np.empty(markers.shape[:2])
    for i in range(0, len(markers), 20):
        frames = skeleton.forward(joined(truth, 'position')[i])[segments]
        true = np.einsum('mij,mj->mi', frames[:, :3, :3], local) + frames[:, :3, 3]
        off[i] = np.linalg.norm(markers[i] - true, axis=1)
    off = off[::20]
    # Standing: noise only, 0.5 mm in three axes. Bent: soft tissue by several millimetres more.
    assert np.sqrt(np.mean(off[:5] ** 2)) < 2.5e-3
    assert 8e-3 < off.max() < 30e-3
    # Noise: what second differences of 10 ms leave in the resting first second.
    rest = np.diff(markers[:100], n=2, axis=0)
    assert np.sqrt(np.mean(rest**2) / 6.0) == pytest.approx(0.5e-3, rel=0.1)


def test_stamps_are_regular(lift):
    _, truth, found = lift
    stamps = np.array(
        [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in found['/markers']]
    )
    assert stamps[0] == truth['start_time_ns']
    assert np.all(np.diff(stamps) == 10_000_000)
    assert len(found['/force_plates/left/wrench']) == 10 * (len(stamps) - 1) + 1


def test_generator_writes_the_same_again(tmp_path):
    """The generator is deterministic; last digits may differ between machines."""
    paths = [str(path) for path in (ROOT / 'ros_ws' / 'src').iterdir() if path.is_dir()]
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(paths), 'OMP_NUM_THREADS': '1'}
    subprocess.run(
        [sys.executable, '-m', 'bags.simulate', '--output', str(tmp_path), 'static_trial'],
        cwd=ROOT,
        env=environment,
        check=True,
        timeout=120,
    )
    new = np.load(tmp_path / 'static_trial' / 'truth.npz')
    old = np.load(BAGS / 'static_trial' / 'truth.npz')
    np.testing.assert_allclose(new['position'], old['position'], atol=1e-6)
    np.testing.assert_allclose(new['marker_local'], old['marker_local'], atol=1e-9)
    rows = []
    for folder in (tmp_path, BAGS):
        with BagReader(folder / 'static_trial') as bag:
            message = next(m for _, _, m in bag.messages(['/markers']))
            rows.append(message.positions)
    np.testing.assert_allclose(rows[0], rows[1], atol=2e-5)


def test_recordings_belong_to_the_present_anthropometry(lift, skeleton):
    """When the body tables change, the recordings are to be made anew."""
    _, truth, _ = lift
    lengths = dict(zip(truth['length_names'].tolist(), truth['lengths'].tolist(), strict=True))
    assert lengths == pytest.approx(dict(skeleton.parameters.lengths), abs=1e-9)
    points = skeleton.points(joined(truth, 'position')[100])
    for k, name in enumerate(truth['point_names']):
        np.testing.assert_allclose(truth['points'][100, k], points[str(name)], atol=1e-5)
