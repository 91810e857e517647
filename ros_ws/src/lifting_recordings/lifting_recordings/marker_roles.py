# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which markers tell front from back, right from left and up from down.

Known names stand in `data/marker_roles.csv`; the subject file can name others.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError

ROLES = ('pelvis_front', 'pelvis_back', 'heel', 'toe', 'trunk')


@cache
def _known() -> tuple[tuple[str, str, str], ...]:
    path = Path(__file__).parent / 'data' / 'marker_roles.csv'
    with path.open(newline='', encoding='utf-8') as file:
        return tuple((r['role'], r['side'], r['marker']) for r in csv.DictReader(file))


class MarkerRoles:
    """Roles of the markers of one recording.

    Parameters
    ----------
    names : tuple of str
        Marker names of the recording.
    extra : Mapping of str to str, optional
        Marker name to 'role side', e.g. {'HEEL_R': 'heel right'}, from the subject file.

    Raises
    ------
    ConventionError
        `extra` names an unknown role or a marker that is not there.
    """

    def __init__(self, names: tuple[str, ...], extra: Mapping[str, str] | None = None) -> None:
        self._columns: dict[tuple[str, str], list[int]] = {}
        exact = {name: i for i, name in enumerate(names)}
        folded = {name.lower(): i for i, name in enumerate(names)}
        for role, side, marker in _known():
            column = exact.get(marker, folded.get(marker.lower()))
            if column is not None:
                self._add(role, side, column)
        for marker, text in (extra or {}).items():
            role, _, side = text.partition(' ')
            if role not in ROLES or side not in ('right', 'left', 'middle'):
                raise ConventionError(
                    f'subject file, recording.roles.{marker}: {text!r} is not one of '
                    f'{", ".join(ROLES)} followed by right, left or middle'
                )
            if marker not in exact:
                raise ConventionError(
                    f'subject file, recording.roles.{marker}: the recording has no such marker'
                )
            self._add(role, side, exact[marker])
        self.names = names

    def _add(self, role: str, side: str, column: int) -> None:
        columns = self._columns.setdefault((role, side), [])
        if column not in columns:
            columns.append(column)

    def columns(self, role: str, side: str | None = None) -> list[int]:
        """Return the marker columns with this role, of one side or of all."""
        sides = ('right', 'left', 'middle') if side is None else (side,)
        return [c for s in sides for c in self._columns.get((role, s), [])]

    def mean(self, positions: Array, role: str, side: str | None = None) -> Array | None:
        """Return the mean place of a role per frame, or None when no marker has it.

        Parameters
        ----------
        positions : ndarray, shape (n, n_markers, 3)
            Any units; NaN where not seen.

        Returns
        -------
        ndarray, shape (n, 3), or None
            NaN in frames where a marker of the role is missing.
        """
        columns = self.columns(role, side)
        return positions[:, columns].mean(axis=1) if columns else None

    def require(self, positions: Array, role: str, side: str | None = None) -> Array:
        """As `mean`, but a missing role is an error that says how to name it."""
        found = self.mean(positions, role, side)
        if found is None or not np.any(np.isfinite(found)):
            raise ConventionError(
                f'no marker with the role {role!r}{f" ({side})" if side else ""} among '
                f'{", ".join(self.names)}: name it in the subject file under recording.roles'
            )
        return found
