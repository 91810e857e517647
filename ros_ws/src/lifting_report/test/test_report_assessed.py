# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assessment messages as parts of the report, from the injury monitor's own conversion."""

import math

import numpy as np
import pytest
from lifting_interfaces.msg import BodyMotion, MeasuredLift, RiskAssessment, Subject, Task

from injury_monitor import conversions
from injury_monitor.core.loads import LiftLoads, TorqueSeries
from injury_monitor.core.monitor import InjuryMonitor
from lifting_report.assessed import lifting_from_assessment, risk_from_assessment
from lifting_report.report_data import Missing

SUBJECT = Subject(pseudonym='P01', mass=70.0)
TASK = Task(
    task_id='t',
    box_mass=12.0,
    coupling=Task.COUPLING_FAIR,
    lifts_per_day=50.0,
    lifts_per_minute=1.0,
    duration_hours=1.0,
)


def measured_lift():
    points = np.array(
        [
            [[0.4, -0.1, h], [0.4, 0.1, h], [0.0, -0.1, 0.1], [0.0, 0.1, 0.1]]
            for h in (0.3, 0.6, 0.9)
        ]
    )
    motion = BodyMotion(
        time_from_start=[0.0, 0.5, 1.0],
        points=points.ravel().tolist(),
        point_names='hand_r\nhand_l\nankle_r\nankle_l',
    )
    return MeasuredLift(lift_id='lift_001', duration=1.0, motion=motion)


@pytest.fixture
def message():
    monitor = InjuryMonitor()
    monitor.configure(conversions.assignment_from_msg(SUBJECT, TASK))
    time = np.arange(11) / 10.0
    good = np.ones(11, bool)
    torques = TorqueSeries(
        time,
        ('hip', 'knee'),
        np.full((11, 2), (20.0, 30.0)),
        np.full((11, 2), -100.0),
        np.full((11, 2), 100.0),
        good,
    )
    measured = LiftLoads(
        'lift_001', 0.0, time, np.full(11, 3600.0), np.full(11, 500.0), good, torques
    )
    result = monitor.assess(measured, None, conversions.ends_from_msg(measured_lift()), 'none')
    return conversions.assessment_to_msg(result, 0.0)


def test_criteria_keep_their_numbers_and_get_joint_names(message):
    risk = risk_from_assessment(message)
    assert risk.zone == 'action' and math.isnan(risk.avoidable_compression)
    assert risk.find('compression_action', 'measured').value == 3600.0
    assert risk.find('torque_index', 'measured').detail == 'knee'
    assert risk.find('shear_', 'measured').limit == 1000.0
    assert risk.find('torque_index', 'predicted') is None


def test_lifting_equation_gets_the_variables_behind_it(message):
    lifting = lifting_from_assessment(message, SUBJECT, TASK, measured_lift())
    assert lifting.lifting_index == message.lifting_index
    assert lifting.variables == {
        'end': 'origin',
        'H [cm]': '40',
        'V [cm]': '30',
        'D [cm]': '60',
        'A [deg]': '0',
        'F [1/min]': '1',
        'coupling': 'fair',
    }


def test_variables_of_another_index_are_not_shown(message):
    other = Task(
        task_id='t',
        box_mass=6.0,
        coupling=Task.COUPLING_FAIR,
        lifts_per_day=50.0,
        lifts_per_minute=1.0,
        duration_hours=1.0,
    )
    lifting = lifting_from_assessment(message, SUBJECT, other, measured_lift())
    assert lifting.variables == {'task variables': 'not those of this index'}
    bad = lifting_from_assessment(message, SUBJECT, Task(), measured_lift())
    assert 'coupling' in bad.variables['task variables']


def test_no_index_says_why():
    message = RiskAssessment(lifting_index=math.nan, lifting_index_note='nothing is lifted')
    assert lifting_from_assessment(message, SUBJECT, TASK, measured_lift()) == Missing(
        'nothing is lifted'
    )
