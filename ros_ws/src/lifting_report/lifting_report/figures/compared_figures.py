# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of two lifts side by side (figures 5.5, 5.6 and 5.7 of the thesis).

The first lift is a full line, the second a broken one, in every figure: they can be told apart
in grey too.  Recorded and optimal lifts, left and right have panels of their own.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from human_model.typing import Array
from lifting_report.compared import (
    COMPONENTS,
    SIDES,
    SOURCES,
    ComparedLift,
    Two,
    curve,
    muscle_course,
    peak,
)
from lifting_report.figures.curves import percent
from lifting_report.figures.loads import LimitLine, muscle_groups
from lifting_report.figures.style import (
    HAZARD,
    LIMIT,
    SERIES,
    SOFT,
    figure_legend,
    figure_style,
    new_figure,
    percent_axis,
    to_svg,
)
from lifting_report.report_data import Missing

#: Limits by component of the L5-S1 load.
Limits = dict[str, tuple[LimitLine, ...]]

_COLOURS = (SERIES[2], SERIES[3])
_DASHES: tuple[str | tuple[int, tuple[int, ...]], ...] = ('-', (0, (4, 2)))
#: Muscles beside each other, each with two panels.
_MUSCLES_A_LINE = 2
#: Room over the highest limit, as a share of it.
_HEADROOM = 1.22


def spine_loads(lifts: Two, limits: Limits, name: str) -> str:
    """Draw compression, anterior and lateral shear with their limits, recorded and optimal."""
    with figure_style():
        figure, panels = new_figure(6.6, 2, len(COMPONENTS))
        for row, (source, word) in enumerate(SOURCES.items()):
            for column, (component, title) in enumerate(COMPONENTS.items()):
                axes = panels[row * len(COMPONENTS) + column]
                axes.set_title(f'{title.capitalize()}, {word}')
                for k, lift in enumerate(lifts):
                    _spine_curve(axes, lift, k, source, component)
                _limit_lines(axes, component, limits[component])
                percent_axis(axes, row == len(SOURCES) - 1)
                if column == 0:
                    axes.set_ylabel('force [N]')
        for column in range(len(COMPONENTS)):
            _share_y(panels[column], panels[column + len(COMPONENTS)])
        figure_legend(figure, _labelled(panels))
        return to_svg(figure, name, 'L5-S1 load of both lifts with the limits')


def _spine_curve(axes: Axes, lift: ComparedLift, k: int, source: str, component: str) -> None:
    part = getattr(lift.lift.spine, source)
    if isinstance(part, Missing):
        _say(axes, f'{lift.name}: not available', k)
        return
    x, y = percent(part.time), curve(part, component)
    axes.plot(x, y, color=_COLOURS[k], ls=_DASHES[k], label=lift.name)
    largest, at = peak(part, component)
    if np.isfinite(largest):
        axes.plot(at, largest, 'os'[k], ms=4.5, color=_COLOURS[k])
        axes.annotate(
            f'{largest:.0f} N'.replace('-', '−'), (at, largest), xytext=(5, (4, -11)[k]),
            textcoords='offset points', ha='left' if at < 60.0 else 'right',
            color=_COLOURS[k], fontweight='bold', fontsize=8,
        )  # fmt: skip


def _limit_lines(axes: Axes, component: str, lines: tuple[LimitLine, ...]) -> None:
    """Draw the limits with the axis reaching beyond them."""
    if not lines:
        axes.axhline(0.0, color=SOFT, lw=0.8)
        axes.margins(y=0.16)
        return
    low, top = axes.get_ylim()
    axes.set_ylim(min(0.0, low), max([top, *(_HEADROOM * line.value for line in lines)]))
    for line in lines:
        colour = HAZARD if line.hazardous else LIMIT
        axes.axhline(line.value, color=colour, lw=1.3, ls='-' if line.hazardous else (0, (6, 3)))
        axes.annotate(
            f'{_in_two_lines(line.name)}, {line.value:.0f} N', (99.5, line.value),
            xytext=(0, 2.5), textcoords='offset points', ha='right', color=colour, fontsize=7.5,
            linespacing=1.05,
        )  # fmt: skip


def _in_two_lines(name: str) -> str:
    """Break a limit's name before its last half, so that it leaves the curves room."""
    words = name.split()
    half = len(words) // 2
    return f'{" ".join(words[:half])}\n{" ".join(words[half:])}'


def muscle_activations(lifts: Two, source: str, name: str) -> str:
    """Draw the muscles that the thesis shows, left and right beside each other."""
    groups = muscle_groups()
    columns = _MUSCLES_A_LINE * len(SIDES)
    lines = -(-len(groups) // _MUSCLES_A_LINE)
    with figure_style():
        figure, panels = new_figure(0.9 + 1.55 * lines, lines, columns, share_y=True)
        for j, (group, side) in enumerate((g, s) for g in groups for s in SIDES):
            axes = panels[j]
            axes.set_title(f'{group.name}, {side}')
            for k, lift in enumerate(lifts):
                course = muscle_course(lift, source, group, side)
                if isinstance(course, Missing):
                    _say(axes, f'{lift.name}: not there', k)
                    continue
                axes.plot(
                    percent(course.time),
                    course.activation,
                    color=_COLOURS[k],
                    ls=_DASHES[k],
                    label=lift.name,
                )
            percent_axis(axes, j >= len(groups) * len(SIDES) - columns)
            axes.set_ylim(0.0, 1.02)
            axes.set_yticks((0.0, 0.5, 1.0))
            if j % columns == 0:
                axes.set_ylabel('activation [1]')
        for axes in panels[len(groups) * len(SIDES) :]:
            axes.set_visible(False)
        figure_legend(figure, _labelled(panels))
        return to_svg(figure, name, f'Muscle activations of both lifts, {SOURCES[source]}')


def foot_forces(lifts: Two, name: str) -> str:
    """Draw the vertical ground reaction of the left and the right foot (figure 5.5)."""
    feet = {'left': 1, 'right': 0}
    with figure_style():
        figure, panels = new_figure(2.9, 1, 2 * len(feet), share_y=True)
        for j, (source, foot) in enumerate((s, f) for s in SOURCES for f in feet):
            axes = panels[j]
            axes.set_title(f'{foot.capitalize()} foot, {SOURCES[source]}')
            for k, lift in enumerate(lifts):
                part = getattr(lift.lift.ground, source)
                if isinstance(part, Missing):
                    _say(axes, f'{lift.name}: not available', k)
                    continue
                values: Array = part.force[:, feet[foot], 2]
                axes.plot(
                    percent(part.time), values, color=_COLOURS[k], ls=_DASHES[k], label=lift.name
                )
            percent_axis(axes)
        panels[0].set_ylim(0.0, _HEADROOM * max(axes.dataLim.y1 for axes in panels))
        panels[0].set_ylabel('vertical force [N]')
        figure_legend(figure, _labelled(panels))
        return to_svg(figure, name, 'Vertical ground reaction of each foot in both lifts')


def _share_y(first: Axes, second: Axes) -> None:
    """Give two panels one range, so that recorded and optimal can be compared by eye."""
    ranges = np.array([first.get_ylim(), second.get_ylim()])
    for axes in (first, second):
        axes.set_ylim(ranges[:, 0].min(), ranges[:, 1].max())


def _labelled(panels: list[Axes]) -> Axes:
    """Return the panel with the most curves: its legend holds for all."""
    return max(panels, key=lambda axes: len(axes.get_legend_handles_labels()[1]))


def _say(axes: Axes, words: str, k: int) -> None:
    axes.text(
        0.5,
        (0.55, 0.42)[k],
        words,
        ha='center',
        va='center',
        transform=axes.transAxes,
        color=SOFT,
        fontsize=8,
    )
