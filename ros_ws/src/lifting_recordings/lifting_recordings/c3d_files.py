# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""C3D files through ezc3d: points, force plates (see `c3d_plates`), EMG."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import ezc3d
import numpy as np

from lifting_recordings.c3d_plates import read_plates
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.raw_markers import select_labels
from lifting_recordings.recording import Analog, RawRecording

_MAGIC_BYTE = 0x50
_BLOCK = 512
# Processor byte of the parameter section: byte order, and where POINT:SCALE has its sign bit.
_PROCESSORS = {84: ('<', 15), 85: ('<', 13), 86: ('>', 12)}


def _text(value: Any) -> str:
    return str(value).strip()


def _parameter(c3d: Any, path: Path, group: str, name: str) -> Any:
    parameters = c3d['parameters']
    if group not in parameters or name not in parameters[group]:
        raise FileFormatError(path, 'is missing', field=f'{group}:{name}')
    return parameters[group][name]['value']


def read_c3d(
    path: str | Path, emg: tuple[str, ...] | None = None, prefix: str | None = None
) -> RawRecording:
    """Read a C3D file.

    Parameters
    ----------
    path : str or Path
        The file.
    emg : tuple of str, optional
        Analog channels to keep; without it all that do not belong to a plate.
    prefix : str, optional
        Prefix of the labels of the subject, where the file holds several.

    Returns
    -------
    RawRecording
        Points in POINT:UNITS; plates in N and N m about the origin of the file's axes.

    Raises
    ------
    FileFormatError
        Not a C3D file, no labelled points, an unknown unit or channel.
    """
    path = Path(path)
    head = path.read_bytes()[:2]
    if len(head) < 2 or head[1] != _MAGIC_BYTE:
        raise FileFormatError(path, 'is not a C3D file (second byte is not 0x50)')
    try:
        c3d = ezc3d.c3d(str(path))
    except Exception as error:  # ezc3d raises bare C++ exceptions of several kinds
        raise FileFormatError(path, f'ezc3d cannot read it: {error}') from error
    points = np.asarray(c3d['data']['points'], dtype=np.float64)
    if points.shape[1] == 0 or points.shape[2] == 0:
        raise FileFormatError(path, 'holds no points', field='POINT:USED')
    labels = select_labels(
        path, _point_labels(path, c3d, points.shape[1]), prefix, field='POINT:LABELS'
    )
    _check_size(path, points.shape[2])
    rate = float(c3d['header']['points']['frame_rate'])
    if not rate > 0.0:
        raise FileFormatError(path, f'is {rate}', field='POINT:RATE')
    time = np.arange(points.shape[2]) / rate
    plates, used = read_plates(path, c3d)
    units = c3d['parameters']['POINT'].get('UNITS', {'value': []})['value']
    return RawRecording(
        path=path,
        names=labels.names,
        time=time,
        positions=np.ascontiguousarray(points[:3, labels.columns].transpose(2, 1, 0)),
        units=_text(units[0]) if len(units) else '',
        plates=plates,
        analog=_analog(path, c3d, used, emg),
        notes=labels.notes,
    )


def _point_labels(path: Path, c3d: Any, points: int) -> list[str]:
    """Return a label for every point; more than 255 stand in LABELS2, LABELS3 and so on."""
    group = c3d['parameters']['POINT']
    labels = [_text(name) for name in _parameter(c3d, path, 'POINT', 'LABELS')]
    extra = 2
    while len(labels) < points and f'LABELS{extra}' in group:
        labels += [_text(name) for name in group[f'LABELS{extra}']['value']]
        extra += 1
    if len(labels) < points:
        raise FileFormatError(
            path, f'{points} points, but {len(labels)} labels', field='POINT:LABELS'
        )
    return labels[:points]


def _check_size(path: Path, frames: int) -> None:
    """Refuse a file that is shorter than its frames: ezc3d reads fewer without a word.

    Layout: C3D User Guide, "The header section": words 2 and 3 count the values of a frame, words
    4 and 5 number the first and last frame, bytes 12 to 15 hold the scale (negative: real
    numbers), word 9 is the first block of data.
    """
    data = path.read_bytes()
    parameters = (data[0] - 1) * _BLOCK
    processor = data[parameters + 3]
    if processor not in _PROCESSORS:
        raise FileFormatError(path, f'unknown processor type {processor}')
    order, sign_byte = _PROCESSORS[processor]
    points, analogs, first, last = struct.unpack_from(f'{order}HHHH', data, 2)
    frames = max(frames, last - first + 1)
    (first_block,) = struct.unpack_from(f'{order}H', data, 16)
    size = 4 if data[sign_byte] & 0x80 else 2
    needed = (first_block - 1) * _BLOCK + frames * (4 * points + analogs) * size
    if len(data) < needed:
        raise FileFormatError(
            path, f'is cut off: {frames} frames need {needed} bytes, the file has {len(data)}'
        )


def _analog_time(c3d: Any, n: int) -> Any:
    return np.arange(n) / float(c3d['header']['analogs']['frame_rate'])


def _analog(path: Path, c3d: Any, used: set[int], wanted: tuple[str, ...] | None) -> Analog | None:
    values = np.asarray(c3d['data']['analogs'], dtype=np.float64)
    if values.size == 0:
        if wanted:
            raise FileFormatError(path, f'holds no analog channel {wanted[0]!r}', field='ANALOG')
        return None
    values = values.reshape(values.shape[-2], values.shape[-1])
    labels = [_text(name) for name in _parameter(c3d, path, 'ANALOG', 'LABELS')]
    units = [_text(unit) for unit in _parameter(c3d, path, 'ANALOG', 'UNITS')]
    for name in wanted or ():
        if name not in labels:
            raise FileFormatError(path, f'no channel {name!r}', field='ANALOG:LABELS')
    keep = [
        i
        for i, label in enumerate(labels[: len(values)])
        if (i not in used if wanted is None else label in wanted)
    ]
    if not keep:
        return None
    return Analog(
        names=tuple(labels[i] for i in keep),
        units=tuple(units[i] if i < len(units) else '' for i in keep),
        time=_analog_time(c3d, values.shape[1]),
        values=np.ascontiguousarray(values[keep].T),
    )
