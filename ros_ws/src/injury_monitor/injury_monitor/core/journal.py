# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Append-only journal of alarm events, one JSON object a line.

It outlives the process: the occurrences in it are known to the next one, which therefore does not
announce them again when the same data are played again.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import asdict
from enum import Enum
from pathlib import Path
from typing import Any

from injury_monitor.core.alarm_event import AlarmEvent
from injury_monitor.core.exceptions import JournalError


class AlarmJournal:
    """Journal in one file.

    Parameters
    ----------
    path : path
        Created with its folder if it is not there.

    Raises
    ------
    JournalError
        If the file cannot be read or written. A line that cannot be read, as a crash while
        writing leaves it, is named in ``damaged_lines`` and left in place.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.damaged_lines: list[int] = []
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            text = self.path.read_text(encoding='utf-8') if self.path.exists() else ''
        except OSError as error:
            raise JournalError(f'{self.path}: {error}') from error
        self.records = self._parse(text)
        self._line_open = bool(text) and not text.endswith('\n')

    def known(self) -> set[str]:
        """Return the names of all occurrences in the journal."""
        return {record['occurrence'] for record in self.records if record['occurrence']}

    def append(self, events: Iterable[AlarmEvent]) -> None:
        """Write events at the end of the file."""
        records = [_record(event) for event in events]
        if not records:
            return
        text = ''.join(json.dumps(record) + '\n' for record in records)
        try:
            with self.path.open('a', encoding='utf-8') as stream:
                stream.write('\n' + text if self._line_open else text)
        except OSError as error:
            raise JournalError(f'{self.path}: {error}') from error
        self._line_open = False
        self.records += records

    def _parse(self, text: str) -> list[dict[str, Any]]:
        records: list[dict[str, Any]] = []
        for number, line in enumerate(text.splitlines(), start=1):
            try:
                record = json.loads(line)
                complete = 'occurrence' in record and 'state' in record
            except (ValueError, TypeError):
                complete = False
            if complete:
                records.append(record)
            else:
                self.damaged_lines.append(number)
        return records


def _record(event: AlarmEvent) -> dict[str, Any]:
    record = asdict(event)
    for key, value in record.items():
        if isinstance(value, Enum):
            record[key] = value.name
        elif isinstance(value, float) and not math.isfinite(value):
            record[key] = None
    return record
