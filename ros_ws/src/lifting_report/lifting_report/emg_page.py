# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The page of EMG beside computed activations (figures 4.14, 4.15 and 5.6 of the thesis)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from lifting_report.figures.curves import percent
from lifting_report.figures.style import (
    DASHES,
    SERIES,
    figure_legend,
    figure_style,
    new_figure,
    percent_axis,
    to_svg,
)
from lifting_report.findings import EmgFindings
from lifting_report.pages import SIDES, Drawing, drawing, render_page, write_page
from muscle_analyzer.core.emg.comparison import EmgMatch

_COLUMNS = 2
_PANEL = 1.75


def build_emg_page(matches: Sequence[EmgMatch], title: str, path: Path) -> Path:
    """Write the page; return its path.

    Parameters
    ----------
    matches : sequence of EmgMatch
        Of one lift.
    title : str
        What was compared.
    path : Path
        Of the HTML file.
    """
    findings = EmgFindings(tuple(matches))
    drawn = emg_drawing(findings.matches, 'emg')
    page = render_page('emg.html', title=title, findings=findings, drawing=drawn)
    return write_page(path, page)


def emg_drawing(matches: Sequence[EmgMatch], name: str) -> Drawing:
    """Return the figure of the EMG of a lift; `name` makes its ids unique."""
    return drawing(
        'Envelope of the EMG and computed activation',
        lambda: curves(matches, name),
        'EMG: band-pass 10 to 450 Hz, rectified, low-pass 5 Hz, without delay, as a fraction of '
        'the maximum voluntary contraction, otherwise of the maximum of the recording. Computed: '
        'mean activation of the parts of the muscle in the model. Co-contraction is computed only '
        'as far as the balance needs it.',
        '' if matches else 'no channel could be compared',
    )


def curves(matches: Sequence[EmgMatch], name: str) -> str:
    """Draw one panel per channel, over the course of the lift."""
    lines = math.ceil(len(matches) / _COLUMNS)
    with figure_style():
        drawing, panels = new_figure(0.9 + _PANEL * lines, lines, _COLUMNS)
        for axes in panels[len(matches) :]:
            axes.set_visible(False)
        for k, (axes, match) in enumerate(zip(panels, matches, strict=False)):
            x = percent(match.time)
            axes.set_title(f'{match.muscle}, {SIDES[match.side]}')
            axes.plot(x, match.envelope, color=SERIES[0], label='EMG')
            axes.plot(
                x, match.activation, color=SERIES[1], ls=DASHES['predicted'], label='computed'
            )
            axes.set_ylim(bottom=0.0)
            percent_axis(axes, k + _COLUMNS >= len(matches))
        figure_legend(drawing, panels[0])
        names = ', '.join(f'{m.muscle} {SIDES[m.side]}' for m in matches)
        return to_svg(drawing, name, f'EMG and computed activation of {names}')
