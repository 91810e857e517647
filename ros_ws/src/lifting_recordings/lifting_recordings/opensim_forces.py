# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force plates out of a MOT or STO file, and a TRC + MOT pair as one raw recording."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from human_model.opensim_storage import Storage
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.opensim_files import read_storage, read_trc
from lifting_recordings.recording import Plate, RawRecording

# Both namings in use: ground_force_1_vx / ground_force_1_mx and 1_ground_force_vx /
# 1_ground_torque_x (OpenSim user guide, "External loads").
_FORCE = re.compile(
    r'^(?P<before>.*?)(?P<kind>force)_?(?P<after>.*?)_?(?P<what>[vp])(?P<axis>[xyz])$'
)
_MOMENT = re.compile(
    r'^(?P<before>.*?)(?P<kind>force|torque|moment)_?(?P<after>.*?)_?(?P<what>m?)(?P<axis>[xyz])$'
)


def plates_from_storage(path: str | Path, table: Storage) -> tuple[Plate, ...]:
    """Collect the plates of a ground-reaction file.

    Parameters
    ----------
    path : str or Path
        For messages.
    table : Storage
        Columns '<plate>_vx .. vz' [N], '_px .. pz' [m], '_mx .. mz' or torque columns [N m].

    Returns
    -------
    tuple of Plate
        Moments about the origin: cop x force + free moment. Blocks that are zero throughout
        are left out.

    Raises
    ------
    FileFormatError
        No plates, an incomplete block, or a value that is not finite.
    """
    blocks: dict[str, dict[str, dict[str, str]]] = {}
    for label in table.columns:
        match = _FORCE.match(label) or _MOMENT.match(label)
        if match is None:
            continue
        plate = f'{match["before"]}force_{match["after"]}'.strip('_')
        what = match['what'] or 'm'
        blocks.setdefault(plate, {}).setdefault(what, {})[match['axis']] = label
    if not blocks:
        raise FileFormatError(path, 'holds no force plate columns (<plate>_vx, _px, _mx ...)')
    if not np.all(np.isfinite(table.values)):
        row, column = np.argwhere(~np.isfinite(table.values))[0]
        raise FileFormatError(
            path,
            f'value is {table.values[row, column]} at {table.time[row]:g} s',
            field=table.columns[column],
        )
    plates = []
    for name, parts in blocks.items():
        arrays = {}
        for what in 'vpm':
            for axis in 'xyz':
                if axis not in parts.get(what, {}):
                    raise FileFormatError(path, 'column is missing', field=f'{name}_{what}{axis}')
            arrays[what] = np.stack([table.column(parts[what][a]) for a in 'xyz'], axis=1)
        if not np.any(arrays['v']):
            continue
        moment = np.cross(arrays['p'], arrays['v']) + arrays['m']
        plates.append(Plate(name, table.time, arrays['v'], moment))
    return tuple(plates)


def read_trc_and_forces(
    markers: str | Path, forces: str | Path | None, prefix: str | None = None
) -> RawRecording:
    """Read a TRC file and the MOT or STO file that belongs to it.

    Parameters
    ----------
    markers, forces : str or Path
        The files.
    prefix : str, optional
        Prefix of the labels of the subject, where the file holds several.

    Raises
    ------
    FileFormatError
        Either file is damaged, or their time ranges do not overlap.
    """
    table = read_trc(markers, prefix)
    plates: tuple[Plate, ...] = ()
    notes = list(table.notes)
    if forces is not None:
        storage = read_storage(forces)
        plates = plates_from_storage(forces, storage)
        if storage.time[0] > table.time[-1] or storage.time[-1] < table.time[0]:
            raise FileFormatError(
                forces,
                f'{storage.time[0]:g} to {storage.time[-1]:g} s does not overlap the markers, '
                f'{table.time[0]:g} to {table.time[-1]:g} s',
                field='time',
            )
        names = ', '.join(plate.name for plate in plates)
        notes.append(f'{Path(forces).name}: {len(plates)} loaded plate blocks ({names})')
    return RawRecording(
        path=Path(markers),
        names=table.names,
        time=table.time,
        positions=table.positions,
        units=table.units,
        plates=plates,
        notes=tuple(notes),
    )
