# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The predicted lift, shown again and again beside the person: where the optimum would be."""

from __future__ import annotations

import numpy as np

from human_model.motion import BodyMotion
from human_model.typing import Array
from lifting_visualization.core import drawing
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.shapes import Shape, nothing
from lifting_visualization.core.spine_loads import SpineLoads
from lifting_visualization.core.tables import colours

GHOST, GHOST_LOAD, GHOST_BOX = 'predicted', 'predicted_l5_s1', 'predicted_box'


def grips(motion: BodyMotion) -> Array:
    """Return the middle (n, 3) between the grip centres of both hands [m]."""
    return np.asarray(0.5 * (motion.point('hand_r') + motion.point('hand_l')))


class Ghost:
    """One predicted lift that is played in a loop.

    Parameters
    ----------
    motion : BodyMotion
        The predicted lift.
    box_mass : float
        [kg].
    pause : float
        Time for which the last posture stays before the lift begins again [s].
    """

    def __init__(self, motion: BodyMotion, box_mass: float, pause: float) -> None:
        self.motion = motion
        self.box_mass = box_mass
        self._pause = pause
        self._time = motion.time - motion.time[0]
        self._compression = np.full(len(motion), np.nan)
        self._disc = np.full((len(motion), 6), np.nan)

    def add_loads(self, loads: SpineLoads) -> None:
        """Take the loads of the lift."""
        known = np.isfinite(loads.compression)
        if not np.any(known):
            return
        values = np.column_stack([loads.compression, loads.position, loads.normal])[known]
        found = np.column_stack(
            [
                np.interp(self.motion.time, loads.time[known], column, np.nan, np.nan)
                for column in values.T
            ]
        )
        self._compression, self._disc = found[:, 0], found[:, 1:]

    def sample(self, elapsed: float) -> int:
        """Return the sample that is shown so long [s] after the first showing began."""
        phase = elapsed % (self._time[-1] + self._pause)
        return min(int(np.searchsorted(self._time, phase)), len(self._time) - 1)

    def shapes(self, elapsed: float, scale: SpineScale, box_size: Array) -> list[Shape]:
        """Return the picture so long [s] after the first showing began."""
        k, motion = self.sample(elapsed), self.motion
        colour = colours()['predicted']
        points = motion.points[k]
        names = motion.point_names
        upright = np.array([0.0, 0.0, 0.0, 1.0])
        shapes = drawing.body(GHOST, names, points, colour)
        shapes.append(
            drawing.label(
                GHOST,
                3,
                points[names.index('head')],
                f'optimal lift, {self.box_mass:.4g} kg',
                colour,
            )
        )
        shapes += drawing.compression(
            GHOST_LOAD, self._disc[k, :3], self._disc[k, 3:], float(self._compression[k]), scale
        )
        shapes.append(drawing.box(GHOST_BOX, motion.box_position[k], box_size, upright))
        return shapes


def no_ghost() -> list[Shape]:
    """Return what takes a ghost away."""
    return [
        *(nothing(GHOST, k) for k in range(4)),
        *(nothing(GHOST_LOAD, k) for k in range(2)),
        nothing(GHOST_BOX, 0),
    ]
