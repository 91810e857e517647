# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the front door."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from injury_monitor.core.limits import limits_for
from muscle_analyzer.core.loads.analysis import MuscleAnalysis


def plot_spine_load(analysis: MuscleAnalysis, lifts_per_day: float) -> Figure:
    """Draw compression and anterior shear of L5-S1 with the limits in force.

    Samples without a solution leave a gap. The figure belongs to no window:
    `figure.savefig(path)` writes it, a notebook shows it.
    """
    limits = limits_for(lifts_per_day)
    figure = Figure(figsize=(7.0, 4.0), layout='constrained')
    axes = figure.subplots()
    time = analysis.time - analysis.time[0]
    good = analysis.spine_status == 0
    series = (
        ('compression', analysis.compression, limits.compression_action.value, 'tab:blue'),
        ('anterior shear', analysis.anterior_shear, limits.shear.value, 'tab:orange'),
    )
    for name, values, limit, colour in series:
        axes.plot(time, np.where(good, values, np.nan), color=colour, label=name)
        axes.axhline(limit, color=colour, ls='--', lw=1, label=f'{name}, limit {limit:g} N')
    axes.set(xlabel='time [s]', ylabel='force on L5-S1 [N]')
    axes.legend()
    return figure
