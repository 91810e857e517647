# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Change between OpenSim's axes and those of REP-103, and between rotation forms.

OpenSim: x forward, y up, z to the right. REP-103: x forward, y to the left, z up. Therefore
``ros = (x, -z, y)`` of an OpenSim vector: a turn of the axes by 90 degrees about x.
Quaternions are ``(x, y, z, w)`` as in ROS messages, of unit length.
"""

import numpy as np
import numpy.typing as npt

from human_model.exceptions import HumanModelError
from human_model.typing import Array

#: Rows: the REP-103 axes written in OpenSim's axes; ``v_ros = ROS_FROM_OPENSIM @ v_osim``.
ROS_FROM_OPENSIM: Array = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def _vectors(vector: npt.ArrayLike) -> Array:
    array = np.asarray(vector, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise HumanModelError(f'vector: last axis must have length 3, got shape {array.shape}')
    return array


def _matrices(rotation: npt.ArrayLike) -> Array:
    array = np.asarray(rotation, dtype=np.float64)
    if array.ndim < 2 or array.shape[-2:] != (3, 3):
        raise HumanModelError(f'rotation: last axes must be (3, 3), got shape {array.shape}')
    return array


def from_opensim(vector: npt.ArrayLike) -> Array:
    """Turn vectors of shape (..., 3) from OpenSim's axes into those of REP-103.

    Parameters
    ----------
    vector
        Positions [m], forces [N], moments [N m] or any other vectors, shape (..., 3).

    Returns
    -------
    ndarray (..., 3)
        The same vectors in REP-103 axes, same unit.

    Raises
    ------
    HumanModelError
        If the last axis has not length 3.
    """
    return _vectors(vector) @ ROS_FROM_OPENSIM.T


def to_opensim(vector: npt.ArrayLike) -> Array:
    """Turn vectors of shape (..., 3) from REP-103 axes into OpenSim's."""
    return _vectors(vector) @ ROS_FROM_OPENSIM


def matrix_from_quaternion(quaternion: npt.ArrayLike) -> Array:
    """Rotation matrices (..., 3, 3) of quaternions (..., 4) xyzw, which are normalised first.

    Raises
    ------
    HumanModelError
        If the last axis has not length 4 or a quaternion has no length.
    """
    q = np.asarray(quaternion, dtype=np.float64)
    if q.ndim == 0 or q.shape[-1] != 4:
        raise HumanModelError(f'quaternion: last axis must have length 4, got shape {q.shape}')
    norm = np.linalg.norm(q, axis=-1, keepdims=True)
    if np.any(norm < 1e-9):
        raise HumanModelError('quaternion: length 0 is not a rotation')
    x, y, z, w = np.moveaxis(q / norm, -1, 0)
    matrix = np.empty((*q.shape[:-1], 3, 3))
    matrix[..., 0, 0] = 1 - 2 * (y * y + z * z)
    matrix[..., 0, 1] = 2 * (x * y - z * w)
    matrix[..., 0, 2] = 2 * (x * z + y * w)
    matrix[..., 1, 0] = 2 * (x * y + z * w)
    matrix[..., 1, 1] = 1 - 2 * (x * x + z * z)
    matrix[..., 1, 2] = 2 * (y * z - x * w)
    matrix[..., 2, 0] = 2 * (x * z - y * w)
    matrix[..., 2, 1] = 2 * (y * z + x * w)
    matrix[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return matrix


def quaternion_from_matrix(rotation: npt.ArrayLike) -> Array:
    """Quaternions (..., 4) xyzw with w >= 0 of rotation matrices (..., 3, 3).

    The largest of the four squared components is taken as the divisor (Shepperd 1978), so that
    half turns lose no digits.
    """
    r = _matrices(rotation)
    trace = np.trace(r, axis1=-2, axis2=-1)
    squared = np.stack(
        [
            1 + 2 * r[..., 0, 0] - trace,
            1 + 2 * r[..., 1, 1] - trace,
            1 + 2 * r[..., 2, 2] - trace,
            1 + trace,
        ],
        axis=-1,
    )
    products = np.empty((*r.shape[:-2], 4, 4))
    for i in range(4):
        products[..., i, i] = squared[..., i]
    for i, j in ((0, 1), (0, 2), (1, 2)):
        products[..., i, j] = products[..., j, i] = r[..., i, j] + r[..., j, i]
    for i, (a, b) in enumerate(((2, 1), (0, 2), (1, 0))):
        products[..., i, 3] = products[..., 3, i] = r[..., a, b] - r[..., b, a]
    best = np.argmax(squared, axis=-1)
    row = np.take_along_axis(products, best[..., None, None], axis=-2)[..., 0, :]
    quaternion = row / np.linalg.norm(row, axis=-1, keepdims=True)
    return np.asarray(np.where(quaternion[..., 3:] < 0, -quaternion, quaternion))
