# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A recording between its file and the bag: raw in the file's conventions, then in the graph's."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from human_model.typing import Array


@dataclass(frozen=True)
class Plate:
    """Wrench of one force plate.

    Attributes
    ----------
    name : str
        As in the file, e.g. 'ground_force_1'.
    time : ndarray, shape (n,)
        Seconds on the clock of the markers.
    force : ndarray, shape (n, 3)
        [N].
    moment : ndarray, shape (n, 3)
        [N m] about the origin of the axes `force` is given in.
    corners : ndarray, shape (4, 3), or None
        Of the surface [m], where the file states them.
    problem : str
        Why the plate cannot be used; it has no samples then.
    """

    name: str
    time: Array
    force: Array
    moment: Array
    corners: Array | None = None
    problem: str = ''


@dataclass(frozen=True)
class Analog:
    """Analog channels other than the plates (EMG).

    Attributes
    ----------
    names, units : tuple of str
        One per channel.
    time : ndarray, shape (n,)
        Seconds on the clock of the markers.
    values : ndarray, shape (n, n_channels)
        In `units`.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    time: Array
    values: Array


@dataclass(frozen=True)
class RawRecording:
    """What a file holds, in the file's axes.

    Attributes
    ----------
    path : Path
        Marker file, for messages.
    names : tuple of str
        Marker names.
    time : ndarray, shape (n,)
        Seconds.
    positions : ndarray, shape (n, n_markers, 3)
        In `units`; NaN where not seen.
    units : str
        As stated in the file; '' if not stated.
    plates : tuple of Plate
        Forces [N] and moments [N m] about the origin, in the file's axes; the sign is not yet
        settled (force on the person or on the plate).
    analog : Analog or None
        EMG.
    notes : tuple of str
        What the reader found worth saying.
    """

    path: Path
    names: tuple[str, ...]
    time: Array
    positions: Array
    units: str
    plates: tuple[Plate, ...] = ()
    analog: Analog | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Recording:
    """The same in the graph's conventions: SI, x forward, y left, z up, force on the person.

    Attributes
    ----------
    path : Path
        Marker file.
    names : tuple of str
        Marker names.
    time : ndarray, shape (n,)
        Seconds.
    markers : ndarray, shape (n, n_markers, 3)
        [m]; NaN where not seen.
    plates : dict
        'right' and 'left' to Plate, moments about the laboratory origin.
    analog : Analog or None
        EMG.
    statements : tuple of str
        One sentence per detected convention.
    """

    path: Path
    names: tuple[str, ...]
    time: Array
    markers: Array
    plates: dict[str, Plate]
    analog: Analog | None = None
    statements: tuple[str, ...] = field(default=())


def centre_of_pressure(force: Array, moment: Array) -> Array:
    """Return where the wrench meets the floor z = 0 without horizontal moment.

    Parameters
    ----------
    force, moment : ndarray, shape (n, 3)
        [N] and [N m] about the origin, z up.

    Returns
    -------
    ndarray, shape (n, 3)
        [m]; NaN where the vertical force is zero.
    """
    vertical = np.where(force[:, 2] == 0.0, np.nan, force[:, 2])
    return np.stack(
        (-moment[:, 1] / vertical, moment[:, 0] / vertical, np.zeros(len(force))), axis=1
    )
