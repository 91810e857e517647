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
from lifting_report.html_parts import absent, amount, figure, table, text
from lifting_report.page_style import CSS
from muscle_analyzer.core.emg.comparison import EmgMatch
from muscle_analyzer.core.emg.envelopes import GIVEN_MVC

SIDES = {'r': 'right', 'l': 'left'}
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
    body = f'<h1>EMG and activations</h1><p class="lead">{text(title)}</p>' + emg_part(
        EmgFindings(tuple(matches)), 'emg'
    )
    page = (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{text(title)}</title><style>{CSS}</style></head>'
        f'<body><main>{body}</main></body></html>\n'
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding='utf-8')
    return path


def emg_part(findings: EmgFindings, name: str) -> str:
    """Return figure and table of a lift's EMG as HTML; `name` makes ids unique."""
    caption = (
        'EMG: band-pass 10 to 450 Hz, rectified, low-pass 5 Hz, without delay, as a share of the '
        'maximum voluntary contraction or else of the maximum of the recording. Computed: mean '
        'activation of the parts of the muscle in the model. No co-contraction is computed beyond '
        'what balance needs.'
    )
    head = ('channel', 'muscle', 'side', 'EMG is a share of', 'correlation', 'phase error',
            'of the lift', 'correlation then', 'rms', '')  # fmt: skip
    left_out = ''.join(f'<p class="note">Not compared: {text(why)}</p>'
                       for why in findings.left_out)  # fmt: skip
    matches = findings.matches
    if not matches:
        return absent('EMG', 'no channel could be compared') + left_out
    return (
        figure('Envelope of the EMG and computed activation', curves(matches, name), caption)
        + table(head, [_row(match) for match in matches], (4, 5, 6, 7, 8))
        + '<p class="note">Phase error: shift of the activation against the EMG at which both '
        'correlate best, positive if the activation is later. The rms says something only where '
        'an MVC was given.</p>' + left_out
    )


def curves(matches: Sequence[EmgMatch], name: str) -> str:
    """Draw a panel a channel, over the course of the lift."""
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


def _row(match: EmgMatch) -> list[str]:
    return [
        text(match.channel),
        text(match.muscle),
        SIDES[match.side],
        text('MVC' if match.normalised_by == GIVEN_MVC else match.normalised_by),
        amount(match.correlation, digits=2),
        amount(1e3 * match.lag, 'ms'),
        amount(match.lag_percent, '%', 1),
        amount(match.best_correlation, digits=2),
        amount(match.rms, digits=3),
        text(match.note),
    ]
