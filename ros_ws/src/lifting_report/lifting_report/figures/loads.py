# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the loads inside the body: L5-S1 with its limits, muscle activations."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from human_model.tables import read_table
from human_model.typing import Array
from lifting_report.figures.curves import percent
from lifting_report.figures.style import (
    COLOURS,
    DASHES,
    HAZARD,
    LABELS,
    LIMIT,
    figure_legend,
    figure_style,
    new_figure,
    percent_axis,
    to_svg,
)
from lifting_report.report_data import Activations, Pair, SpineCurves

#: Half width of the band that shows what the choice of the disc frame does [deg]: the 10 deg
#: by which published orientations of the L5-S1 disc differ.
DISC_FRAME_BAND = 10.0


@dataclass(frozen=True)
class LimitLine:
    """A limit to draw: value [N], its name, and whether it is the one never to be exceeded."""

    value: float
    name: str
    hazardous: bool


def spine_load(
    pair: Pair[SpineCurves],
    compression_limits: tuple[LimitLine, ...],
    shear_limits: tuple[LimitLine, ...],
    name: str,
) -> str:
    """Draw L5-S1 compression and anterior shear with their limits (figure 4.17 of the thesis)."""
    with figure_style():
        figure, (compression, shear) = new_figure(3.9, 1, 2)
        compression.set_title('L5-S1 compression')
        shear.set_title('L5-S1 anterior shear')
        for source, curves in pair.present().items():
            for axes, values, slope in (
                (compression, curves.compression, curves.compression_per_degree),
                (shear, curves.anterior_shear, curves.anterior_shear_per_degree),
            ):
                _spine_curve(axes, source, curves, values, slope)
        for axes, limits in ((compression, compression_limits), (shear, shear_limits)):
            _limit_lines(axes, limits)
            percent_axis(axes)
        compression.set_ylabel('force [N]')
        figure_legend(figure, compression)
        return to_svg(figure, name, 'L5-S1 compression and anterior shear with their limits')


def _spine_curve(
    axes: Axes, source: str, curves: SpineCurves, values: Array, slope: Array
) -> None:
    x = percent(curves.time)
    drawn = np.where(curves.solved, values, np.nan)
    band = np.where(curves.solved, np.abs(slope), np.nan) * DISC_FRAME_BAND
    if np.any(np.isfinite(band)):
        axes.fill_between(
            x,
            drawn - band,
            drawn + band,
            color=COLOURS[source],
            alpha=0.13,
            linewidth=0.0,
            label=f'{LABELS[source]}, disc frame turned by up to {DISC_FRAME_BAND:.0f}°',
        )
    axes.plot(x, drawn, color=COLOURS[source], ls=DASHES[source], label=LABELS[source])
    if np.any(np.isfinite(drawn)):
        k = int(np.nanargmax(drawn))
        axes.plot(x[k], drawn[k], 'o', ms=4.5, color=COLOURS[source])
        axes.annotate(
            f'{drawn[k]:.0f} N',
            (x[k], drawn[k]),
            xytext=(0, 5),
            textcoords='offset points',
            ha='left' if x[k] < 50.0 else 'right',
            color=COLOURS[source],
            fontweight='bold',
            fontsize=8.5,
        )


def _limit_lines(axes: Axes, limits: tuple[LimitLine, ...]) -> None:
    """Draw all limits, with the axis reaching beyond them, so that the margins are seen."""
    low, top = axes.get_ylim()
    axes.set_ylim(min(0.0, low), max([top, *(1.12 * limit.value for limit in limits)]))
    for limit in limits:
        colour = HAZARD if limit.hazardous else LIMIT
        axes.axhline(limit.value, color=colour, lw=1.4, ls='-' if limit.hazardous else (0, (6, 3)))
        axes.annotate(
            f'{limit.name}, {limit.value:.0f} N',
            (99.0, limit.value),
            xytext=(0, 3),
            textcoords='offset points',
            ha='right',
            color=colour,
            fontsize=8,
        )


@dataclass(frozen=True)
class MuscleGroup:
    """A muscle of the report and the pattern of its fascicles' names."""

    name: str
    pattern: str


def muscle_groups() -> tuple[MuscleGroup, ...]:
    """Read the muscles the thesis shows from ``data/report_muscles.csv``."""
    rows = read_table('lifting_report', 'report_muscles.csv', 'group pattern')
    return tuple(MuscleGroup(row['group'], row['pattern']) for row in rows)


def muscle_activations(pair: Pair[Activations], name: str) -> str:
    """Draw the activation of the muscles the thesis shows (figures 4.14 to 4.16).

    Thick the mean over the fascicles of both sides, thin the most active fascicle. A muscle of
    which the model has no fascicle is named as such in its panel.
    """
    groups = muscle_groups()
    columns = 4
    lines = -(-len(groups) // columns)
    with figure_style():
        figure, panels = new_figure(0.7 + 2.0 * lines, lines, columns, share_y=True)
        for k, group in enumerate(groups):
            axes = panels[k]
            axes.set_title(group.name)
            found = False
            for source, activations in pair.present().items():
                chosen = [
                    index
                    for index, muscle in enumerate(activations.muscles)
                    if re.search(group.pattern, muscle)
                ]
                if not chosen:
                    continue
                found = True
                x = percent(activations.time)
                values = np.where(
                    activations.solved[:, None], activations.activation[:, chosen], np.nan
                )
                axes.plot(
                    x,
                    values.mean(axis=1),
                    color=COLOURS[source],
                    ls=DASHES[source],
                    label=f'{LABELS[source]}, mean of the fascicles',
                )
                axes.plot(
                    x,
                    values.max(axis=1),
                    color=COLOURS[source],
                    ls=DASHES[source],
                    lw=0.8,
                    alpha=0.8,
                    label=f'{LABELS[source]}, most active fascicle',
                )
            if not found:
                axes.text(50.0, 0.5, 'not in this model', ha='center', va='center')
            percent_axis(axes, k >= len(groups) - columns)
            axes.set_ylim(0.0, 1.02)
            if k % columns == 0:
                axes.set_ylabel('activation [1]')
        for axes in panels[len(groups) :]:
            axes.set_visible(False)
        figure_legend(figure, next((axes for axes in panels if axes.lines), panels[0]))
        return to_svg(figure, name, 'Muscle activations of the recorded and the optimal lift')
