# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reserve actuators: what carries the torque that muscles of the model cannot.

The lifting full-body model has muscles of legs and trunk only.  Where its muscles drive a
coordinate the reserve is so weak that using it costs more than any muscle and is an alarm;
elsewhere (pelvis, neck, arms, toes) the reserve is the actuator.
"""

from __future__ import annotations

from dataclasses import dataclass

from human_model.tables import Row, read_table
from muscle_analyzer.core.exceptions import OptionError

#: Columns of both tables.
COLUMNS = 'coordinate joint torque driven_by'
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
    limit
        Largest torque of the reserve that is not reported as weakness of the muscles [N m]; the
        torque at unit control if None.
    """

    coordinate: str
    joint: str
    torque: float
    muscle_driven: bool
    limit: float | None = None


def read_reserves(coordinate_names: tuple[str, ...], levels: bool = False) -> tuple[Reserve, ...]:
    """Read the reserves of the given coordinates of a model.

    Parameters
    ----------
    coordinate_names
    levels
        Whether each lumbar level is balanced: its coordinates then have the reserves of
        ``level_reserves.csv``.

    Raises
    ------
    OptionError
        If a coordinate has no row.
    """
    rows = {
        row['coordinate']: _reserve(row)
        for row in read_table('muscle_analyzer', 'reserves.csv', COLUMNS)
    }
    if levels:
        for row in read_table('muscle_analyzer', 'level_reserves.csv', f'{COLUMNS} limit'):
            rows[row['coordinate']] = _reserve(row, row.number('limit'))
    missing = [name for name in coordinate_names if name not in rows]
    if missing:
        raise OptionError(f'reserves.csv: no reserve for the coordinates {", ".join(missing)}')
    return tuple(rows[name] for name in coordinate_names)


def _reserve(row: Row, limit: float | None = None) -> Reserve:
    """Return the reserve of a row of a table."""
    driven = row.choice('driven_by', _DRIVERS)
    return Reserve(row['coordinate'], row['joint'], row.number('torque'), driven, limit)
