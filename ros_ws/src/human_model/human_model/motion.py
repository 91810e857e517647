# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Blocks of body motion and lifts, the data that all packages exchange."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from human_model.exceptions import MotionError
from human_model.report import SolveReport
from human_model.typing import Array

SKELETONS = ('2d_10dof', '3d_40dof')

#: The shared points of the body [m], in this order; pairs are right, then left.
POINTS = (
    'pelvis',
    'l5_s1',
    'c7',
    'head',
    'shoulder_r',
    'shoulder_l',
    'elbow_r',
    'elbow_l',
    'wrist_r',
    'wrist_l',
    'hand_r',
    'hand_l',
    'hip_r',
    'hip_l',
    'knee_r',
    'knee_l',
    'ankle_r',
    'ankle_l',
    'heel_r',
    'heel_l',
    'mtp_r',
    'mtp_l',
    'toe_r',
    'toe_l',
)

#: The shared segment frames, in this order: REP-103 axes in the neutral standing posture.
FRAMES = ('pelvis', 'thorax', 'hand_r', 'hand_l', 'foot_r', 'foot_l')

_NAMES = ('coordinates', 'point_names', 'frame_names')
_TAIL = {
    'position': ('q',),
    'velocity': ('q',),
    'acceleration': ('q',),
    'points': ('p', 3),
    'frames': ('f', 4),
    'ground_force': (2, 3),
    'centre_of_pressure': (2, 3),
    'free_moment': (2, 3),
    'hand_force': (2, 3),
    'box_position': (3,),
}
#: So many values are summed by one thread; more may wait for several, longer than it takes.
_FEW = 1000
#: Arrays in which NaN means "none" (unloaded foot, no box).
_MAY_BE_NAN = ('centre_of_pressure', 'box_position')


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """A block of n >= 1 samples of one person's motion, forces on hands and feet included.

    Everything Cartesian is in the world frame (REP-103: x forward, y left, z up), SI units.
    Arrays are stored read-only.

    Attributes
    ----------
    time : ndarray (n,)
        Strictly increasing [s].
    skeleton : {'2d_10dof', '3d_40dof'}
    coordinates : tuple of str, n_q
        OpenSim names.
    position, velocity, acceleration : ndarray (n, n_q)
        rad or m, per s, per s^2.
    point_names : tuple of str, n_p
    points : ndarray (n, n_p, 3)
        m.
    frame_names : tuple of str, n_f
    frames : ndarray (n, n_f, 4)
        Unit quaternions xyzw, world <- segment.
    ground_force : ndarray (n, 2, 3)
        Force of the ground on the [right, left] foot [N].
    centre_of_pressure : ndarray (n, 2, 3)
        Centre of pressure [m], NaN when unloaded.
    free_moment : ndarray (n, 2, 3)
        Moment of the ground on the foot about the centre of pressure [N m].
    hand_force : ndarray (n, 2, 3)
        Force of the box on the [right, left] hand [N].
    box_position : ndarray (n, 3)
        Centre of the box [m], NaN if there is none.
    """

    time: Array
    skeleton: str
    coordinates: tuple[str, ...]
    position: Array
    velocity: Array
    acceleration: Array
    point_names: tuple[str, ...]
    points: Array
    frame_names: tuple[str, ...]
    frames: Array
    ground_force: Array
    centre_of_pressure: Array
    free_moment: Array
    hand_force: Array
    box_position: Array

    def __post_init__(self) -> None:
        """Check shapes and finiteness; freeze the arrays."""
        if self.skeleton not in SKELETONS:
            raise MotionError(
                f'motion.skeleton: one of {SKELETONS} is needed, got {self.skeleton!r}'
            )
        names = [_checked_names(field, tuple(getattr(self, field))) for field in _NAMES]
        time = _frozen('time', self.time)
        if time.ndim != 1 or time.size < 1:
            raise MotionError(f'motion.time: shape (n,), n >= 1 is needed, got {time.shape}')
        if not all_finite(time):
            raise MotionError('motion.time: not finite')
        if time.size > 1 and not np.all(np.diff(time) > 0):
            worst = int(np.argmin(np.diff(time)))
            raise MotionError(
                f'motion.time: not increasing from {time[worst]:.6f} s to '
                f'{time[worst + 1]:.6f} s (sample {worst + 1})'
            )
        arrays = {'time': time}
        for name, shape in _shapes(time.size, *map(len, names)).items():
            array = arrays[name] = _frozen(name, getattr(self, name))
            if array.shape != shape:
                raise MotionError(f'motion.{name}: shape {shape} is needed, got {array.shape}')
            if name not in _MAY_BE_NAN and not all_finite(array):
                sample = int(np.argwhere(~np.isfinite(array))[0][0])
                raise MotionError(f'motion.{name}: not finite in sample {sample}')
        length = _worst_length(arrays['frames'])
        if abs(length - 1.0) > 1e-3:
            raise MotionError(f'motion.frames: a quaternion of length {length:.4f} is no rotation')
        # All at once, past the frozen class's own __setattr__.
        self.__dict__.update(zip(_NAMES, names, strict=True), **arrays)

    def __len__(self) -> int:
        """Return the number of samples."""
        return int(self.time.size)

    def __getitem__(self, index: int | slice) -> 'BodyMotion':
        """Sub-block: ``motion[i:j]``, or one sample as a block of length 1."""
        if isinstance(index, (int, np.integer)):
            at = range(len(self))[index]
            index = slice(at, at + 1)
        if not isinstance(index, slice):
            raise MotionError(f'motion[...]: an integer or a slice is needed, got {index!r}')
        return self._with(**{name: getattr(self, name)[index] for name in ('time', *_TAIL)})

    def __iter__(self) -> Iterator['BodyMotion']:
        """Iterate over the samples as blocks of length 1."""
        return (self[i] for i in range(len(self)))

    def _with(self, **arrays: Array) -> 'BodyMotion':
        fields = {
            'skeleton': self.skeleton,
            'coordinates': self.coordinates,
            'point_names': self.point_names,
            'frame_names': self.frame_names,
        }
        return BodyMotion(**fields, **arrays)  # type: ignore[arg-type]

    def point(self, name: str) -> Array:
        """Trajectory (n, 3) of one point [m]."""
        return np.asarray(self.points[:, _index('point', self.point_names, name)])

    def frame(self, name: str) -> Array:
        """Quaternions (n, 4) xyzw of one segment frame."""
        return np.asarray(self.frames[:, _index('frame', self.frame_names, name)])

    def coordinate(self, name: str) -> Array:
        """Trajectory (n,) of one joint coordinate [rad or m]."""
        return np.asarray(self.position[:, _index('coordinate', self.coordinates, name)])

    def to_dict(self) -> dict[str, Any]:
        """Arrays and names by field, as `numpy.savez` takes them."""
        fields: dict[str, Any] = {name: getattr(self, name) for name in ('time', *_TAIL)}
        fields['skeleton'] = np.array(self.skeleton)
        for name in _NAMES:
            fields[name] = np.array(getattr(self, name), dtype=np.str_)
        return fields

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> 'BodyMotion':
        """Inverse of `to_dict`; a missing field is named.

        Raises
        ------
        MotionError
            If a field is missing or its shape is wrong.
        """
        values: dict[str, Any] = {}
        for name in ('time', 'skeleton', *_NAMES, *_TAIL):
            if name not in fields:
                raise MotionError(f'motion.{name}: missing')
            values[name] = fields[name]
        values['skeleton'] = str(np.asarray(values['skeleton']).item())
        for name in _NAMES:
            values[name] = tuple(str(item) for item in np.atleast_1d(values[name]))
        return cls(**values)


@dataclass(frozen=True, eq=False)
class Lift:
    """One lift, measured or predicted.

    Attributes
    ----------
    lift_id : str
        The same for the measured lift and its prediction.
    source : {'measured', 'predicted'}
    start, end : float
        Start and end of the lift [s] on the clock of ``motion.time``.
    box_mass : float
        kg.
    motion : BodyMotion
        Covers the lift; it may begin before and end after it.
    report : SolveReport
        Of the tracker or of the predictor.
    """

    lift_id: str
    source: str
    start: float
    end: float
    box_mass: float
    motion: BodyMotion
    report: SolveReport

    def __post_init__(self) -> None:
        """Check the window and the mass."""
        if not self.lift_id:
            raise MotionError('lift.lift_id: empty')
        if self.source not in ('measured', 'predicted'):
            raise MotionError(f'lift.source: measured or predicted is needed, got {self.source!r}')
        if not self.start < self.end:
            raise MotionError(f'lift.end: {self.end:g} s is not after lift.start {self.start:g} s')
        if not (np.isfinite(self.box_mass) and self.box_mass >= 0):
            raise MotionError(f'lift.box_mass: {self.box_mass} kg is no mass')

    def to_dict(self) -> dict[str, Any]:
        """Fields by name, as `numpy.savez` takes them; the motion's as ``motion.<name>``."""
        fields: dict[str, Any] = {
            name: np.array(getattr(self, name))
            for name in ('lift_id', 'source', 'start', 'end', 'box_mass')
        }
        fields['report'] = np.array(json.dumps(self.report.to_dict()))
        return fields | {f'motion.{name}': value for name, value in self.motion.to_dict().items()}

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> 'Lift':
        """Inverse of `to_dict`; a missing field is named."""
        for name in ('lift_id', 'source', 'start', 'end', 'box_mass', 'report'):
            if name not in fields:
                raise MotionError(f'lift.{name}: missing')
        prefix = 'motion.'
        motion = BodyMotion.from_dict(
            {name.removeprefix(prefix): fields[name] for name in fields if name.startswith(prefix)}
        )
        return cls(
            str(fields['lift_id']),
            str(fields['source']),
            float(fields['start']),
            float(fields['end']),
            float(fields['box_mass']),
            motion,
            SolveReport.from_dict(json.loads(str(fields['report']))),
        )

    @property
    def window(self) -> BodyMotion:
        """The samples from start to end."""
        first, last = np.searchsorted(self.motion.time, (self.start - 1e-9, self.end + 1e-9))
        if last <= first:
            raise MotionError(
                f'lift {self.lift_id}: no sample between {self.start:g} s and {self.end:g} s'
            )
        return self.motion[int(first) : int(last)]


def concatenate(blocks: Sequence[BodyMotion]) -> BodyMotion:
    """Join blocks of the same skeleton and names in time order.

    Raises
    ------
    MotionError
        If there is no block, or names or skeletons differ, or time does not increase.
    """
    if not blocks:
        raise MotionError('concatenate: no block')
    first = blocks[0]
    for block in blocks[1:]:
        for name in ('skeleton', *_NAMES):
            if getattr(block, name) != getattr(first, name):
                raise MotionError(f'concatenate: {name} differs between blocks')
    return first._with(
        **{
            name: np.concatenate([getattr(block, name) for block in blocks])
            for name in ('time', *_TAIL)
        }
    )


@lru_cache(maxsize=64)
def _checked_names(field: str, given: tuple[str, ...]) -> tuple[str, ...]:
    """Names as text; remembered, as every live sample has the same."""
    names = tuple(str(item) for item in given)
    if len(set(names)) != len(names):
        raise MotionError(f'motion.{field}: a name occurs twice in {names}')
    return names


@lru_cache(maxsize=64)
def _shapes(n: int, n_q: int, n_p: int, n_f: int) -> dict[str, tuple[int, ...]]:
    """Shape of each array of a block; remembered, as every live sample has the same."""
    sizes = {'q': n_q, 'p': n_p, 'f': n_f}
    return {
        name: (n, *(item if isinstance(item, int) else sizes[item] for item in tail))
        for name, tail in _TAIL.items()
    }


def _frozen(name: str, value: npt.ArrayLike) -> Array:
    try:
        # Always in rows: compiled functions are made for one layout.
        array = np.array(value, dtype=np.float64, order='C')
    except (TypeError, ValueError) as error:
        raise MotionError(f'motion.{name}: not an array of numbers ({error})') from error
    array.setflags(write=False)
    return array


def all_finite(array: Array) -> bool:
    """Return whether no value is NaN or infinite.

    A sum of squares is finite unless a value is not, or beyond 1e154: only then each is looked
    at. Of a live sample this takes a quarter of the time of looking at each.
    """
    if array.size <= _FEW and math.isfinite(np.vdot(array, array)):
        return True
    return bool(np.isfinite(array).all())


def _worst_length(quaternions: Array) -> float:
    """Length of the quaternion (..., 4) whose length is farthest from 1; 1 if there is none."""
    if quaternions.shape[0] == 1:
        # The arithmetic of arrays takes longer to begin than these six lengths altogether.
        lengths = (math.hypot(*one) for one in quaternions[0].tolist())
        return max(lengths, key=lambda length: abs(length - 1.0), default=1.0)
    norm = np.sqrt(np.einsum('...i,...i', quaternions, quaternions))
    return float(norm.flat[np.argmax(np.abs(norm - 1.0))]) if norm.size else 1.0


def _index(kind: str, names: tuple[str, ...], name: str) -> int:
    if name not in names:
        raise MotionError(f'motion: no {kind} named {name!r}; there are {", ".join(names)}')
    return names.index(name)
