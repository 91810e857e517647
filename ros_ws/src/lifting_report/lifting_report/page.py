# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The report page: one HTML file that needs nothing else."""

from __future__ import annotations

import math
from pathlib import Path

from lifting_report.lift_section import ShownLift, shown_lift
from lifting_report.pages import render_page, write_page
from lifting_report.report_data import Missing, ReportData


def build_report(data: ReportData, path: str | Path) -> Path:
    """Write the report; the folder is created if necessary.

    Parameters
    ----------
    data : ReportData
    path : path
        Of the HTML file.

    Returns
    -------
    Path
    """
    return write_page(Path(path), render(data))


def render(data: ReportData) -> str:
    """Return the page as HTML text."""
    lifts: tuple[ShownLift, ...] = ()
    if not isinstance(data.lifts, Missing):
        lifts = tuple(shown_lift(lift, data, f'lift{k}') for k, lift in enumerate(data.lifts))
    return render_page(
        'report.html',
        title=f'Lift report: {data.header.task}, {data.header.subject}',
        data=data,
        lifts=lifts,
        worst=_worst(lifts),
    )


def _worst(lifts: tuple[ShownLift, ...]) -> int:
    """Return the number of the lift with the highest recorded compression."""
    peaks: list[float] = []
    for shown in lifts:
        risk = shown.lift.risk
        found = None if isinstance(risk, Missing) else risk.find('compression_action', 'measured')
        peaks.append(-math.inf if found is None or math.isnan(found.value) else found.value)
    return peaks.index(max(peaks)) if peaks else 0
