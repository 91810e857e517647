# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One look for all figures, and figures as inline SVG whose colours follow the page.

The figures are drawn in placeholder colours, which become CSS variables in the SVG text: the page
sets them for light, dark and print.
"""

from __future__ import annotations

import html
import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

#: Placeholder colour to CSS variable.
_VARIABLES = {
    '#0a0b0c': '--ink',
    '#1a1b1c': '--soft',
    '#2a2b2c': '--grid',
    '#3a3b3c': '--measured',
    '#4a4b4c': '--predicted',
    '#5a5b5c': '--limit',
    '#6a6b6c': '--hazard',
    '#7a7b7c': '--box',
    '#9a9b9c': '--series-1',
    '#9a9b9d': '--series-2',
    '#9a9b9e': '--series-3',
    '#9a9b9f': '--series-4',
    '#9a9ba0': '--series-5',
    '#9a9ba1': '--series-6',
    '#9a9ba2': '--series-7',
}
_BY_NAME = {variable[2:]: colour for colour, variable in _VARIABLES.items()}
INK, SOFT, GRID = _BY_NAME['ink'], _BY_NAME['soft'], _BY_NAME['grid']
MEASURED, PREDICTED = _BY_NAME['measured'], _BY_NAME['predicted']
LIMIT, HAZARD = _BY_NAME['limit'], _BY_NAME['hazard']
BOX = _BY_NAME['box']
#: For curves that are told apart by joint.
SERIES = tuple(_BY_NAME[f'series-{k}'] for k in range(1, 8))

COLOURS = {'measured': MEASURED, 'predicted': PREDICTED}
LABELS = {'measured': 'recorded', 'predicted': 'optimal'}
DASHES: dict[str, str | tuple[int, tuple[int, ...]]] = {'measured': '-', 'predicted': (0, (5, 2))}

#: Full width of a figure on the page [inch].
WIDTH = 9.6

_SETTINGS: dict[Any, Any] = {
    'svg.fonttype': 'none',
    'svg.hashsalt': 'report',
    'font.family': 'DejaVu Sans',
    'font.size': 8.5,
    'axes.titlesize': 9.5,
    'axes.titleweight': 'bold',
    'axes.titlelocation': 'left',
    'axes.labelsize': 8.5,
    'xtick.labelsize': 8,
    'ytick.labelsize': 8,
    'legend.fontsize': 8.5,
    'legend.frameon': False,
    'axes.spines.top': False,
    'axes.spines.right': False,
    'axes.edgecolor': SOFT,
    'axes.labelcolor': INK,
    'axes.titlecolor': INK,
    'xtick.color': SOFT,
    'ytick.color': SOFT,
    'xtick.labelcolor': INK,
    'ytick.labelcolor': INK,
    'text.color': INK,
    'axes.grid': True,
    'grid.color': GRID,
    'grid.linewidth': 0.7,
    'lines.linewidth': 1.8,
    'lines.solid_capstyle': 'round',
    'axes.linewidth': 0.8,
    'figure.facecolor': 'none',
    'axes.facecolor': 'none',
    'savefig.facecolor': 'none',
}


@contextmanager
def figure_style() -> Iterator[None]:
    """Draw in the style of the report inside this context; the user's style stays untouched."""
    with mpl.rc_context(_SETTINGS):
        yield


def new_figure(
    height: float, lines: int, columns: int, share_y: bool = False, legend: bool = True
) -> tuple[Figure, list[Axes]]:
    """Return a figure of the report's width and its panels, row by row.

    The margins are fixed in inches: a layout engine would draw every figure three times.

    Parameters
    ----------
    height : float
        Of the figure [inch].
    lines, columns : int
    share_y : bool
        All panels have the same y axis, labelled on the left only.
    legend : bool
        Leave room for a legend above the panels.
    """
    figure = Figure(figsize=(WIDTH, height))
    top = 0.62 if legend else 0.28
    panel = (height - top - 0.5) / lines
    figure.subplots_adjust(
        left=0.62 / WIDTH,
        right=1.0 - 0.12 / WIDTH,
        top=1.0 - top / height,
        bottom=0.5 / height,
        wspace=0.14 if share_y else 0.24,
        hspace=0.5 / max(panel - 0.5, 0.5),
    )
    panels = figure.subplots(lines, columns, sharey=share_y, squeeze=False)
    return figure, list(panels.ravel())


def percent_axis(axes: Axes, label: bool = True) -> None:
    """Make the x axis the course of the lift from 0 to 100 %."""
    axes.set_xlim(0.0, 100.0)
    axes.set_xticks((0, 25, 50, 75, 100))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    if label:
        axes.set_xlabel('course of the lift [%]')


def figure_legend(figure: Figure, axes: Axes, columns: int = 6) -> None:
    """Put one legend for all panels above them."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc='upper left',
        ncols=columns,
        handlelength=2.6,
        bbox_to_anchor=(0.02, 1.0),
        borderaxespad=0.1,
        columnspacing=1.6,
    )


def to_svg(figure: Figure, name: str, description: str) -> str:
    """Return a figure as an inline SVG element.

    Parameters
    ----------
    figure : Figure
    name : str
        Unique on the page; makes the ids of this figure unique.
    description : str
        Read out by screen readers.
    """
    buffer = io.StringIO()
    with mpl.rc_context(_SETTINGS):
        figure.savefig(buffer, format='svg', metadata={'Date': None, 'Creator': None})
    text = buffer.getvalue()
    text = text[text.index('<svg') :]
    text = re.sub(r'<metadata>.*?</metadata>', '', text, count=1, flags=re.DOTALL)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r'(xlink:href="#|url\(#)', rf'\g<1>{name}-', text)
    for colour, variable in _VARIABLES.items():
        text = text.replace(colour, f'var({variable})')
    # Numbers without the last invisible digits: a third of the size.
    text = re.sub(r'(\d+\.\d\d)\d+', r'\1', text)
    text = text.replace("'DejaVu Sans'", 'inherit')
    head = (
        f'<svg role="img" aria-label="{html.escape(description, quote=True)}" '
        'style="width:100%;height:auto" '
    )
    text = re.sub(r'(<svg [^>]*?) width="[^"]+"', r'\1', text, count=1)
    text = re.sub(r'(<svg [^>]*?) height="[^"]+"', r'\1', text, count=1)
    return text.replace('<svg ', head, 1).strip()
