# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a study: solves the cases that have no row yet, and writes the table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lift_predictor.core.study.cases import Case
from lift_predictor.core.study.rows import CRASHED
from lift_predictor.core.study.schedulers import Row, Scheduler
from lift_predictor.core.study.store import Store

Listener = Callable[[int, int, Row | None], None]
"""Told of cases done, cases in all, and the row that came (None: those of an earlier run)."""


@dataclass(frozen=True)
class StudyReport:
    """What a run of a study did.

    Attributes
    ----------
    table : Path
        Parquet file with a row for each case.
    cases, earlier : int
        Of the study, and of them solved in an earlier run.
    statuses : dict
        Name of the status: number of cases.
    """

    table: Path
    cases: int
    earlier: int
    statuses: dict[str, int]


def run_study(
    cases: Sequence[Case],
    folder: Path,
    scheduler: Scheduler,
    listener: Listener | None = None,
    retry_crashed: bool = False,
) -> StudyReport:
    """Solve what is missing in a folder.

    It may be killed at any time; called again, it goes on.

    Parameters
    ----------
    cases : sequence of Case
        All cases of the study; the same case twice is solved once.
    folder : Path
        Of the results.
    scheduler : Scheduler
        Where cases are solved.
    listener : callable, optional
        Told of each row.
    retry_crashed : bool
        Solve again what ended with an exception or with its process.

    Raises
    ------
    StudyError
        The folder holds something else, or another process writes there.
    """
    unique = {case.case_id: case for case in cases}
    store = Store(folder)
    try:
        known = {
            case_id
            for case_id, row in store.rows.items()
            if not (retry_crashed and row['status'] == CRASHED)
        }
        missing = [case for case_id, case in unique.items() if case_id not in known]
        done = earlier = len(unique) - len(missing)
        if listener is not None:
            listener(done, len(unique), None)
        for row in scheduler.solve(missing):
            store.add(row)
            done += 1
            if listener is not None:
                listener(done, len(unique), row)
        table = store.finish(list(unique))
        names = Counter(str(store.rows[case_id]['status_name']) for case_id in unique)
        return StudyReport(table, len(unique), earlier, dict(names))
    finally:
        store.close()
