# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift journal`: verify, show and export the journal of a station's alarms."""

from __future__ import annotations

import argparse
import csv
import json
import math
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from injury_monitor.core.exceptions import JournalError
from lifting_cli.graph_errors import SessionError


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser('journal', help='verify, show or export the journal of alarms')
    actions = parser.add_subparsers(dest='action', required=True)
    verify = actions.add_parser('verify', help='check that nothing was changed or removed')
    verify.add_argument('--head', help='hash noted earlier: it must be part of the chain')
    show = actions.add_parser('show', help='print the events')
    show.add_argument('--last', type=int, help='only so many of the latest')
    export = actions.add_parser('export', help='write the events to a .csv or .parquet file')
    for action, handler in ((verify, _verify), (show, _show), (export, _export)):
        action.add_argument('journal', type=Path, help='file of the journal')
        action.set_defaults(handler=handler)
    export.add_argument('output', type=Path, help='a .csv or .parquet file')


def _journal(path: Path) -> Any:
    from injury_monitor.core.journal import AlarmJournal

    if not path.is_file():
        raise JournalError(path, 'does not exist')
    return AlarmJournal(path, readonly=True)


def _verify(options: argparse.Namespace) -> int:
    with _journal(options.journal) as journal:
        result = journal.verify()
        problems = list(result.problems)
        if options.head and options.head not in {row.hash.hex() for row in journal.rows()}:
            problems.append(f'no event has the hash {options.head}')
    for problem in problems:
        print(problem)
    print(f'{result.rows} events, {len(problems)} problems, head {result.head.hex()}')
    return 1 if problems else 0


def _show(options: argparse.Namespace) -> int:
    with _journal(options.journal) as journal:
        events = list(journal.events())
    for event in events[-options.last :] if options.last else events:
        stamp = datetime.fromtimestamp(event.stamp, UTC).isoformat(timespec='milliseconds')
        print(f'{stamp} {event.station} {event.message()}')
    return 0


def _export(options: argparse.Namespace) -> int:
    with _journal(options.journal) as journal:
        rows = [
            {'number': row.number, **json.loads(row.record), 'hash': row.hash.hex()}
            for row in journal.rows()
        ]
    if not rows:
        raise SessionError(f'{options.journal}: holds no events')
    match options.output.suffix:
        case '.csv':
            with options.output.open('w', encoding='utf-8', newline='') as stream:
                writer = csv.DictWriter(stream, rows[0])
                writer.writeheader()
                writer.writerows(rows)
        case '.parquet':
            import pyarrow as pa
            import pyarrow.parquet

            columns = {
                key: [math.nan if row[key] is None else row[key] for row in rows]
                for key in rows[0]
            }
            pyarrow.parquet.write_table(pa.table(columns), options.output)
        case suffix:
            raise SessionError(f'{options.output}: {suffix!r} is neither .csv nor .parquet')
    print(f'{len(rows)} events in {options.output}')
    return 0
