# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Figure of the peak loads of all joints that are looked at."""

from __future__ import annotations

from operator import attrgetter

import numpy as np
from matplotlib.axes import Axes

from human_model.typing import Array
from lifting_report.figures.style import (
    COLOURS,
    LABELS,
    figure_legend,
    figure_style,
    new_figure,
    to_svg,
)
from lifting_report.report_data import JointLoads, Pair

#: Names of the joints on the page.
TITLES = {
    'l5_s1': 'L5-S1',
    'l4_l5': 'L4-L5',
    'l3_l4': 'L3-L4',
    'l2_l3': 'L2-L3',
    'l1_l2': 'L1-L2',
    't12_l1': 'T12-L1',
    'hip_r': 'hip, right',
    'hip_l': 'hip, left',
    'knee_r': 'knee, right',
    'knee_l': 'knee, left',
}


def joint_peaks(pair: Pair[JointLoads], name: str) -> str:
    """Draw the peak compression and the peak shear of each joint, both lifts side by side."""
    present = pair.present()
    joints = next(iter(present.values())).joints
    place = np.arange(len(joints), dtype=np.float64)
    height = 0.8 / len(present)
    with figure_style():
        figure, panels = new_figure(0.9 + 0.42 * len(joints), 1, 2)
        for axes, title, values in (
            (panels[0], 'peak compression', attrgetter('peak_compression')),
            (panels[1], 'peak shear, all directions', attrgetter('peak_shear')),
        ):
            axes.set_title(title)
            for k, (source, loads) in enumerate(present.items()):
                peaks = values(loads)
                at = place + (k - 0.5 * (len(present) - 1)) * height
                axes.barh(
                    at,
                    np.nan_to_num(peaks),
                    0.9 * height,
                    color=COLOURS[source],
                    label=LABELS[source],
                )
                _write(axes, at, peaks)
            axes.set_yticks(place, [TITLES.get(joint, joint) for joint in joints])
            axes.invert_yaxis()
            axes.grid(axis='y', visible=False)
            axes.margins(x=0.12)
            axes.set_xlabel('force [N]')
        figure_legend(figure, panels[0])
        figure.subplots_adjust(left=0.1, wspace=0.28)
        return to_svg(figure, name, 'Peak compression and shear at lumbar levels, hips and knees')


def _write(axes: Axes, places: Array, peaks: Array) -> None:
    """Write each peak beside its bar, and that there is none where no sample solved."""
    for y, peak in zip(places, peaks, strict=True):
        text = f'{peak:.0f}' if np.isfinite(peak) else 'none solved'
        axes.annotate(
            text,
            (float(np.nan_to_num(peak)), y),
            xytext=(3, 0),
            textcoords='offset points',
            va='center',
            fontsize=7.5,
        )
