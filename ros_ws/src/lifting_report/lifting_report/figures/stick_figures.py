# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sequence of stick figures of both lifts, seen from the person's right."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from human_model.typing import Array
from lifting_report.figures.style import (
    BOX,
    COLOURS,
    INK,
    LABELS,
    SOFT,
    figure_style,
    new_figure,
    to_svg,
)
from lifting_report.report_data import BodyPoints, Pair

_TRUNK = ('pelvis', 'l5_s1', 'c7', 'head')
_LIMBS = (
    ('c7', 'shoulder', 'elbow', 'wrist', 'hand'),
    ('pelvis', 'hip', 'knee', 'ankle', 'heel', 'mtp', 'toe'),
    ('ankle', 'mtp'),
)
_PHASES = (0, 20, 40, 60, 80, 100)
#: Radius of the drawn head [m]; a symbol, no measure.
_HEAD = 0.09


def stick_sequence(pair: Pair[BodyPoints], name: str) -> str:
    """Draw both lifts at 0, 20, ... 100 % of their course, one row each, on one scale."""
    present = pair.present()
    with figure_style():
        figure, panels = new_figure(0.3 + 2.75 * len(present), len(present), 1, legend=False)
        for axes, (source, body) in zip(panels, present.items(), strict=True):
            _row(axes, body, COLOURS[source])
            axes.set_title(f'{LABELS[source].capitalize()} lift')
        return to_svg(figure, name, 'Stick figures of the recorded and of the optimal lift')


def _row(axes: Axes, body: BodyPoints, colour: str) -> None:
    samples = [
        int(
            np.argmin(
                np.abs(body.time - body.time[0] - phase / 100.0 * (body.time[-1] - body.time[0]))
            )
        )
        for phase in _PHASES
    ]
    drawn = body.points[samples]
    reach = np.concatenate([drawn[..., 0].ravel(), body.box[samples, 0]])
    floor, ceiling = -0.25, max(1.95, float(np.nanmax(drawn[..., 2])) + 0.2)
    # At least as wide as the panel is at equal scales, so that the row fills it.
    place = axes.get_window_extent()
    fill = (ceiling - floor) * place.width / place.height / (len(_PHASES) + 0.15)
    step = max(fill, 1.1 * float(np.nanmax(reach) - np.nanmin(reach)))
    for k, (sample, phase) in enumerate(zip(samples, _PHASES, strict=True)):
        shift = k * step - float(np.nanmin(reach))
        _figure(axes, body, sample, shift, colour)
        axes.text(
            k * step + 0.4 * step,
            -0.09,
            f'{phase} %',
            ha='center',
            va='top',
            color=INK,
            fontsize=8,
        )
    axes.axhline(0.0, color=SOFT, lw=1.0)
    axes.set_xlim(-0.15 * step, len(_PHASES) * step)
    axes.set_ylim(floor, ceiling)
    axes.set_aspect('equal')
    axes.set_axisbelow(True)
    axes.set_yticks((0.0, 0.5, 1.0, 1.5))
    axes.set_ylabel('height [m]')
    axes.set_xticks(())
    axes.spines['bottom'].set_visible(False)
    axes.grid(axis='x', visible=False)


def _figure(axes: Axes, body: BodyPoints, sample: int, shift: float, colour: str) -> None:
    points = dict(zip(body.names, body.points[sample], strict=True))

    def chain(names: tuple[str, ...], alpha: float, width: float) -> None:
        places: list[Array] = [points[point] for point in names if point in points]
        if len(places) > 1:
            line = np.array(places)
            axes.plot(
                line[:, 0] + shift,
                line[:, 2],
                color=colour,
                alpha=alpha,
                lw=width,
                solid_joinstyle='round',
            )

    for side, alpha in (('l', 0.45), ('r', 1.0)):
        for limb in _LIMBS:
            chain(
                tuple(point if point in _TRUNK else f'{point}_{side}' for point in limb),
                alpha,
                1.8,
            )
    chain(_TRUNK[:3], 1.0, 2.6)
    if 'head' in points:
        axes.add_patch(
            Circle(
                (points['head'][0] + shift, points['head'][2]),
                _HEAD,
                fill=False,
                color=colour,
                lw=1.8,
            )
        )
    depth, _, height = body.box_size
    centre = body.box[sample]
    if np.all(np.isfinite(centre)) and np.isfinite(depth) and np.isfinite(height):
        axes.add_patch(
            Rectangle(
                (centre[0] - 0.5 * depth + shift, centre[2] - 0.5 * height),
                depth,
                height,
                facecolor=BOX,
                alpha=0.55,
                edgecolor=INK,
                lw=0.9,
            )
        )
