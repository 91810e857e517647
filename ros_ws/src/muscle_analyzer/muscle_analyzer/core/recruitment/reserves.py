# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reserve actuators: what carries the torque that muscles of the model cannot.

The lifting full-body model has muscles of legs and trunk only.  Where its muscles drive a
coordinate the reserve is so weak that using it costs more than any muscle and is an alarm;
elsewhere (pelvis, neck, arms, toes) the reserve is the actuator.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable

from muscle_analyzer.core.exceptions import OptionError

#: Values of the column that distinguishes muscle-driven coordinates from others.
_DRIVERS = {'muscles': True, 'reserve': False}


@dataclass(frozen=True)
class Reserve:
    """Reserve of one coordinate.

    Attributes
    ----------
    coordinate
        Name.
    joint
        Joint whose net moment the coordinate's torque is part of.
    torque
        Torque at unit control [N m, or N for a translation].
    muscle_driven
        Whether muscles must balance the coordinate; if not, the reserve may.
    """

    coordinate: str
    joint: str
    torque: float
    muscle_driven: bool


def read_reserves(
    coordinate_names: tuple[str, ...], path: Traversable | None = None
) -> tuple[Reserve, ...]:
    """Read the reserves of the given coordinates.

    Parameters
    ----------
    coordinate_names
        Coordinates of the model.
    path
        CSV file with the columns ``coordinate, joint, torque, driven_by, source``; by default the
        table of this package.

    Raises
    ------
    OptionError
        If a coordinate has no row, or a value cannot be used; names file, row and value.
    """
    path = path or files('muscle_analyzer') / 'data' / 'reserves.csv'
    rows = {}
    for row in csv.DictReader(path.read_text(encoding='utf-8').splitlines()):
        where = f'{path}: {row["coordinate"]}'
        if row['driven_by'] not in _DRIVERS:
            raise OptionError(f'{where}: driven_by {row["driven_by"]!r} is none of {[*_DRIVERS]}')
        try:
            torque = float(row['torque'])
        except ValueError:
            raise OptionError(f'{where}: torque {row["torque"]!r} is not a number') from None
        rows[row['coordinate']] = Reserve(
            row['coordinate'], row['joint'], torque, _DRIVERS[row['driven_by']]
        )
    missing = [name for name in coordinate_names if name not in rows]
    if missing:
        raise OptionError(f'{path}: no reserve for the coordinates {", ".join(missing)}')
    return tuple(rows[name] for name in coordinate_names)
