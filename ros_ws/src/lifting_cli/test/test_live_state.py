# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the live view says of messages."""

import math

import pytest
from lifting_interfaces.msg import AlarmEvent, LiftEvent, PredictedLift, RiskAssessment, SpineLoad

from lifting_cli.live.state import Kind, LiveState
from lifting_messages.stamps import to_stamp

START = 1_000.0


@pytest.fixture
def state():
    """Return the state at the beginning of a recording."""
    return LiveState(START)


def at(message, seconds):
    """Stamp a message at a time of the recording."""
    message.header.stamp = to_stamp(START + seconds)
    return message


def spine_load(source, compression, shear, status, seconds=2.0):
    """Return a block of spine load."""
    return at(
        SpineLoad(
            lift_id='lift_001',
            source=source,
            body_mass=63.5,
            compression=compression,
            anterior_shear=shear,
            status=status,
        ),
        seconds,
    )


def test_a_live_sample_moves_the_gauges_and_says_nothing(state):
    """A hundred lines a second would hide the alarms."""
    assert state.update(spine_load(SpineLoad.LIVE, [1500.0], [300.0], [0])) == []
    assert (state.compression, state.shear, state.now) == (1500.0, 300.0, 2.0)


def test_a_live_sample_that_did_not_solve_does_not_move_the_gauges(state):
    """It never looks like a measurement."""
    state.update(spine_load(SpineLoad.LIVE, [9000.0], [300.0], [301]))
    assert math.isnan(state.compression)


def test_the_peak_of_a_lift_leaves_out_samples_that_did_not_solve(state):
    """The unsolved maximum is not the peak, and it is said that one was left out."""
    (line,) = state.update(
        spine_load(SpineLoad.MEASURED, [2000.0, 9000.0, 2540.0], [1.0, 2.0, 3.0], [0, 302, 0])
    )
    assert 'compression 2540 N (40.0 N/kg)' in line.text
    assert '1 of 3 samples not solved' in line.text
    assert line.kind is Kind.WARNING


def test_a_lift_is_open_until_it_is_assessed(state):
    """The run waits for the assessment of every lift that ended."""
    state.update(at(LiftEvent(lift_id='lift_001', event=LiftEvent.START), 1.0))
    assert state.complete
    state.update(at(LiftEvent(lift_id='lift_001', event=LiftEvent.END), 2.5))
    assert not state.complete
    (line,) = state.update(
        at(RiskAssessment(lift_id='lift_001', zone=RiskAssessment.ZONE_ACTION, summary='x'), 1.0)
    )
    assert state.complete
    assert line.kind is Kind.WARNING


def test_an_alarm_names_value_limit_and_margin(state):
    """All three, with the unit."""
    (line,) = state.update(
        at(
            AlarmEvent(
                alarm_id='compression_action',
                state=AlarmEvent.UNACKNOWLEDGED_ACTIVE,
                value=3612.0,
                limit=3400.0,
                margin=-212.0,
                unit='N',
            ),
            2.0,
        )
    )
    assert line.kind is Kind.ALARM
    assert '3612 N, limit 3400 N, margin -212 N' in line.text


def test_a_failed_prediction_does_not_look_like_a_result(state):
    """Its reason is shown instead."""
    message = PredictedLift(lift_id='lift_001')
    message.report.status, message.report.message = 203, 'hands do not reach the target'
    (line,) = state.update(at(message, 2.0))
    assert line.kind is Kind.WARNING
    assert 'hands do not reach' in line.text
