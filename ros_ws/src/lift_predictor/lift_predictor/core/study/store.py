# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of a study on disk: small complete Parquet files while it runs, one table at the end.

A file appears under its name only when it is complete and on the disk, so that a study that is
killed at any instant loses at most the rows that were not written yet; they are solved again.
"""

from __future__ import annotations

import fcntl
import os
import time
import uuid
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from lift_predictor.core.exceptions import StudyError
from lift_predictor.core.study.rows import COLUMNS

TABLE: Final = 'results.parquet'
PARTS: Final = 'parts'
BATCH: Final = 50
"""Rows, or ..."""
INTERVAL: Final = 2.0
"""... seconds after which what came is written."""


class Store:
    """Results of one study in a folder.

    Parameters
    ----------
    folder : Path
        Made if there is none.

    Raises
    ------
    StudyError
        A file in it is no table of a study (it is named), or another process uses it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._parts = folder / PARTS
        self._parts.mkdir(parents=True, exist_ok=True)
        self._lock = (folder / '.lock').open('w')
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise StudyError(f'{folder}: another study is writing there') from None
        # What a killed process had not finished; its rows are solved again.
        for leftover in (*folder.glob('*.tmp'), *self._parts.glob('*.tmp')):
            leftover.unlink()
        self._known: dict[str, dict[str, Any]] = {}
        self._waiting: list[dict[str, Any]] = []
        self._written = time.monotonic()
        for path in (folder / TABLE, *sorted(self._parts.glob('*.parquet'))):
            if path.exists():
                self._known |= {row['case_id']: row for row in _read(path)}

    def close(self) -> None:
        """Write what came and let another process use the folder."""
        self.flush()
        self._lock.close()

    @property
    def rows(self) -> dict[str, dict[str, Any]]:
        """All rows by case id."""
        return self._known

    def add(self, row: dict[str, Any]) -> None:
        """Take one row; it is on the disk after `INTERVAL` seconds of further rows, or `flush`."""
        self._known[row['case_id']] = row
        self._waiting.append(row)
        if len(self._waiting) >= BATCH or time.monotonic() - self._written > INTERVAL:
            self.flush()

    def flush(self) -> None:
        """Write what came since the last time."""
        if self._waiting:
            _write(self._parts / f'{uuid.uuid4().hex}.parquet', self._waiting)
            self._waiting = []
        self._written = time.monotonic()

    def finish(self, order: Sequence[str]) -> Path:
        """Write one table, first the given cases in their order; drop the small files."""
        self.flush()
        wanted = set(order)
        rows = [self._known[case] for case in order if case in self._known]
        rows += [row for case, row in self._known.items() if case not in wanted]
        path = self.folder / TABLE
        _write(path, rows)
        for part in self._parts.glob('*.parquet'):
            part.unlink()
        return path


def read_table(path: Path) -> list[dict[str, Any]]:
    """Read the rows of a study's table.

    Raises
    ------
    StudyError
        It is not one.
    """
    return _read(path)


def _read(path: Path) -> list[dict[str, Any]]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        table = pq.read_table(path)
    except (OSError, pa.ArrowException) as error:
        raise StudyError(f'{path}: is no Parquet table: {error}') from error
    missing = [name for name in COLUMNS if name not in table.column_names]
    if missing:
        raise StudyError(f'{path}: is no table of a study: column {missing[0]!r} is missing')
    rows: list[dict[str, Any]] = table.to_pylist()
    return rows


def _write(path: Path, rows: Iterable[dict[str, Any]]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    types = {'string': pa.string(), 'double': pa.float64(), 'int64': pa.int64()}
    schema = pa.schema([(name, types[kind]) for name, kind in COLUMNS.items()])
    table = pa.Table.from_pylist([_without_nan(row) for row in rows], schema=schema)
    temporary = path.with_name(f'{path.name}.{os.getpid()}.tmp')
    with temporary.open('wb') as file:
        pq.write_table(table, file)
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def _without_nan(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row with null for what is not known."""
    return {
        key: None if isinstance(value, float) and np.isnan(value) else value
        for key, value in row.items()
    }
