# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A skeleton: coordinates, limits, kinematics and inverse dynamics of one person's segments."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from human_model import tree_kinematics
from human_model.anthropometry import SegmentParameters
from human_model.constants import GRAVITY
from human_model.dh import Chain, load_chain
from human_model.exceptions import ChainError, MotionError
from human_model.frames import quaternion_from_matrix
from human_model.motion import FRAMES, POINTS, BodyMotion
from human_model.tables import Row, length_sum, read_table
from human_model.tree import TreeArrays, build_tree, segment_points
from human_model.typing import Array, IntArray

#: Shape of one sample of the forces of a motion, and what stands for one that is not given.
_LEFT_OUT: dict[str, tuple[tuple[int, ...], float]] = {
    'ground_force': ((2, 3), 0.0),
    'centre_of_pressure': ((2, 3), np.nan),
    'free_moment': ((2, 3), 0.0),
    'hand_force': ((2, 3), 0.0),
    'box_position': ((3,), np.nan),
}


def _rows(skeleton: str, table: str, columns: str) -> list[Row]:
    rows = read_table('human_model', table, f'skeleton {columns}')
    return [row for row in rows if row['skeleton'] == skeleton]


@dataclass(frozen=True, eq=False)
class ExternalForce:
    """A force on a segment, at a point of the world, with a free moment.

    Attributes
    ----------
    segment : str
    force : ndarray (3,)
        On the segment, world axes [N].
    point : ndarray (3,)
        Where it acts, world [m].
    moment : ndarray (3,)
        Free moment on the segment, world axes [N m].
    """

    segment: str
    force: npt.ArrayLike
    point: npt.ArrayLike
    moment: npt.ArrayLike = (0.0, 0.0, 0.0)


class Skeleton:
    """Kinematics and dynamics of a chain with one person's segment parameters.

    Coordinates have OpenSim's names, signs and meanings; everything Cartesian is REP-103. At
    ``q = 0`` the person stands upright with hanging arms, palms in, and the middle of the hips in
    the world's origin; `standing` has the soles on the ground.

    Parameters
    ----------
    name : {'2d_10dof', '3d_40dof'}
    parameters : SegmentParameters
        Of the segments of that skeleton.

    Raises
    ------
    ChainError
        If the segments are not those of the skeleton, or a table is inconsistent.
    """

    uses_compiled = True
    """Whether kinematics run in numba (single instants at 100 Hz) or in NumPy (whole motions)."""

    def __init__(self, name: str, parameters: SegmentParameters) -> None:
        self.name = name
        self.parameters = parameters
        self.chain: Chain = load_chain(name, parameters.lengths)
        self.tree: TreeArrays = build_tree(self.chain, parameters)
        self.coordinates: tuple[str, ...] = self.chain.coordinates
        self.segments: tuple[str, ...] = parameters.segments
        limits = {
            row['coordinate']: row.numbers('lower', 'upper')
            for row in _rows(name, 'joint_limits.csv', 'coordinate lower upper')
        }
        if set(limits) != set(self.coordinates):
            raise ChainError(f'joint_limits.csv: coordinates of {name} differ from its chain')
        #: Lower and upper limit (n_q, 2) of each coordinate [rad or m].
        self.limits: Array = np.array([limits[c] for c in self.coordinates])
        located = {
            row['point']: (
                row['segment'],
                np.array([length_sum(row[axis], parameters.lengths) for axis in 'xyz']),
            )
            for row in _rows(name, 'points.csv', 'point segment x y z')
        }
        frames = {
            row['frame']: row['segment'] for row in _rows(name, 'frames.csv', 'frame segment')
        }
        self._points = {point: located[point] for point in POINTS}
        self.point_segment, self.point_local = segment_points(self._points, self.segments)
        self.frame_segment = np.array([self.segments.index(frames[frame]) for frame in FRAMES])

    @property
    def total_mass(self) -> float:
        """Mass of all segments [kg]."""
        return self.parameters.total_mass

    def index(self, coordinate: str) -> int:
        """Index of a coordinate by name."""
        if coordinate not in self.coordinates:
            raise ChainError(f'{self.name}: no coordinate named {coordinate!r}')
        return self.coordinates.index(coordinate)

    @cached_property
    def standing_height(self) -> float:
        """Height of the hips over the soles in neutral standing [m]."""
        lengths = self.parameters.lengths
        return float(lengths['thigh'] + lengths['shank'] + lengths['ankle_height'])

    def standing(self) -> Array:
        """Coordinates (n_q,) of upright standing on the ground at the world's origin."""
        q = np.zeros(len(self.coordinates))
        q[self.index('pelvis_ty')] = self.standing_height
        return q

    def vector(self, values: Mapping[str, float], base: npt.ArrayLike | None = None) -> Array:
        """Coordinate vector (n_q,) from values by name; the others from base, or 0."""
        q = np.zeros(len(self.coordinates)) if base is None else self._vector('base', base).copy()
        for name, value in values.items():
            q[self.index(name)] = value
        return q

    def forward(self, q: npt.ArrayLike) -> Array:
        """Anatomical frames (n_s, 4, 4) of all segments, in the order of ``segments``."""
        rotation, origin = self._segment_frames(self._vector('q', q))
        frames = np.zeros((len(self.segments), 4, 4))
        frames[:, :3, :3] = rotation
        frames[:, :3, 3] = origin
        frames[:, 3, 3] = 1.0
        return frames

    def points(self, q: npt.ArrayLike) -> dict[str, Array]:
        """Positions (3,) [m] of the shared points by name."""
        position = self._positions(self._vector('q', q), self.point_segment, self.point_local)
        return dict(zip(POINTS, position, strict=True))

    def point_array(self, q: npt.ArrayLike) -> Array:
        """Positions (n, n_p, 3) [m] of the shared points for coordinates (n, n_q)."""
        return self.points_and_frames(q)[0]

    def points_and_frames(self, q: npt.ArrayLike) -> tuple[Array, Array]:
        """Return both: points (n, n_p, 3) [m] and frames (n, n_f, 4) for coordinates (n, n_q)."""
        block = self._block('q', q)
        if not self.uses_compiled:
            rotation, _ = tree_kinematics.segment_frames(self.tree, block)
            return (
                tree_kinematics.point_positions(
                    self.tree, block, self.point_segment, self.point_local
                ),
                quaternion_from_matrix(rotation[:, self.frame_segment]),
            )
        # Numba loads for long.
        from human_model.compiled_blocks import points_and_frames

        points, frames = points_and_frames(
            self.tree, block, self.point_segment, self.point_local, self.frame_segment
        )
        return points, frames

    def point_jacobian(self, q: npt.ArrayLike, segment: str, local: npt.ArrayLike) -> Array:
        """Jacobian (n, 3, n_q) of points (n, 3) [m] given in a segment's anatomical frame."""
        position = np.ascontiguousarray(np.atleast_2d(np.asarray(local, dtype=np.float64)))
        which = np.full(len(position), self.parameters.index(segment), dtype=np.int64)
        from human_model import compiled

        return compiled.points_and_jacobian(self.tree, self._vector('q', q), which, position)[1]

    def centre_of_mass(self, q: npt.ArrayLike) -> Array:
        """Centre of mass (3,) of the whole body [m]."""
        local = self.parameters.com
        which = np.arange(len(self.segments))
        position = self._positions(self._vector('q', q), which, local)
        return np.asarray(self.parameters.mass @ position / self.total_mass)

    def wrenches(self, external: Sequence[ExternalForce]) -> Array:
        """Force [N] and moment about the world's origin [N m] (n_s, 6) on each segment."""
        wrench = np.zeros((len(self.segments), 6))
        for load in external:
            force = np.asarray(load.force, dtype=np.float64)
            at = self.parameters.index(load.segment)
            wrench[at, :3] += force
            wrench[at, 3:] += np.cross(np.asarray(load.point, dtype=np.float64), force)
            wrench[at, 3:] += np.asarray(load.moment, dtype=np.float64)
        return wrench

    def inverse_dynamics(
        self,
        q: npt.ArrayLike,
        qd: npt.ArrayLike,
        qdd: npt.ArrayLike,
        external: Sequence[ExternalForce] = (),
        gravity: float = GRAVITY,
    ) -> Array:
        """Generalised forces (n_q,) [N m; N for translations] that make this motion.

        ``external`` are forces on segments, gravity not among them. The first coordinates' values
        are the residual at the pelvis: zero when the external forces explain the motion.
        """
        from human_model import compiled

        return compiled.newton_euler(
            self.tree,
            self._vector('q', q),
            self._vector('qd', qd),
            self._vector('qdd', qdd),
            self.wrenches(external),
            gravity,
        )

    def body_motion(
        self,
        time: npt.ArrayLike,
        q: npt.ArrayLike,
        qd: npt.ArrayLike,
        qdd: npt.ArrayLike,
        *,
        places: tuple[Array, Array] | None = None,
        **forces: Any,
    ) -> BodyMotion:
        """Motion block of coordinates (n, n_q) and their rates.

        ``places``: what `points_and_frames` gave for these coordinates, if it was asked already.
        ``forces``: ``ground_force``, ``centre_of_pressure``, ``free_moment``, ``hand_force``
        (n, 2, 3) and ``box_position`` (n, 3). Forces that are left out are zero; centre of
        pressure and box position are then NaN.
        """
        stamps = np.ascontiguousarray(time, dtype=np.float64)
        position = self._block('q', q)
        unknown = sorted(set(forces) - set(_LEFT_OUT))
        if unknown:
            raise MotionError(f'body_motion: unknown field {unknown[0]!r}')
        values = {
            name: np.full((len(stamps), *shape), fill)
            if forces.get(name) is None
            else forces[name]
            for name, (shape, fill) in _LEFT_OUT.items()
        }
        points, frames = self.points_and_frames(position) if places is None else places
        return BodyMotion(
            time=stamps,
            skeleton=self.name,
            coordinates=self.coordinates,
            position=position,
            velocity=self._block('qd', qd),
            acceleration=self._block('qdd', qdd),
            point_names=POINTS,
            points=points,
            frame_names=FRAMES,
            frames=frames,
            **values,
        )

    def _segment_frames(self, q: Array) -> tuple[Array, Array]:
        if not self.uses_compiled:
            rotation, origin = tree_kinematics.segment_frames(self.tree, q[None])
            return rotation[0], origin[0]
        # Numba loads for long.
        from human_model import compiled

        rotation, origin = compiled.segment_frames(self.tree, q)
        return rotation, origin

    def _positions(self, q: Array, segment: IntArray, local: Array) -> Array:
        if not self.uses_compiled:
            found = tree_kinematics.point_positions(self.tree, q[None], segment, local)
            return np.asarray(found[0])
        from human_model import compiled

        position: Array = compiled.point_positions(self.tree, q, segment, local)
        return position

    def _vector(self, name: str, value: npt.ArrayLike) -> Array:
        vector = np.ascontiguousarray(value, dtype=np.float64)
        if vector.shape != (len(self.coordinates),):
            raise MotionError(
                f'{self.name}: {name} must have shape ({len(self.coordinates)},), '
                f'got {vector.shape}'
            )
        if not np.all(np.isfinite(vector)):
            bad = self.coordinates[int(np.argmin(np.isfinite(vector)))]
            raise MotionError(f'{self.name}: {name}[{bad}] is not finite')
        return vector

    def _block(self, name: str, value: npt.ArrayLike) -> Array:
        block = np.ascontiguousarray(value, dtype=np.float64)
        if block.ndim == 1:
            block = block[None]
        if block.ndim != 2 or block.shape[1] != len(self.coordinates):
            raise MotionError(
                f'{self.name}: {name} must have shape (n, {len(self.coordinates)}), '
                f'got {block.shape}'
            )
        return block
