# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Places of a person's links in their parents, as /tf has them, from the joint coordinates.

The links are those of the URDF (`human_model.urdf`): one per coordinate, so no chain has to be
multiplied. robot_state_publisher computes the same frames from URDF and joint states.
"""

from __future__ import annotations

import numpy as np

from human_model.skeleton import Skeleton
from human_model.tree import PRISMATIC
from human_model.typing import Array
from human_model.urdf import WORLD, body_names, fixed_segments
from lifting_visualization.core.exceptions import PictureError


class LinkFrames:
    """The links of one skeleton with the names of one station.

    Parameters
    ----------
    skeleton : Skeleton
    prefix : str
        Before the name of each link, for example ``station_1/``; not before the laboratory.

    Attributes
    ----------
    parents, children : tuple of str, n_q
        Frames of the moving links.
    fixed : tuple of (parent, child, ndarray (3,))
        Links without a joint and their places [m]; their axes are the parents'.
    """

    def __init__(self, skeleton: Skeleton, prefix: str) -> None:
        tree = skeleton.tree
        names = [prefix + name for name in body_names(skeleton)]
        self.children = tuple(names)
        self.parents = tuple(names[int(p)] if p >= 0 else WORLD for p in tree.parent)
        self.fixed = tuple(
            (prefix + link, prefix + segment, place)
            for segment, (link, place) in fixed_segments(skeleton).items()
        )
        self._coordinates = skeleton.coordinates
        self._slides = (tree.kind == PRISMATIC)[:, None]
        self._offset, self._axis = tree.offset, tree.axis

    def transforms(self, coordinates: tuple[str, ...], position: Array) -> Array:
        """Return translation [m] and quaternion xyzw (n_q, 7) of each link in its parent.

        Parameters
        ----------
        coordinates : tuple of str, n_q
            Must be those of the skeleton.
        position : ndarray (n_q,)
            [rad or m].

        Raises
        ------
        PictureError
            If the coordinates are others.
        """
        if coordinates != self._coordinates:
            raise PictureError(
                f'body_motion.coordinate_names: {len(coordinates)} names, not the '
                f'{len(self._coordinates)} of the skeleton'
            )
        value = position[:, None]
        half = 0.5 * value
        found = np.empty((len(position), 7))
        found[:, :3] = self._offset + np.where(self._slides, self._axis * value, 0.0)
        found[:, 3:6] = np.where(self._slides, 0.0, self._axis * np.sin(half))
        found[:, 6:] = np.where(self._slides, 1.0, np.cos(half))
        return found
