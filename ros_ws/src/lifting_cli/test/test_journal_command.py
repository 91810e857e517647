# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift journal` verifies, shows and exports the journal of alarms."""

import apsw
import pyarrow.parquet
import pytest

from human_model.tables import read_file
from human_model.task import Coupling, Work
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.journal import AlarmJournal
from injury_monitor.core.monitor import InjuryMonitor
from lifting_cli.cli import main


@pytest.fixture
def path(tmp_path):
    monitor = InjuryMonitor(
        'cell_3',
        assignment=Assignment('bag', 'P01', 70.0, 12.0, Work(50.0, 1.0, 1.0, Coupling.FAIR)),
    )
    with AlarmJournal(tmp_path / 'alarms.db') as journal:
        for k in range(50):
            journal.append(monitor.update_spine_load(k / 100.0, 7000.0, 0.0, True))
    return tmp_path / 'alarms.db'


def test_whole_journal(path, capsys):
    assert main(['journal', 'verify', str(path)]) == 0
    said = capsys.readouterr().out
    assert said.startswith('2 events, 0 problems, head ')
    head = said.split()[-1]
    assert main(['journal', 'verify', '--head', head, str(path)]) == 0
    assert main(['journal', 'verify', '--head', '00', str(path)]) == 1


def test_changed_journal(path, capsys):
    with apsw.Connection(str(path)) as database:
        database.execute('DROP TRIGGER no_update; UPDATE event SET record = record || " "')
    assert main(['journal', 'verify', str(path)]) == 1
    assert 'event 1 does not follow the one before' in capsys.readouterr().out


def test_show(path, capsys):
    assert main(['journal', 'show', '--last', '1', str(path)]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert 'cell_3 l5_s1_compression_high: NORMAL to UNACKNOWLEDGED_ACTIVE' in line


def test_export(path, tmp_path, capsys):
    assert main(['journal', 'export', str(path), str(tmp_path / 'a.csv')]) == 0
    rows = read_file(tmp_path / 'a.csv', 'number alarm value')
    assert [row['number'] for row in rows] == ['1', '2']
    assert rows[0].number('value') == 7000.0
    assert main(['journal', 'export', str(path), str(tmp_path / 'a.parquet')]) == 0
    table = pyarrow.parquet.read_table(tmp_path / 'a.parquet')
    assert table.column('alarm').to_pylist() == [row['alarm'] for row in rows]
    assert main(['journal', 'export', str(path), str(tmp_path / 'a.txt')]) == 1
    assert "'.txt' is neither .csv nor .parquet" in capsys.readouterr().err


def test_missing_journal_is_named(tmp_path, capsys):
    assert main(['journal', 'verify', str(tmp_path / 'none.db')]) == 1
    assert 'none.db: does not exist' in capsys.readouterr().err
