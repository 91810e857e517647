# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Markers of a recording against those of its set: names, absences, a set of one's own."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.report import SolveStatus
from human_model.skeletons import Skeleton3D
from human_model.subject import Calibration, Subject
from lifting.recorded_markers import marker_set_of, renamed, with_places
from lifting_recordings.exceptions import SubjectFileError
from lifting_recordings.recording import Recording
from lifting_recordings.subject_file import read_subject_file
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.markers.marker_model import from_anthropometry, model_for
from motion_tracker.core.markers.marker_set import DATA, load_marker_set

PERSON = Subject('S', 'male', 70.0, 1.75, 30.0)
SUBJECT = """
subject: {pseudonym: S1, sex: male, mass: 70.0, stature: 1.75, age: 30}
task: {task_id: a, box_mass: 0.0, coupling: good, lifts_per_minute: 1.0, lifts_per_day: 10,
       duration_hours: 1.0}
"""
MEDIAL_AND_EXTRA = ('KNEM', 'ANKM', 'ELBM', 'HLX', 'MT5', 'HPI', 'ICR', 'THI2', 'TIB2')


@pytest.fixture(scope='module')
def marker_set():
    return load_marker_set('plug_in_gait_58')


def standing(marker_set, names=None) -> Recording:
    """Return three frames of standing with those of the markers of the set."""
    model = from_anthropometry(marker_set, PERSON)
    if names is not None:
        model = model.only(names)
    skeleton = Skeleton3D.of(PERSON)
    places = InverseKinematics(skeleton, model).predict(skeleton.standing())
    markers = np.tile(places, (3, 1, 1))
    return Recording(Path('a.trc'), model.names, np.arange(3) / 100.0, markers, {})


def tracked(recording, marker_set, places):
    """Return the solution of the last frame with the places of the bag."""
    subject = PERSON
    if places is not None:
        calibration = Calibration(places.marker_names, places.segments, places.offsets, {}, 0.0)
        subject = replace(PERSON, calibration=calibration)
    model, source = model_for(subject, marker_set)
    at = dict(zip(recording.names, recording.markers[-1], strict=True))
    solver = InverseKinematics(Skeleton3D.of(subject), model)
    return solver.solve([at.get(name, (np.nan,) * 3) for name in model.names]), source


def test_recording_with_all_markers_needs_no_places(marker_set):
    recording = standing(marker_set)
    same, places = with_places(recording, marker_set, PERSON, None)
    assert places is None
    assert same is recording


@pytest.mark.parametrize(
    'absent',
    [('HLX',), ('FIN', 'HPI'), MEDIAL_AND_EXTRA],
    ids=['no hallux', 'no hands', 'Plug-in Gait 39'],
)
def test_coordinates_that_nobody_marked_do_not_spoil_the_samples(marker_set, absent):
    names = [name for name in marker_set.names if name[1:] not in absent]
    recording = standing(marker_set, names)
    lost, _ = tracked(recording, marker_set, None)
    assert lost.status is SolveStatus.TRACKER_MARKERS_MISSING
    found, places = with_places(recording, marker_set, PERSON, None)
    solution, source = tracked(recording, marker_set, places)
    assert solution.ok, solution.message
    assert source == 'scaled by anthropometry'
    text = ' '.join(found.statements)
    assert 'Markers of plug_in_gait_58 not in the recording: ' in text
    assert 'drawn to neutral: ' in text
    assert np.isnan(places.rms)


def test_marker_that_is_never_seen_is_absent(marker_set):
    recording = standing(marker_set)
    markers = recording.markers.copy()
    markers[:, recording.names.index('LHLX')] = np.nan
    _, places = with_places(replace(recording, markers=markers), marker_set, PERSON, None)
    assert 'LHLX' not in places.marker_names
    assert 'RHLX' in places.marker_names


def test_markers_that_place_no_pelvis_are_refused(marker_set):
    few = standing(marker_set, ('LHEE', 'LTOE', *marker_set.names))
    recording = replace(few, names=few.names[:2], markers=few.markers[:, :2])
    with pytest.raises(SubjectFileError, match=r'a\.trc: .* cannot be tracked: .*rename'):
        with_places(recording, marker_set, PERSON, None)


def test_names_of_other_conventions_become_those_of_the_set(marker_set):
    recording = standing(marker_set)
    other = {
        'LASI': 'L_IAS', 'LKNE': 'L_FLE', 'LKNEM': 'L_FME', 'LSHO': 'L_SAE', 'LELB': 'L_HLE',
        'C7': 'CV7', 'LHEE': 'L_FCC', 'LTIB2': 'L_TTC',
    }  # fmt: skip
    named = replace(recording, names=tuple(other.get(name, name) for name in recording.names))
    found = renamed(named, marker_set)
    assert found.names == recording.names
    assert 'L_FLE as LKNE' in found.statements[-1]


def test_augmented_markers_go_before_key_points():
    marker_set = load_marker_set('opencap_lab_51')
    names = ('RShoulder', 'RHeel', 'r_shoulder_study', 'r_calc_study', 'r_lelbow_study',
             'r_mwrist_study', 'r.ASIS_study', 'C7_study')  # fmt: skip
    recording = Recording(Path('a.trc'), names, np.zeros(1), np.zeros((1, len(names), 3)), {})
    found = renamed(recording, marker_set).names
    assert found[:4] == ('RShoulder', 'RHeel', 'R_Shoulder', 'r_calc')
    assert found[4:] == ('R_elbow_lat', 'R_wrist_ulna', 'r.ASIS', 'C7')


def subject_file(folder: Path, marker_set: str):
    path = folder / 'subject.yaml'
    path.write_text(f'{SUBJECT}recording: {{marker_set: {marker_set}}}\n')
    return read_subject_file(path)


def test_own_set_lies_beside_the_subject_file_and_travels_in_the_bag(tmp_path, marker_set):
    table = (DATA / 'marker_sets' / 'plug_in_gait_58.csv').read_text()
    (tmp_path / 'mine.csv').write_text(table)
    own = marker_set_of(subject_file(tmp_path, 'mine.csv'))
    recording = standing(marker_set)
    found, places = with_places(recording, own, PERSON, None)
    assert places.marker_set == ''
    solution, _ = tracked(recording, None, places)
    assert solution.ok, solution.message
    assert any('Weights of the marker set mine' in text for text in found.statements)


def test_damaged_and_missing_sets_are_refused_with_field_and_file(tmp_path):
    with pytest.raises(SubjectFileError, match=r'marker_set: .*pig_35.*plug_in_gait_39'):
        marker_set_of(subject_file(tmp_path, 'pig_35'))
    with pytest.raises(SubjectFileError, match=r'recording\.marker_set: .*mine\.csv.*cannot be'):
        marker_set_of(subject_file(tmp_path, 'mine.csv'))
    table = (DATA / 'marker_sets' / 'plug_in_gait_39.csv').read_text()
    (tmp_path / 'mine.csv').write_text(table.replace('LFHD,head', 'LFHD,skull'))
    with pytest.raises(SubjectFileError, match=r"LFHD: segment 'skull' is not one of pelvis"):
        marker_set_of(subject_file(tmp_path, 'mine.csv'))


def test_joint_widths_are_read_and_checked(tmp_path):
    path = tmp_path / 'subject.yaml'
    text = SUBJECT.replace('age: 30}', 'age: 30, joint_widths: {knee: 0.1, elbow: 0.07}}')
    path.write_text(text)
    assert read_subject_file(path).joint_widths == {'knee': 0.1, 'elbow': 0.07}
    path.write_text(text.replace('0.1,', '10.0,'))
    with pytest.raises(SubjectFileError, match=r'subject\.joint_widths\.knee: 10 m is outside'):
        read_subject_file(path)
    path.write_text(text.replace('knee', 'hip'))
    with pytest.raises(SubjectFileError, match=r'subject\.joint_widths\.hip: is not a known'):
        read_subject_file(path)
