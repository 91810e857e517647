# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Wrenches of the force plates of a C3D file, types 1 to 4, from their analog channels.

Source: C3D User Guide, "The FORCE_PLATFORM group" (parameters TYPE, CORNERS, ORIGIN, CHANNEL and
CAL_MATRIX). In the axes of a plate

- type 1 holds the force, the centre of pressure on the surface and the free moment;
- type 2 holds the force and the moment about the origin of the transducers;
- type 3 holds four shear forces and four vertical ones, whose transducers stand at
  ``(+-a, +-b, az0)``, with ``ORIGIN = (a, b, az0)``;
- type 4 is type 2 after multiplication with CAL_MATRIX.

ORIGIN of types 2 and 4 is the vector from the origin of the transducers to the middle of the
surface. It points up and the plate's z axis down, so its z is negative; files that state it
positive have its sign reversed (the same rule as in ezc3d and Visual3D).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from human_model.typing import Array
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.recording import Plate

_GROUP = 'FORCE_PLATFORM'
_CHANNELS = {1: 6, 2: 6, 3: 8, 4: 6}
_FORCE_UNITS = {'N': 1.0, 'kN': 1e3}
_LENGTH_UNITS = {'m': 1.0, 'cm': 1e-2, 'mm': 1e-3}


def read_plates(path: Path, c3d: Any) -> tuple[tuple[Plate, ...], set[int]]:
    """Return the plates, moments about the origin of the file's axes, and their channels.

    Where the centre of pressure of the greatest loads is not on the plate, channels 4 to 6 are
    taken for moments in the other possible unit, or for moments at all (type 1), if that puts it
    on the plate.

    Parameters
    ----------
    path : Path
        For messages.
    c3d
        File read by ezc3d.

    Returns
    -------
    tuple of Plate, and set of int
        [N] and [N m]; a plate whose data cannot be used carries its `problem` and no samples.

    Raises
    ------
    FileFormatError
        A parameter of the group is missing or too short.
    """
    group = c3d['parameters'].get(_GROUP, {})
    used = _values(group, 'USED')
    count = int(used[0]) if used.size else 0
    if count <= 0:
        return (), set()
    analogs = np.asarray(c3d['data']['analogs'], dtype=np.float64)
    values = analogs.reshape(-1, analogs.shape[-1]) if analogs.size else np.zeros((0, 0))
    channel = _table(path, group, 'CHANNEL', 2)
    plates = []
    for i in range(count):
        try:
            plates.append(_plate(path, c3d, i, channel, values))
        except FileFormatError as error:
            none = np.zeros((0, 3))
            plates.append(Plate(f'plate_{i + 1}', none[:, 0], none, none, problem=str(error)))
    return tuple(plates), {int(c) - 1 for c in channel[:, :count].ravel() if c > 0}


def _values(group: Any, name: str) -> Array:
    """Return the numbers of a parameter in one row; empty if there is none."""
    value = group[name]['value'] if name in group else []
    return np.asarray(value, dtype=np.float64).ravel(order='F')


def _table(path: Path, group: Any, name: str, dimensions: int) -> Array:
    """Return the numbers of a parameter with at least so many dimensions, the last the plates."""
    if name not in group or not np.size(group[name]['value']):
        raise FileFormatError(path, 'is missing', field=f'{_GROUP}:{name}')
    value = np.asarray(group[name]['value'], dtype=np.float64)
    return value.reshape((*value.shape, *(1,) * (dimensions - value.ndim)))


def _short(path: Path, name: str, count: int, found: int) -> FileFormatError:
    return FileFormatError(
        path, f'{count} plates are in use, it describes {found}', field=f'{_GROUP}:{name}'
    )


def _plate(path: Path, c3d: Any, i: int, channels: Array, values: Array) -> Plate:
    """Return plate number `i`."""
    group = c3d['parameters'][_GROUP]
    kinds = _values(group, 'TYPE')
    if kinds.size <= i:
        raise _short(path, 'TYPE', i + 1, kinds.size)
    kind = int(kinds[i])
    if kind not in _CHANNELS:
        known = ', '.join(map(str, _CHANNELS))
        raise FileFormatError(path, f'is {kind}; types {known} are read', field=f'{_GROUP}:TYPE')
    if channels.shape[1] <= i:
        raise _short(path, 'CHANNEL', i + 1, channels.shape[1])
    rows = channels[: _CHANNELS[kind], i].astype(int) - 1
    if len(rows) < _CHANNELS[kind] or rows.min() < 0 or rows.max() >= len(values):
        raise FileFormatError(
            path,
            f'is {(rows + 1).tolist()}; type {kind} needs {_CHANNELS[kind]} of the '
            f'{len(values)} channels',
            field=f'{_GROUP}:CHANNEL',
        )
    if not np.isfinite(values[rows]).all():
        raise FileFormatError(path, 'holds NaN', field=f'{_GROUP}, plate {i + 1}')
    length = _length(path, c3d)
    corners, origin = (length * part for part in _place(path, c3d, i))
    axes = _axes(corners)
    if not np.isfinite(axes).all():
        raise FileFormatError(
            path, f'{corners.tolist()} m is no rectangle', field=f'{_GROUP}:CORNERS'
        )
    signals = values[rows].T
    force_scale, moment_scales = _scales(path, c3d, rows)
    if kind == 4:
        signals = signals @ _calibration(path, c3d, i).T
    reach = max(np.linalg.norm(corners[0] - corners[k]) for k in (1, 3))
    wrenches = []
    for scale in moment_scales:
        if kind == 1:
            wrenches.append(_type_1(signals, force_scale, scale, length))
        if kind == 3:
            wrenches.append(_type_3(signals, force_scale, origin))
        else:
            wrenches.append(_type_2(signals, force_scale, scale, origin))
    force, middle = next((w for w in wrenches if _arm(*w) < reach), wrenches[0])
    force, moment = force @ axes.T, middle @ axes.T
    moment = moment + np.cross(corners.mean(axis=0), force)
    time = np.arange(len(force)) / float(c3d['header']['analogs']['frame_rate'])
    return Plate(f'plate_{i + 1}', time, force, moment, corners=corners)


def _arm(force: Array, moment: Array) -> float:
    """Return how far from the middle of the plate its greatest loads act [m]."""
    last = np.argsort(abs(force[:, 2]))[-50:]
    load = np.maximum(abs(force[last, 2]), 1e-9)
    return float(np.median(np.linalg.norm(moment[last, :2], axis=1) / load))


def _type_1(values: Array, force_scale: float, moment_scale: float, length: float) -> Any:
    """Force, and moment about the middle of the surface, from COP and free moment."""
    force = values[:, :3] * force_scale
    zero = np.zeros(len(values))
    cop = np.stack((values[:, 3] * length, values[:, 4] * length, zero), axis=1)
    free = np.stack((zero, zero, values[:, 5] * moment_scale), axis=1)
    return force, np.cross(cop, force) + free


def _type_2(values: Array, force_scale: float, moment_scale: float, origin: Array) -> Any:
    """Force, and moment about the middle of the surface, from those of the transducers."""
    force = values[:, :3] * force_scale
    # M about the middle = M about the transducers' origin - origin x F.
    down = -origin if origin[2] > 0.0 else origin
    return force, values[:, 3:] * moment_scale + np.cross(force, down)


def _type_3(values: Array, force_scale: float, origin: Array) -> Any:
    """Force, and moment about the middle of the surface, from eight channels."""
    x12, x34, y14, y23, z1, z2, z3, z4 = (values * force_scale).T
    a, b = np.abs(origin[:2])
    down = np.array([0.0, 0.0, -abs(origin[2])])
    force = np.stack((x12 + x34, y14 + y23, z1 + z2 + z3 + z4), axis=1)
    moment = np.stack(
        (b * (z1 + z2 - z3 - z4), a * (z2 + z3 - z1 - z4), b * (x34 - x12) + a * (y14 - y23)),
        axis=1,
    )
    return force, moment + np.cross(force, down)


def _axes(corners: Array) -> Array:
    """Return the axes of a plate as columns: x from corner 2 to 1, y from corner 4 to 1."""
    x, y = corners[0] - corners[1], corners[0] - corners[3]
    z = np.cross(x, y)
    y = np.cross(z, x)
    with np.errstate(invalid='ignore', divide='ignore'):
        return np.stack([v / np.linalg.norm(v) for v in (x, y, z)], axis=1)


def _place(path: Path, c3d: Any, i: int) -> tuple[Array, Array]:
    """Return corners (4, 3) and origin (3,) of plate `i` in the file's unit."""
    group = c3d['parameters'][_GROUP]
    corners, origin = _values(group, 'CORNERS'), _values(group, 'ORIGIN')
    for name, values, size in (('CORNERS', corners, 12), ('ORIGIN', origin, 3)):
        if values.size < size * (i + 1):
            raise _short(path, name, i + 1, values.size // size)
    return corners[12 * i :][:12].reshape(4, 3), origin[3 * i :][:3]


def _calibration(path: Path, c3d: Any, i: int) -> Array:
    """Return CAL_MATRIX (6, 6) of plate `i`; the identity if the parameter is empty."""
    group = c3d['parameters'][_GROUP]
    if not _values(group, 'CAL_MATRIX').size:
        return np.eye(6)
    table = _table(path, group, 'CAL_MATRIX', 3)
    if min(table.shape[:2]) < 6 or table.shape[2] <= i:
        raise FileFormatError(
            path, f'is of shape {table.shape}, plate {i + 1} needs 6 x 6', field='CAL_MATRIX'
        )
    matrix: Array = table[:6, :6, i]
    return matrix


def _length(path: Path, c3d: Any) -> float:
    """Return [m] of the unit of CORNERS and ORIGIN, that of the points; metres if not stated."""
    unit = _first_text(c3d, 'POINT', 'UNITS') or 'm'
    if unit not in _LENGTH_UNITS:
        raise FileFormatError(
            path, f'unknown unit {unit!r}, known are m, cm and mm', field='POINT:UNITS'
        )
    return _LENGTH_UNITS[unit]


def _scales(path: Path, c3d: Any, rows: Array) -> tuple[float, tuple[float, ...]]:
    """Return [N] and the possible [N m] of a unit of the channels, the likelier first.

    ANALOG:UNITS states them where these are units of force and moment; else FORCE_PLATFORM:UNITS
    and POINT:UNITS do, else they are N and N times the unit of length.
    """
    analog = c3d['parameters'].get('ANALOG', {})
    units = [str(u).strip() for u in analog['UNITS']['value']] if 'UNITS' in analog else []
    stated = [units[row] for row in rows if row < len(units)] or ['']
    force_unit = _first_text(c3d, _GROUP, 'UNITS') or 'N'
    if force_unit not in _FORCE_UNITS:
        raise FileFormatError(
            path, f'unknown unit {force_unit!r}, known are N and kN', field=f'{_GROUP}:UNITS'
        )
    moments = {
        (f + m).lower(): f_scale * m_scale
        for f, f_scale in _FORCE_UNITS.items()
        for m, m_scale in _LENGTH_UNITS.items()
    }
    usual = _FORCE_UNITS[force_unit] * _length(path, c3d)
    last = stated[-1].lower().replace('*', '').replace('.', '').replace(' ', '')
    force = _FORCE_UNITS.get(stated[0], _FORCE_UNITS[force_unit])
    return force, tuple(dict.fromkeys((moments.get(last, usual), usual)))


def _first_text(c3d: Any, group: str, name: str) -> str:
    parameters = c3d['parameters'].get(group, {})
    value = parameters[name]['value'] if name in parameters else []
    return str(value[0]).strip() if len(value) else ''
