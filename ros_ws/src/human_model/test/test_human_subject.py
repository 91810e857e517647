# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects, calibrations and solve reports."""

import pickle

import numpy as np
import pytest

from human_model.exceptions import SubjectError
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Calibration, Subject

GOOD = {'pseudonym': 'S1', 'sex': 'female', 'mass': 60.0, 'stature': 1.65, 'age': 30.0}


def test_subject_there_and_back():
    calibration = Calibration(
        ('a', 'b'), ('pelvis', 'thorax'), np.arange(6.0).reshape(2, 3), {'thigh': 0.4}, 0.004
    )
    subject = Subject(**GOOD, strength_z=0.5, lengths={'shank': 0.41}, calibration=calibration)
    again = Subject.from_dict(subject.to_dict())
    assert again.to_dict() == subject.to_dict()
    assert again.calibration.local_offsets == pytest.approx(calibration.local_offsets)


@pytest.mark.parametrize(
    ('field', 'value', 'words'),
    [
        ('mass', 29.9, 'subject.mass: 29.9 kg.*30 to 250 kg'),
        ('mass', 62600.0, '62600 kg'),
        ('mass', float('nan'), 'subject.mass.*finite'),
        ('mass', '60', "subject.mass.*'60'"),
        ('mass', True, 'subject.mass.*True'),
        ('stature', 165.0, 'subject.stature: 165 m'),
        ('age', 5, 'subject.age: 5 years'),
        ('strength_z', 9.0, 'subject.strength_z'),
        ('sex', 'm', "subject.sex.*'m'"),
        ('pseudonym', ' ', 'subject.pseudonym'),
        ('lengths', {'thigh': 41.0}, r'subject.lengths\[thigh\]: 41 m'),
        ('lengths', 0.4, 'subject.lengths: lengths by name.*0.4'),
        ('calibration', 'mine', "subject.calibration.*'mine'"),
    ],
)
def test_bad_fields_are_named(field, value, words):
    with pytest.raises(SubjectError, match=words):
        Subject(**{**GOOD, field: value})


def test_missing_and_unknown_fields_are_named():
    with pytest.raises(SubjectError, match=r'subject\.age: missing'):
        Subject.from_dict({key: value for key, value in GOOD.items() if key != 'age'})
    with pytest.raises(SubjectError, match="unknown field 'weight'"):
        Subject.from_dict({**GOOD, 'weight': 60})


def test_calibration_refuses_what_does_not_belong_together():
    with pytest.raises(SubjectError, match='do not belong together'):
        Calibration(('a', 'b'), ('pelvis',), np.zeros((2, 3)))
    with pytest.raises(SubjectError, match=r'calibration\.segments: missing'):
        Calibration.from_dict({'marker_names': ['a']})
    with pytest.raises(SubjectError, match='twice'):
        Calibration(('a', 'a'), ('pelvis', 'pelvis'), np.zeros((2, 3)))
    with pytest.raises(SubjectError, match='not finite'):
        Calibration(('a',), ('pelvis',), np.full((1, 3), np.nan))
    with pytest.raises(SubjectError, match='negative'):
        Calibration(('a',), ('pelvis',), np.zeros((1, 3)), residual_rms=-1.0)


def test_report_says_whether_the_data_are_good():
    assert SolveReport().ok
    report = SolveReport(SolveStatus.PREDICTOR_INFEASIBLE, 'hands cannot reach', 12, 3.0)
    assert not report.ok
    assert SolveReport.from_dict(report.to_dict()) == report
    with pytest.raises(ValueError, match='999'):
        SolveReport(999)


def test_error_carries_the_value_and_survives_a_process():
    with pytest.raises(SubjectError) as caught:
        Subject('S1', 'male', 900.0, 1.75, 30.0)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (copy.field, copy.value) == ('subject.mass', 900.0)
    assert str(copy) == str(caught.value)
