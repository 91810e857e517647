# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The journal outlives the process, a crash while writing, and never rewrites a line."""

import pytest

from injury_monitor.core.alarm import AlarmState
from injury_monitor.core.exceptions import JournalError
from injury_monitor.core.journal import AlarmJournal
from injury_monitor.core.lifting_equation import Coupling
from injury_monitor.core.monitor import InjuryMonitor
from injury_monitor.core.work import Work


def heavy(target):
    target.configure(Work('bag_1', 'P01', 70.0, 12.0, 50.0, 1.0, 1.0, Coupling.FAIR))
    events = []
    for k in range(50):
        events += target.update_spine_load(k / 100.0, 7000.0, 0.0, True)
    return events


def test_journal_keeps_alarms_from_being_announced_twice(tmp_path):
    journal = AlarmJournal(tmp_path / 'new_folder' / 'alarms.jsonl')
    events = heavy(InjuryMonitor())
    journal.append(events)
    journal.append([])
    again = AlarmJournal(journal.path)
    assert again.known() == {event.occurrence for event in events}
    assert len(events) == 2 and heavy(InjuryMonitor(known=again.known())) == []
    record = again.records[0]
    assert record['state'] == AlarmState.UNACKNOWLEDGED_ACTIVE.name
    assert record['stamp_returned'] is None and 'P01' not in journal.path.read_text()


def test_a_line_cut_by_a_crash_is_named_and_kept(tmp_path):
    journal = AlarmJournal(tmp_path / 'alarms.jsonl')
    journal.append(heavy(InjuryMonitor()))
    text = journal.path.read_text()
    journal.path.write_text(text[:-30])
    cut = AlarmJournal(journal.path)
    assert cut.damaged_lines == [2] and len(cut.records) == 1
    cut.append(heavy(InjuryMonitor()))
    assert journal.path.read_text().startswith(text[:-30] + '\n')
    assert len(AlarmJournal(journal.path).records) == 3


def test_a_path_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(JournalError, match='file'):
        AlarmJournal(tmp_path / 'file' / 'alarms.jsonl')
    journal = AlarmJournal(tmp_path / 'alarms.jsonl')
    journal.path.mkdir()
    with pytest.raises(JournalError, match=r'alarms\.jsonl'):
        journal.append(heavy(InjuryMonitor()))
