# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which markers tell front from back, right from left and up from down.

Known names stand in `data/marker_roles.csv`, in any spelling (see `marker_names`); the subject
file can name others.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_names import named_in

ROLES = ('pelvis_front', 'pelvis_back', 'heel', 'toe', 'trunk')
#: Role whose markers stand in for another where that has none.
_STAND_IN = {'toe': 'forefoot'}
#: Names that a message lists.
_LISTED = 12


def known_role(name: str) -> tuple[str, str] | None:
    """Return role and side of a marker by its name; None if it is not known."""
    return named_in('marker_roles.csv', 'role', name)


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
        for name, column in exact.items():
            if (found := known_role(name)) is not None:
                self._add(*found, column)
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
        sides = (*SIDES, 'middle') if side is None else (side,)
        stand_in = _STAND_IN.get(role, role)
        return [
            column
            for s in sides
            for column in self._columns.get((role, s)) or self._columns.get((stand_in, s), [])
        ]

    def mean(self, positions: Array, role: str, side: str | None = None) -> Array | None:
        """Return the mean place of a role per frame, or None when no marker has it.

        Parameters
        ----------
        positions : ndarray, shape (n, n_markers, 3)
            Any units; NaN where not seen.
        role : str
            One of `ROLES`.
        side : str, optional
            'right', 'left' or 'middle'; without it all.

        Returns
        -------
        ndarray, shape (n, 3), or None
            NaN in frames where a marker of the role is missing; a marker that is seen in less
            than half of the frames of the most seen one does not count.
        """
        columns = np.array(self.columns(role, side), dtype=int)
        if not columns.size:
            return None
        seen = np.isfinite(positions[:, columns, 0]).sum(axis=0)
        kept = columns[(seen > 0) & (2 * seen >= seen.max())]
        return positions[:, kept].mean(axis=1) if kept.size else None

    def centre(self, positions: Array, role: str) -> Array | None:
        """Return the place of a role in the sagittal plane per frame, from both sides or neither.

        Returns
        -------
        ndarray, shape (n, 3), or None
            Of the middle of right and left, else of the markers in the middle; None if only one
            side has a marker.
        """
        right, left = (self.mean(positions, role, side) for side in SIDES)
        if right is not None and left is not None:
            return 0.5 * (right + left)
        return self.mean(positions, role, 'middle')

    def require(self, positions: Array, role: str, side: str | None = None) -> Array:
        """As `mean`, but a missing role is an error that says how to name it."""
        found = self.mean(positions, role, side)
        if found is None or not np.any(np.isfinite(found)):
            which = f'{role} {side or "right"}'
            names = ', '.join(self.names[:_LISTED])
            more = f' and {len(self.names) - _LISTED} more' if len(self.names) > _LISTED else ''
            raise ConventionError(
                f'no marker with the role {role!r}{f" ({side})" if side else ""} is seen: name it '
                f'in the subject file, for example recording: {{roles: {{MARKER: {which}}}}}, '
                f'with MARKER one of {names}{more}'
            )
        return found
