# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The journal outlives the process, finds changes and damage, and loses no event."""

import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import apsw
import pytest

from human_model.task import Coupling, Work
from injury_monitor.core.alarm import AlarmState, Trigger
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import JournalError, JournalInUseError
from injury_monitor.core.journal import AlarmJournal
from injury_monitor.core.monitor import InjuryMonitor

HIGH = 'l5_s1_compression_high'
HIGH_HIGH = 'l5_s1_compression_high_high'
ASSIGNMENT = Assignment('bag_1', 'P01', 70.0, 12.0, Work(50.0, 1.0, 1.0, Coupling.FAIR))


class Clock:
    """A clock that is set by hand."""

    def __init__(self, now=1000.0):
        self.now = now

    def __call__(self):
        return self.now


def heavy(target, start=0.0, compression=7000.0, count=50):
    """Feed half a second of one load; return the events."""
    if target.assignment is None:
        target.configure(ASSIGNMENT)
    events = []
    for k in range(count):
        events += target.update_spine_load(start + k / 100.0, compression, 0.0, True)
    return events


@pytest.fixture
def path(tmp_path):
    return tmp_path / 'new_folder' / 'alarms.db'


def written(path, events):
    with AlarmJournal(path) as journal:
        journal.append(events)


def test_events_come_back(path):
    events = heavy(InjuryMonitor())
    written(path, events)
    with AlarmJournal(path) as journal:
        found = list(journal.events())
        assert journal.verify().problems == ()
    # NaN is not equal to itself: compared as text.
    assert [repr(event) for event in found] == [repr(event) for event in events]
    assert b'P01' not in path.read_bytes()


def test_alarms_of_the_same_data_are_not_announced_twice(path):
    events = heavy(InjuryMonitor())
    written(path, events)
    with AlarmJournal(path) as journal:
        assert len(events) == 2
        assert heavy(InjuryMonitor(history=journal.events())) == []


def test_alarm_of_other_data_with_the_same_stamps_is_announced():
    first = heavy(InjuryMonitor())
    cleared = InjuryMonitor()
    heavy(cleared)
    heavy(cleared, 1.0, 500.0, 200)
    cleared.command(Trigger.ACKNOWLEDGE, HIGH_HIGH, 'panel')
    cleared.command(Trigger.RESET, HIGH_HIGH, 'panel')
    again = heavy(cleared, 0.0, 7003.0)
    assert {event.alarm for event in again} == {HIGH, HIGH_HIGH}
    assert {e.occurrence for e in again}.isdisjoint({e.occurrence for e in first})


def test_states_go_on_after_a_restart(path):
    clock = Clock()
    monitor = InjuryMonitor(clock=clock)
    events = heavy(monitor)
    events += heavy(monitor, 1.0, 500.0, 200)
    events += monitor.command(Trigger.ACKNOWLEDGE, HIGH_HIGH, 'panel')
    events += monitor.command(Trigger.SHELVE, HIGH, 'panel', duration=600.0)
    written(path, events)
    with AlarmJournal(path) as journal:
        restarted = InjuryMonitor(history=journal.events(), clock=clock, assignment=ASSIGNMENT)
    assert restarted.states() == monitor.states()
    assert restarted.states()[HIGH_HIGH] is AlarmState.LATCHED_ACKNOWLEDGED
    assert restarted.states()[HIGH] is AlarmState.SHELVED
    clock.now += 599.0
    assert restarted.tick() == []
    clock.now += 1.0
    (event,) = restarted.tick()
    assert (event.alarm, event.trigger, event.state) == (HIGH, Trigger.UNSHELVE, AlarmState.NORMAL)
    (event,) = restarted.command(Trigger.RESET, HIGH_HIGH, 'panel')
    assert event.state is AlarmState.NORMAL


def test_alarm_that_was_active_returns_after_a_restart_and_is_not_raised_again(path):
    written(path, heavy(InjuryMonitor()))
    with AlarmJournal(path) as journal:
        restarted = InjuryMonitor(history=journal.events())
    assert heavy(restarted, 5.0, 7100.0) == []
    events = heavy(restarted, 6.0, 500.0, 200)
    assert {event.alarm: event.state for event in events} == {
        HIGH: AlarmState.UNACKNOWLEDGED_RETURNED,
        HIGH_HIGH: AlarmState.LATCHED_UNACKNOWLEDGED,
    }


def test_second_writer_is_refused_and_readers_are_not(path):
    with AlarmJournal(path) as journal:
        journal.append(heavy(InjuryMonitor()))
        with pytest.raises(JournalInUseError, match='another process'):
            AlarmJournal(path)
        with AlarmJournal(path, readonly=True) as reader:
            assert len(list(reader.events())) == 2
    AlarmJournal(path).close()


@pytest.mark.parametrize('statement', ['UPDATE event SET hash = 0', 'DELETE FROM event'])
def test_rows_cannot_be_changed(path, statement):
    written(path, heavy(InjuryMonitor()))
    database = apsw.Connection(str(path))
    with pytest.raises(apsw.ConstraintError, match='append-only'):
        database.execute(statement)
    database.close()


@pytest.mark.parametrize(
    ('change', 'says'),
    [
        ("UPDATE event SET record = replace(record, '7000', '3000') WHERE number = 1", 'event 1'),
        ('DELETE FROM event WHERE number = 2', 'event 3 stands at place 2'),
        ('UPDATE event SET hash = zeroblob(32) WHERE number = 2', 'event 2 does not follow'),
    ],
)
def test_changes_from_outside_are_found(path, change, says):
    monitor = InjuryMonitor()
    written(path, heavy(monitor) + heavy(monitor, 1.0, 500.0, 200))
    with apsw.Connection(str(path)) as database:
        database.execute('DROP TRIGGER no_update; DROP TRIGGER no_delete')
        database.execute(change)
    with AlarmJournal(path, readonly=True) as journal:
        problems = journal.verify().problems
    assert problems
    assert says in problems[0]


def test_damaged_page_is_found_and_the_rest_recovered(path):
    monitor = InjuryMonitor()
    events = []
    for k in range(200):
        events += heavy(monitor, 10.0 * k, 7000.0 + k)
        events += heavy(monitor, 10.0 * k + 1.0, 500.0, 200)
        events += monitor.command(Trigger.ACKNOWLEDGE, HIGH_HIGH, 'panel')
        events += monitor.command(Trigger.RESET, HIGH_HIGH, 'panel')
    written(path, events)
    content = bytearray(path.read_bytes())
    middle = len(content) // 2 // 4096 * 4096
    content[middle : middle + 4096] = b'\xff' * 4096
    path.write_bytes(content)
    with AlarmJournal(path) as journal:
        assert 'recovered' in journal.damage
        found = list(journal.events())
        assert any('does not follow' in p or 'stands at' in p for p in journal.verify().problems)
        journal.append(heavy(InjuryMonitor()))
    assert len(found) > 0.9 * len(events)
    assert {repr(event) for event in found} <= {repr(event) for event in events}
    assert path.with_name(f'{path.name}.damaged_1').exists()


@pytest.mark.parametrize('content', [b'no journal', b'SQLite format 3\0' + bytes(4000)])
def test_file_that_cannot_be_read_is_kept_aside(path, content):
    path.parent.mkdir()
    path.write_bytes(content)
    with AlarmJournal(path) as journal:
        assert '0 events recovered' in journal.damage
        journal.append(heavy(InjuryMonitor()))
    assert path.with_name(f'{path.name}.damaged_1').read_bytes() == content


def test_database_of_another_program_is_refused_and_left(path):
    path.parent.mkdir()
    with apsw.Connection(str(path)) as database:
        database.execute('CREATE TABLE orders (id)')
    with pytest.raises(JournalError, match='no journal of alarms'):
        AlarmJournal(path)
    with apsw.Connection(str(path)) as database:
        assert database.execute('SELECT name FROM sqlite_master').get == 'orders'


def test_path_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(JournalError, match='file') as caught:
        AlarmJournal(tmp_path / 'file' / 'alarms.db')
    assert caught.value.path == tmp_path / 'file' / 'alarms.db'


def test_full_disk_keeps_the_events_for_later(path):
    events = heavy(InjuryMonitor())
    with AlarmJournal(path) as journal:
        pages = journal._database.pragma('page_count')
        journal._database.pragma('max_page_count', pages)
        many = events * 500
        with pytest.raises(JournalError, match='full'):
            journal.append(many)
        assert journal.unwritten == len(many)
        journal._database.pragma('max_page_count', 100_000)
        journal.append(events)
        assert journal.unwritten == 0
        verified = journal.verify()
    assert (verified.rows, verified.problems) == (len(many) + 2, ())


def test_written_events_survive_kill(path):
    """A process that is killed right after `append` has lost nothing."""
    source = textwrap.dedent(f"""
        import os, signal, sys
        sys.path.insert(0, {str(Path(__file__).parent)!r})
        from test_injury_journal import AlarmJournal, InjuryMonitor, heavy
        journal = AlarmJournal({str(path)!r})
        for k in range(5):
            journal.append(heavy(InjuryMonitor(), 100.0 * k))
            print(k, flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
    """)
    done = subprocess.run(
        [sys.executable, '-c', source], check=False, capture_output=True, timeout=60
    )
    assert done.returncode == -signal.SIGKILL, done.stderr
    with AlarmJournal(path) as journal:
        assert journal.damage == ''
        assert (journal.verify().rows, journal.verify().problems) == (10, ())
