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
    hidden[:, names.index('RANKM')] = np.nan
    with pytest.raises(CalibrationError, match="'RANKM'"):
        calibrate(marker_set, names, hidden, person)
    with pytest.raises(CalibrationError, match=r'\(frames, 57, 3\)'):
        calibrate(marker_set, names[:-1], positions, person)
