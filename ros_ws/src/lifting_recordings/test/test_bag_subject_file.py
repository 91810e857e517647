# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The subject file: whole, and wrong in every way a person gets it wrong."""

import pytest
import yaml

from lifting_recordings.exceptions import SubjectFileError
from lifting_recordings.subject_file import read_subject_file

WHOLE = {
    'subject': {
        'pseudonym': 'S1',
        'sex': 'male',
        'mass': 63.5,
        'stature': 1.69,
        'age': 31,
        'segment_lengths': {'thigh': 0.41},
    },
    'task': {
        'task_id': 'symmetric_12kg',
        'box_mass': 12.0,
        'box_size': [0.238, 0.305, 0.127],
        'coupling': 'good',
        'lifts_per_minute': 1,
        'lifts_per_day': 100,
        'duration_hours': 1,
    },
    'recording': {'marker_set': 'plug_in_gait_58', 'rename': {'A': 'B'}},
}


def written(tmp_path, **changes):
    data = {section: dict(entries) for section, entries in WHOLE.items()}
    for key, value in changes.items():
        section, field = key.split('__')
        if value is None:
            del data[section][field]
        else:
            data[section][field] = value
    path = tmp_path / 'subject.yaml'
    path.write_text(yaml.safe_dump(data))
    return path


def test_whole_file(tmp_path):
    entry = read_subject_file(written(tmp_path))
    assert entry.subject.sex == 'male'
    assert entry.subject.lengths == {'thigh': 0.41}
    assert entry.task.box.size == (0.238, 0.305, 0.127)
    assert entry.recording.marker_set == 'plug_in_gait_58'
    assert entry.task.simulated is False


@pytest.mark.parametrize(
    ('change', 'message'),
    [
        ({'subject__mass': 62600}, r'subject\.mass: 62600 kg is outside'),
        ({'subject__stature': 168}, r'subject\.stature: 168 m is outside'),
        ({'subject__mass': 'heavy'}, r"subject\.mass: a number is needed, found 'heavy'"),
        ({'subject__mass': float('nan')}, r'subject\.mass: a finite number is needed, found nan'),
        ({'subject__age': None}, r'subject\.age: is missing'),
        ({'subject__sex': 'm'}, r"subject\.sex: 'm' is not one of male, female"),
        ({'subject__name': 'Jane'}, r'subject\.name: is not a known field'),
        ({'subject__pseudonym': ' '}, r'subject\.pseudonym: is empty'),
        ({'subject__segment_lengths': {'thigh': 410}}, r'segment_lengths\.thigh: 410'),
        ({'task__box_size': None}, r'task\.box_size: is missing'),
        ({'task__box_size': [1.0, 2.0]}, r'task\.box_size: 3 numbers are needed'),
        ({'task__box_size': [0.0, 0.3, 0.1]}, r'task\.box_size: .* is not positive'),
        ({'task__box_mass': -1.0}, r'task\.box_mass: -1 is negative'),
        ({'task__coupling': 'bad'}, r"task\.coupling: 'bad' is not one of"),
        ({'task__simulated': 'yes please'}, r'task\.simulated: true or false is needed'),
        ({'recording__box_markers': {'a': [0, 0, 0]}}, r'box_markers: 1 markers'),
    ],
)
def test_errors_name_file_field_and_value(tmp_path, change, message):
    with pytest.raises(SubjectFileError, match=r'subject\.yaml: .*' + message):
        read_subject_file(written(tmp_path, **change))


def test_no_yaml_and_no_file(tmp_path):
    path = tmp_path / 'subject.yaml'
    with pytest.raises(SubjectFileError, match='cannot be read'):
        read_subject_file(path)
    path.write_text('a: [unclosed')
    with pytest.raises(SubjectFileError, match='cannot be read'):
        read_subject_file(path)
    path.write_text('just words')
    with pytest.raises(SubjectFileError, match="file: a mapping is needed, found 'just words'"):
        read_subject_file(path)


BOX = """
subject: {pseudonym: S1, sex: male, mass: 70.0, stature: 1.75, age: 30}
task: {task_id: a, box_mass: 12.0, box_size: [0.3, 0.4, 0.2], coupling: good,
       lifts_per_minute: 1.0, lifts_per_day: 10, duration_hours: 1.0}
recording:
  box_markers: {B1: [0.15, 0.2, 0.1], B2: [-0.15, 0.2, 0.1], B3: [0.15, -0.2, 0.1]}
"""


@pytest.mark.parametrize(
    ('old', 'new', 'words'),
    [
        ('[0.3, 0.4, 0.2]', '[30, 40, 20]', r'task\.box_size.*each side is between 0\.01 and 2 m'),
        ('B1: [0.15, 0.2, 0.1]', 'B1: [15, 20, 10]', r'box_markers\.B1: .*write metres'),
        ('B3: [0.15, -0.2', 'B3: [0.15, -0.4', r'box_markers\.B3: .*outside of the box'),
    ],
)
def test_box_in_other_units_is_refused(tmp_path, old, new, words):
    path = tmp_path / 'subject.yaml'
    path.write_text(BOX)
    assert len(read_subject_file(path).recording.box_markers) == 3
    path.write_text(BOX.replace(old, new))
    with pytest.raises(SubjectFileError, match=words):
        read_subject_file(path)
