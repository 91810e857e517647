# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ground reaction, centre of pressure and free moment from the wrenches of two force plates."""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from human_model.typing import Array
from motion_tracker.core.exceptions import ForcePlateError
from motion_tracker.core.forces import plate_kernel


@dataclass(frozen=True, eq=False)
class PlateGeometry:
    """Where a plate stands and how its wrench is expressed.

    Attributes
    ----------
    name : str
        For messages.
    origin : ndarray (3,)
        Point the plate's moment refers to, in the world [m].
    rotation : ndarray (3, 3)
        World from plate axes.
    surface_height : float
        Height of the surface the foot stands on, in the world [m].
    corners : ndarray (n, 3) or None
        Corners of the surface in the world [m], in order round it; None if not known.
    """

    name: str
    origin: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    surface_height: float = 0.0
    corners: Array | None = None

    def __post_init__(self) -> None:
        """Check shapes and that the rotation is one."""
        origin = np.array(self.origin, dtype=np.float64, order='C')
        rotation = np.array(self.rotation, dtype=np.float64, order='C')
        if origin.shape != (3,) or not np.all(np.isfinite(origin)):
            raise ForcePlateError(f'{self.name}.origin: three finite numbers needed, got {origin}')
        if (
            rotation.shape != (3, 3)
            or np.max(np.abs(rotation @ rotation.T - np.eye(3))) > 1e-6
            or np.linalg.det(rotation) < 0
        ):
            raise ForcePlateError(f'{self.name}.rotation: not a rotation matrix')
        if not np.isfinite(self.surface_height):
            raise ForcePlateError(f'{self.name}.surface_height: {self.surface_height} m')
        object.__setattr__(self, 'origin', origin)
        object.__setattr__(self, 'rotation', rotation)
        object.__setattr__(self, 'surface_height', float(self.surface_height))
        if self.corners is not None:
            corners = np.array(self.corners, dtype=np.float64)
            if corners.ndim != 2 or corners.shape[0] < 3 or corners.shape[1] != 3:
                raise ForcePlateError(
                    f'{self.name}.corners: shape (n >= 3, 3) is needed, got {corners.shape}'
                )
            object.__setattr__(self, 'corners', corners)


@dataclass(frozen=True, eq=False)
class GroundReaction:
    """Reaction of the ground on one foot, in the world; n samples.

    Attributes
    ----------
    force : ndarray (n, 3)
        Force of the ground on the person [N]; zero while unloaded.
    centre_of_pressure : ndarray (n, 3)
        Centre of pressure on the plate's surface [m]; NaN while unloaded.
    free_moment : ndarray (n, 3)
        Moment about the centre of pressure [N m]; only its vertical part is not zero.
    loaded : ndarray (n,) of bool
        Whether the vertical force exceeds the threshold.
    """

    force: Array
    centre_of_pressure: Array
    free_moment: Array
    loaded: npt.NDArray[np.bool_]


def ground_reaction(
    force: npt.ArrayLike, moment: npt.ArrayLike, plate: PlateGeometry, threshold: float
) -> GroundReaction:
    """Centre of pressure and free moment on the plate's surface.

    With F and M of the plate turned into the world and h the height of the surface above the
    plate's origin, the point (x, y, h) about which M has no horizontal part is
    ``x = (h Fx - My) / Fz``, ``y = (Mx + h Fy) / Fz``, and the free moment is
    ``Tz = Mz - x Fy + y Fx`` (Winter 2009, section 5.2.1, with the surface above the origin).

    Parameters
    ----------
    force, moment
        Force of the ground on the person [N] and moment about the plate's origin [N m] in the
        plate's axes, shape (n, 3).
    plate
        Geometry.
    threshold
        Vertical force [N] below which the foot counts as off the plate: force and moment are
        then zero and the centre of pressure is NaN.

    Raises
    ------
    ForcePlateError
        If the shapes do not agree or the threshold is not positive.
    """
    f = np.ascontiguousarray(np.atleast_2d(force), dtype=np.float64)
    m = np.ascontiguousarray(np.atleast_2d(moment), dtype=np.float64)
    if f.shape != m.shape or f.shape[-1] != 3:
        raise ForcePlateError(f'{plate.name}: force {f.shape} and moment {m.shape} do not agree')
    if not threshold > 0:
        raise ForcePlateError(f'{plate.name}: threshold must be positive, got {threshold} N')
    return GroundReaction(
        *plate_kernel.reaction(f, m, plate.rotation, plate.origin, plate.surface_height, threshold)
    )


def total_centre_of_pressure(force: Array, centre_of_pressure: Array) -> Array:
    """Centre of pressure (n, 3) [m] of all feet together.

    The mean of the feet's, weighted by their vertical forces; NaN where no foot is loaded.

    Parameters
    ----------
    force, centre_of_pressure
        Force [N] and centre of pressure [m] of each foot (n, feet, 3); zero and NaN while it is
        off its plate.
    """
    weight = force[..., 2:]
    moment = np.where(weight > 0, weight * centre_of_pressure, 0.0).sum(axis=1)
    total = weight.sum(axis=1)
    mean: Array = np.full_like(moment, np.nan)
    np.divide(moment, total, out=mean, where=total > 0)
    return mean
