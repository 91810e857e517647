# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pose of the box from markers on it, by the least-squares rotation of Kabsch (1976)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError

_NEEDED = 3
# Root mean square distance of the markers from the fitted box up to which a frame is a pose [m],
# and the share of the frames beyond it above which the layout is wrong.
_LARGEST_MISFIT = 0.03
_WRONG_SHARE = 0.5


def box_poses(
    names: tuple[str, ...], markers: Array, layout: Mapping[str, tuple[float, float, float]]
) -> tuple[Array, Array, int]:
    """Fit the box to its markers in every frame.

    Parameters
    ----------
    names : tuple of str
        Marker names.
    markers : ndarray, shape (n, n_markers, 3)
        [m], laboratory axes; NaN where not seen.
    layout : Mapping of str to (3,)
        Place of each box marker from the box centre, box axes [m].

    Returns
    -------
    position : ndarray, shape (n, 3)
        Centre of the box [m]; NaN in frames with fewer than three markers, or with markers that do
        not fit the box.
    quaternion : ndarray, shape (n, 4)
        x y z w, laboratory from box.
    misfits : int
        Frames whose markers do not fit the box.

    Raises
    ------
    ConventionError
        A box marker is not in the recording, the layout is a line, or it does not fit the markers
        in most of the frames.
    """
    missing = [name for name in layout if name not in names]
    if missing:
        raise ConventionError(f'recording.box_markers: the recording has no {missing}')
    columns = [names.index(name) for name in layout]
    local = np.array(list(layout.values()), dtype=np.float64)
    if np.linalg.matrix_rank(local - local.mean(axis=0), tol=1e-3) < 2:
        raise ConventionError('recording.box_markers: the markers lie on one line')
    n = len(markers)
    tried, misfits = 0, list[float]()
    position, quaternion = np.full((n, 3), np.nan), np.full((n, 4), np.nan)
    for i in range(n):
        seen = np.all(np.isfinite(markers[i, columns]), axis=1)
        if np.count_nonzero(seen) < _NEEDED:
            continue
        tried += 1
        world, body = markers[i, columns][seen], local[seen]
        fit, distance = Rotation.align_vectors(
            world - world.mean(axis=0), body - body.mean(axis=0)
        )
        misfit = float(distance) / np.sqrt(len(world))
        if misfit > _LARGEST_MISFIT:
            misfits.append(misfit)
            continue
        quaternion[i] = fit.as_quat()
        position[i] = world.mean(axis=0) - fit.apply(body.mean(axis=0))
    if len(misfits) > _WRONG_SHARE * tried:
        misfit = 1e3 * float(np.median(misfits))
        raise ConventionError(
            f'recording.box_markers: the markers are {misfit:.0f} mm (root mean square) from '
            f'their places on the box in {len(misfits)} of {tried} frames: write their positions '
            'in metres from the centre of the box, with x depth, y width (left), z height'
        )
    return position, quaternion, len(misfits)
