# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Append-only journal of alarm events in an SQLite file, from which the alarms are restored.

Each event is synced to the disk before `append` returns.  Triggers refuse changes and deletions,
and each row holds the SHA-256 of the row before and of its own text: a change made from outside
is found by `verify`.  One process writes; any number may read meanwhile (write-ahead log).

SQLite comes with apsw: versions 3.7.0 to 3.51.2 can lose commits of a write-ahead log when a
reader and the writer meet (https://sqlite.org/wal.html#walresetbug), and Python's own module uses
the library of the system.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import math
import os
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from enum import Enum
from pathlib import Path
from typing import Any, Final

import apsw

from injury_monitor.core.alarm import AlarmState, Trigger
from injury_monitor.core.alarm_event import AlarmEvent
from injury_monitor.core.exceptions import JournalError, JournalInUseError

#: Marks the file as a journal of alarms (SQLite's application_id) and names its layout.
APPLICATION: Final = 0x4C494654
LAYOUT: Final = 1
#: Hash before the first row.
GENESIS: Final = bytes(32)

_SCHEMA: Final = """
CREATE TABLE event (
  number INTEGER PRIMARY KEY,
  record TEXT NOT NULL,
  hash BLOB NOT NULL,
  alarm TEXT GENERATED ALWAYS AS (json_extract(record, '$.alarm')) VIRTUAL,
  occurrence TEXT GENERATED ALWAYS AS (json_extract(record, '$.occurrence')) VIRTUAL
);
CREATE TRIGGER no_update BEFORE UPDATE ON event
BEGIN SELECT RAISE(ABORT, 'the journal is append-only'); END;
CREATE TRIGGER no_delete BEFORE DELETE ON event
BEGIN SELECT RAISE(ABORT, 'the journal is append-only'); END;
"""
_TYPES: Final = {'trigger': Trigger, 'previous_state': AlarmState, 'state': AlarmState}
_NUMBERS: Final = {field.name for field in fields(AlarmEvent) if field.type == 'float'}


@dataclass(frozen=True)
class Row:
    """One event of a journal.

    Attributes
    ----------
    number : int
        Its place, from 1.
    record : str
        The event as JSON.
    hash : bytes
        SHA-256 of the hash before and of the record.
    """

    number: int
    record: str
    hash: bytes

    @property
    def event(self) -> AlarmEvent:
        """Return the event."""
        return _event(self.record)

    def follows(self, before: bytes) -> bool:
        """Return whether the hash belongs to the record and the hash before."""
        return self.hash == _hash(before, self.record)


@dataclass(frozen=True)
class Verification:
    """Result of `AlarmJournal.verify`.

    Attributes
    ----------
    rows : int
        Events found.
    head : bytes
        Hash of the last one: a copy of it kept elsewhere shows later that nothing was changed.
    problems : tuple of str
        Empty if the journal is whole.
    """

    rows: int
    head: bytes
    problems: tuple[str, ...]


class AlarmJournal:
    """Journal in one file.

    Parameters
    ----------
    path : path
        Made with its folder if it is not there.
    readonly : bool
        Only read, also while another process writes.

    Attributes
    ----------
    damage : str
        Damage that was found on opening, and the file into which the damaged one was moved; ''
        without damage.

    Raises
    ------
    JournalInUseError
        If another process writes to the journal.
    JournalError
        If the file is no journal or cannot be read or written.
    """

    def __init__(self, path: str | Path, *, readonly: bool = False) -> None:
        self.path = Path(path)
        self.damage = ''
        self._lock: int | None = None
        self._waiting: list[AlarmEvent] = []
        try:
            if not readonly:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                self._lock_file()
            self._database = self._open(readonly)
            self._head = self._last_hash()
        except (OSError, apsw.Error) as error:
            self._unlock()
            raise JournalError(self.path, str(error)) from error
        except JournalError:
            self._unlock()
            raise

    def __enter__(self) -> AlarmJournal:
        """Return the open journal."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    @property
    def head(self) -> bytes:
        """Hash of the last event."""
        return self._head

    @property
    def unwritten(self) -> int:
        """Number of events that could not be written yet."""
        return len(self._waiting)

    def append(self, events: Iterable[AlarmEvent]) -> None:
        """Write events and sync them to the disk; those that could not be written before first.

        Raises
        ------
        JournalError
            If the disk is full, read-only or gone; the events are kept for the next call.
        """
        self._waiting += events
        if not self._waiting:
            return
        head, rows = self._head, []
        for event in self._waiting:
            record = _record(event)
            head = _hash(head, record)
            rows.append((record, head))
        database = self._database
        try:
            database.execute('BEGIN IMMEDIATE')
            database.executemany('INSERT INTO event (record, hash) VALUES (?, ?)', rows)
            database.execute('COMMIT')
        except apsw.Error as error:
            # A full disk has ended the transaction already.
            if database.in_transaction:
                database.execute('ROLLBACK')
            raise JournalError(self.path, str(error)) from error
        self._head = head
        self._waiting.clear()

    def events(self) -> Iterator[AlarmEvent]:
        """Yield all events in their order."""
        return (row.event for row in self.rows())

    def rows(self, first: int = 1) -> Iterator[Row]:
        """Yield the rows from a number on, in short transactions that hold no writer up."""
        while True:
            block: list[Any] = self._database.execute(
                'SELECT number, record, hash FROM event WHERE number >= ? ORDER BY number LIMIT ?',
                (first, 500),
            ).fetchall()
            yield from (Row(*row) for row in block)
            if not block:
                return
            first = block[-1][0] + 1

    def verify(self) -> Verification:
        """Check the file, the numbers and the chain of hashes."""
        problems = [
            text for (text,) in self._database.execute('PRAGMA integrity_check') if text != 'ok'
        ]
        head, rows = GENESIS, 0
        try:
            for row in self.rows():
                rows += 1
                if row.number != rows:
                    problems.append(f'event {row.number} stands at place {rows}: one was removed')
                    rows = row.number
                if not row.follows(head):
                    problems.append(f'event {row.number} does not follow the one before')
                head = row.hash
        except apsw.Error as error:
            problems.append(f'after event {rows}: {error}')
        return Verification(rows, head, tuple(problems))

    def close(self) -> None:
        """Close the file and let another process write."""
        self._database.close()
        self._unlock()

    def _lock_file(self) -> None:
        path = self.path.with_name(f'{self.path.name}.lock')
        self._lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise JournalInUseError(self.path) from error

    def _unlock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _open(self, readonly: bool) -> apsw.Connection:
        try:
            return self._connect(readonly)
        except (apsw.CorruptError, apsw.NotADBError) as error:
            if readonly:
                raise
            return self._recover(str(error))

    def _connect(self, readonly: bool) -> apsw.Connection:
        flags = apsw.SQLITE_OPEN_READONLY if readonly else (
            apsw.SQLITE_OPEN_READWRITE | apsw.SQLITE_OPEN_CREATE
        )  # fmt: skip
        database = apsw.Connection(str(self.path), flags=flags)
        database.set_busy_timeout(5000)
        application = database.pragma('application_id')
        empty = not database.execute('SELECT count(*) FROM sqlite_master').get
        if readonly or not empty:
            if application != APPLICATION:
                raise JournalError(self.path, 'is no journal of alarms')
            if database.pragma('user_version') > LAYOUT:
                raise JournalError(self.path, 'was written by a later version')
        if readonly:
            return database
        database.pragma('journal_mode', 'wal')
        database.pragma('synchronous', 'full')
        if empty:
            with database:
                database.execute(_SCHEMA)
                database.pragma('application_id', APPLICATION)
                database.pragma('user_version', LAYOUT)
        problem = database.execute('PRAGMA quick_check(1)').get
        if problem != 'ok':
            database.close()
            raise apsw.CorruptError(problem)
        return database

    def _recover(self, problem: str) -> apsw.Connection:
        """Move the damaged file aside and copy the events that can be read into a new one."""
        rows = _readable_rows(self.path)
        number = 1
        while (aside := self.path.with_name(f'{self.path.name}.damaged_{number}')).exists():
            number += 1
        self.path.replace(aside)
        for suffix in ('-wal', '-shm'):
            self.path.with_name(self.path.name + suffix).unlink(missing_ok=True)
        database = self._connect(False)
        with database:
            # With their hashes: the chain shows where events are missing.
            database.executemany('INSERT INTO event VALUES (?, ?, ?)', rows)
        self.damage = f'{self.path}: {problem}; {len(rows)} events recovered, the rest in {aside}'
        return database

    def _last_hash(self) -> bytes:
        last = self._database.execute('SELECT hash FROM event ORDER BY number DESC LIMIT 1').get
        return GENESIS if last is None else bytes(last)


def _readable_rows(path: Path) -> list[tuple[int, str, bytes]]:
    """Return the rows of a damaged file that can be read, forwards and backwards."""
    found: dict[int, tuple[int, str, bytes]] = {}
    for order in ('ASC', 'DESC'):
        try:
            with apsw.Connection(str(path), flags=apsw.SQLITE_OPEN_READWRITE) as database:
                for number, record, digest in database.execute(
                    f'SELECT number, record, hash FROM event ORDER BY number {order}'
                ):
                    _event(record)
                    found[number] = (number, record, digest)
        except (apsw.Error, JournalError):
            continue
    return [found[number] for number in sorted(found)]


def _hash(before: bytes, record: str) -> bytes:
    return hashlib.sha256(before + record.encode()).digest()


def _record(event: AlarmEvent) -> str:
    """Return an event as JSON; a number that is not finite is null."""
    values = asdict(event)
    for key, value in values.items():
        if isinstance(value, Enum):
            values[key] = value.name
        elif isinstance(value, float) and not math.isfinite(value):
            values[key] = None
    return json.dumps(values, ensure_ascii=False)


def _event(record: str) -> AlarmEvent:
    try:
        values: dict[str, Any] = json.loads(record)
        for key, kind in _TYPES.items():
            values[key] = kind[values[key]]
        for key in _NUMBERS:
            values[key] = math.nan if values[key] is None else float(values[key])
        return AlarmEvent(**values)
    except (ValueError, TypeError, KeyError) as error:
        raise JournalError('event', f'{record[:80]!r} is no alarm event: {error!r}') from error
