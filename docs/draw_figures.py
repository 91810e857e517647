# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figures of the documents from the project's own code and data."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from muscle_analyzer.core.disc_frame import DiscOption, disc_load, disc_parameters, disc_rotation

FIGURES = Path(__file__).parent / 'figures'
RESULTANT = 2500.0
"""Force whose components are shown [N]."""

# Drawn on their own white card, so that they can be read on a light and on a dark page; the
# same input gives the same file.
STYLE = {
    'svg.hashsalt': 'lift monitor', 'svg.fonttype': 'path', 'font.size': 10,
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.grid': True,
    'grid.alpha': 0.35, 'figure.facecolor': 'white', 'savefig.facecolor': 'white',
}  # fmt: skip
BLUE, ORANGE, GREY = '#1f5fa8', '#b7541b', '#52606d'


def save(figure: Figure, name: str) -> None:
    """Write a figure as SVG without the date."""
    FIGURES.mkdir(exist_ok=True)
    figure.savefig(FIGURES / f'{name}.svg', metadata={'Date': None}, bbox_inches='tight')
    print(FIGURES / f'{name}.svg')


def leant(degrees: float) -> np.ndarray:
    """Return OpenSim body axes (forward, up, right) leant forward."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def disc_frame() -> Figure:
    """Compression and shear of one reaction in frames that lean more or less."""
    default = disc_parameters(DiscOption.BRUNO2015)['forward_tilt']
    normal = leant(default)[:, 1]
    reaction = np.concatenate([np.zeros(3), RESULTANT * normal])
    lean = np.arange(default - 30.0, default + 30.5, 0.5)
    loads = [disc_load(reaction, disc_rotation(DiscOption.VERTEBRAL, leant(angle), np.eye(3), 0.0))
             for angle in lean]
    figure = Figure(figsize=(7.2, 3.4))
    axes = figure.subplots()
    for name, colour in (('compression', BLUE), ('anterior_shear', ORANGE)):
        values = [getattr(load, name) for load in loads]
        axes.plot(lean, values, color=colour)
        axes.text(lean[-1] + 0.8, values[-1], name.replace('_', ' '), color=colour, va='center')
    for limit, words in ((1000.0, 'shear limit, up to 100 loads a day'),
                         (700.0, 'shear limit, above 100 loads a day')):
        axes.axhline(limit, color=ORANGE, linestyle='--', linewidth=0.9)
        axes.text(lean[0], limit + 30.0, words, color=ORANGE, fontsize=8)
    options = {default: 'bruno2015', disc_parameters(DiscOption.VERTEBRAL)['forward_tilt']:
               'vertebral'}
    for angle, name in options.items():
        axes.axvline(angle, color=GREY, linestyle=':', linewidth=1.0)
        axes.text(angle + 0.5, -1250.0, name, color=GREY, fontsize=8)
    axes.set_xlabel('lean of the disc normal forward of the long axis of L5 [deg]')
    axes.set_ylabel(f'part of {RESULTANT:.0f} N [N]')
    return figure


def main() -> None:
    """Draw all figures."""
    mpl.use('Agg')
    with mpl.rc_context(STYLE):
        save(disc_frame(), 'disc_frame')


if __name__ == '__main__':
    main()
