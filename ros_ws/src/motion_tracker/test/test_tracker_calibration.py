# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Static trial: lengths, posture and offsets of a person that is known exactly."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.anthropometry import segment_lengths
from human_model.skeletons import Skeleton3D
from motion_tracker.core.calibration import calibrate
from motion_tracker.core.exceptions import CalibrationError
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.markers.marker_model import model_for
from motion_tracker.core.markers.marker_set import load_marker_set

#: This person is not as the tables say.
OWN = {'thigh': 0.45, 'shank': 0.40, 'upper_arm': 0.30, 'forearm': 0.26}


@pytest.fixture(scope='module')
def own(person):
    return Skeleton3D.of(replace(person, lengths=OWN))


def trial(own, marker_set, spread=0.0, noise=0.0):
    """Names, positions (frames, n, 3) and true offsets of quiet standing with feet apart."""
    rng = np.random.default_rng(11)
    q = own.vector(
        {
            'hip_adduction_r': -0.08,
            'hip_adduction_l': -0.08,
            'subtalar_angle_r': 0.08,
            'subtalar_angle_l': 0.08,
            'pelvis_rotation': 0.1,
            'elbow_flex_r': 0.2,
        },
        own.standing(),
    )
    book = marker_set.positions(own.parameters.lengths)
    names = tuple(book)
    local = np.array([book[name] + rng.normal(0.0, spread, 3) for name in names])
    frames = own.forward(q)
    at = [own.segments.index(marker_set.marker(name).segment) for name in names]
    world = np.array(
        [frames[i, :3, :3] @ p + frames[i, :3, 3] for i, p in zip(at, local, strict=True)]
    )
    return (
        q,
        names,
        world + rng.normal(0.0, noise, (40, len(names), 3)),
        dict(zip(names, local, strict=True)),
    )


def test_lengths_are_those_of_the_person_and_not_of_the_table(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    found = calibrate(marker_set, names, positions, person).calibration.lengths
    for name in ('thigh', 'shank', 'forearm'):
        assert found[name] == pytest.approx(OWN[name], abs=5e-3), name
    # The shoulder centre hangs below its marker by a table's distance.
    assert found['upper_arm'] == pytest.approx(OWN['upper_arm'], abs=0.015)


def test_posture_of_the_trial_is_found(person, own, marker_set):
    q, names, positions, _ = trial(own, marker_set, noise=5e-4)
    found = calibrate(marker_set, names, positions, person)
    skeleton = Skeleton3D.of(person)
    error = np.degrees(np.abs(found.posture - q))
    for name in (
        'pelvis_tilt',
        'pelvis_rotation',
        'hip_flexion_r',
        'knee_angle_l',
        'ankle_angle_r',
        'elbow_flex_r',
        'subtalar_angle_l',
    ):
        assert error[skeleton.index(name)] < 2.0, name


def test_markers_away_from_the_book_are_followed(person, own, marker_set):
    """5 mm of placement error: after calibration the trial itself fits to the noise."""
    _, names, positions, _ = trial(own, marker_set, spread=5e-3, noise=5e-4)
    found = calibrate(marker_set, names, positions, person)
    assert 2e-3 < found.landmark_rms < 0.02
    assert found.calibration.residual_rms < 1.2e-3
    subject = replace(person, calibration=found.calibration)
    model, source = model_for(subject, marker_set)
    assert 'static trial' in source
    solver = InverseKinematics(Skeleton3D.of(subject), model)
    columns = [names.index(name) for name in model.names]
    assert solver.solve(positions[0][columns]).rms < 1.5e-3


def test_entered_lengths_go_before_measured_ones(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    entered = replace(person, lengths={'thigh': 0.43})
    found = calibrate(marker_set, names, positions, entered)
    subject = replace(entered, calibration=found.calibration)
    assert segment_lengths(subject)[0]['thigh'] == 0.43


def test_what_was_done_is_said(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    found = calibrate(marker_set, (*names[:-1], 'EXTRA'), positions, person)
    text = ' '.join(found.statements)
    assert 'EXTRA' in text
    assert names[-1] in text
    assert 'Harrington' in text
    assert names[-1] not in found.calibration.marker_names


def test_millimetres_motion_and_absent_landmarks_are_refused(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    with pytest.raises(CalibrationError, match='millimetres'):
        calibrate(marker_set, names, 1000.0 * positions, person)
    moving = positions + 0.1 * np.sin(np.arange(40) / 5.0)[:, None, None]
    with pytest.raises(CalibrationError, match='moves'):
        calibrate(marker_set, names, moving, person)
    hidden = positions.copy()
    hidden[:, names.index('RANK')] = np.nan
    with pytest.raises(CalibrationError, match=r"'RANK'.*rename: \{NAME: RANK\}"):
        calibrate(marker_set, names, hidden, person)
    with pytest.raises(CalibrationError, match=r'\(frames, 57, 3\)'):
        calibrate(marker_set, names[:-1], positions, person)


@pytest.mark.parametrize('set_name', ['plug_in_gait_58', 'plug_in_gait_39'])
def test_widths_stand_in_for_medial_markers(person, own, marker_set, set_name):
    """The centres move by less than 20 mm, as measured on a real trial (joint_widths)."""
    _, names, positions, _ = trial(own, marker_set, noise=5e-4)
    whole = calibrate(marker_set, names, positions, person)
    lateral = [i for i, name in enumerate(names) if name[1:] not in ('KNEM', 'ANKM', 'ELBM')]
    widths = {'knee': 0.0826, 'ankle': 0.0654}
    found = calibrate(
        load_marker_set(set_name),
        [names[i] for i in lateral],
        positions[:, lateral],
        person,
        widths,
    )
    for joint, centre in whole.joint_centres.items():
        moved = np.linalg.norm(found.joint_centres[joint] - centre)
        assert moved < 0.02, joint
    text = ' '.join(found.statements)
    assert 'knee_r: no marker RKNEM; centre 48 mm inward of RKNE (width in the subject' in text
    assert 'elbow_l: no marker LELBM' in text
    assert 'distance of the landmarks in plug_in_gait' in text
    wider = calibrate(
        load_marker_set(set_name),
        [names[i] for i in lateral],
        positions[:, lateral],
        person,
        {**widths, 'knee': 0.1226},
    )
    apart = wider.joint_centres['knee_r'] - found.joint_centres['knee_r']
    assert np.linalg.norm(apart) == pytest.approx(0.02, abs=1e-6)


def test_sacrum_stands_in_for_both_posterior_spines(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    whole = calibrate(marker_set, names, positions, person)
    columns = [names.index(name) for name in ('RPSI', 'LPSI')]
    sacrum = positions[:, columns].mean(axis=1, keepdims=True)
    keep = [i for i in range(len(names)) if i not in columns]
    found = calibrate(
        load_marker_set('plug_in_gait_39'),
        [*(names[i] for i in keep), 'SACR'],
        np.concatenate((positions[:, keep], sacrum), axis=1),
        person,
    )
    for joint in ('hip_r', 'hip_l'):
        np.testing.assert_allclose(
            found.joint_centres[joint], whole.joint_centres[joint], atol=2e-3
        )


def test_landmark_far_from_its_place_is_refused_by_name(person, own, marker_set):
    _, names, positions, _ = trial(own, marker_set)
    positions[:, names.index('RICR')] += (0.0, -0.25, 0.0)
    with pytest.raises(CalibrationError, match=r'RICR is \d+ mm from its anatomical place'):
        calibrate(marker_set, names, positions, person)
