# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node with a journal: restarts, a second monitor, a full disk."""

import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifecycle_msgs.msg import Transition  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    AlarmEvent,
)
from lifting_interfaces.srv import AcknowledgeAlarm, ResetAlarm  # noqa: E402

from human_model.task import Coupling, Work  # noqa: E402
from injury_monitor.core.assignment import Assignment  # noqa: E402
from injury_monitor.core.journal import AlarmJournal  # noqa: E402
from injury_monitor.core.monitor import InjuryMonitor  # noqa: E402

HIGH, HIGH_HIGH = 'l5_s1_compression_high', 'l5_s1_compression_high_high'


def filler():
    """Return events that fill more than a page of a journal."""
    monitor = InjuryMonitor(
        assignment=Assignment('filler', 'P01', 70.0, 12.0, Work(50.0, 1.0, 1.0, Coupling.FAIR))
    )
    events = []
    for k in range(50):
        events += monitor.update_spine_load(k / 100.0, 7000.0, 0.0, True)
    return events * 20


FILLER = filler()


def test_a_known_alarm_is_not_announced_by_the_next_process(tmp_path, new_station):
    for run, announced in (('first', 2), ('second', 0)):
        station = new_station('test_journal', {'journal': tmp_path / 'alarms.db'})
        try:
            station.bring_up()
            station.live(100.0, [7000.0] * 50)
            station.until(
                lambda s=station: s.node.station.monitor.counts['spine_load'].used == 50, run
            )
            station.until(lambda s=station, n=announced: len(s.alarms) >= n, f'{run} alarms')
            assert len(station.alarms) == announced
        finally:
            station.close()


def test_states_of_the_process_before_go_on(tmp_path, new_station):
    """A latched alarm is published after a restart and can be acknowledged and reset."""
    path = tmp_path / 'alarms.db'
    station = new_station('test_states', {'journal': path})
    try:
        station.bring_up()
        station.live(100.0, [600.0] * 10 + [7000.0] * 50 + [600.0] * 100)
        station.until(lambda: len(station.alarms) == 4, 'two alarms raised and returned')
    finally:
        station.close()
    station = new_station('test_states', {'journal': path})
    try:
        station.bring_up()
        station.until(lambda: station.states and station.states[-1].alarms, 'states')
        found = {alarm.alarm_id: alarm.state for alarm in station.states[-1].alarms}
        assert found == {
            HIGH: AlarmEvent.UNACKNOWLEDGED_RETURNED,
            HIGH_HIGH: AlarmEvent.LATCHED_UNACKNOWLEDGED,
        }
        assert station.alarms == []
        request = {'alarm_id': HIGH_HIGH, 'operator_id': 'panel 1'}
        for kind, name in ((AcknowledgeAlarm, 'acknowledge_alarm'), (ResetAlarm, 'reset_alarm')):
            assert station.call(kind, name, kind.Request(**request)).error_code == 0
        station.until(lambda: station.states[-1].alarms[1].state == AlarmEvent.NORMAL, 'reset')
    finally:
        station.close()


def test_second_monitor_on_one_journal_is_not_configured(station, tmp_path):
    path = tmp_path / 'alarms.db'
    with AlarmJournal(path):
        station.node.values['journal'] = str(path)
        assert not station.transition(Transition.TRANSITION_CONFIGURE)
    assert station.transition(Transition.TRANSITION_CONFIGURE)


def test_alarms_go_out_while_the_journal_cannot_be_written(station, tmp_path):
    station.node.values['journal'] = str(tmp_path / 'alarms.db')
    station.bring_up()
    database = station.node.station._journal._database
    database.pragma('max_page_count', database.pragma('page_count'))
    station.node.station._journal._waiting += FILLER
    station.live(100.0, [7000.0] * 50)
    station.until(lambda: len(station.alarms) == 2, 'alarms without a journal')
    assert [alarm.unjournaled for alarm in station.alarms] == [True, True]
    assert 'full' in station.node.station.last_error
    request = AcknowledgeAlarm.Request(alarm_id=HIGH, operator_id='panel 1')
    assert station.call(AcknowledgeAlarm, 'acknowledge_alarm', request).error_code == 0
    station.until(lambda: station.states[-1].unjournaled == len(FILLER) + 3, 'count of events')
    database.pragma('max_page_count', 100_000)
    request = AcknowledgeAlarm.Request(alarm_id=HIGH_HIGH, operator_id='panel 1')
    assert station.call(AcknowledgeAlarm, 'acknowledge_alarm', request).error_code == 0
    station.until(lambda: station.states[-1].unjournaled == 0, 'events written later')
    assert station.node.station._journal.verify().rows == len(FILLER) + 4


def test_operator_commands_need_an_operator_and_an_active_monitor(station):
    station.bring_up()
    station.live(100.0, [7000.0] * 50)
    station.until(lambda: len(station.alarms) == 2, 'alarms')
    call = AcknowledgeAlarm, 'acknowledge_alarm'
    answer = station.call(*call, AcknowledgeAlarm.Request(alarm_id=HIGH, operator_id=' '))
    assert answer.error_code == AcknowledgeAlarm.Response.OPERATOR_MISSING
    assert station.transition(Transition.TRANSITION_DEACTIVATE)
    answer = station.call(*call, AcknowledgeAlarm.Request(alarm_id=HIGH, operator_id='panel'))
    assert answer.error_code == AcknowledgeAlarm.Response.NOT_ACTIVE
    assert station.node.station.monitor.states()[HIGH].name == 'UNACKNOWLEDGED_ACTIVE'
