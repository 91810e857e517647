# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which force plate stands under which foot, and which way its force points."""

from __future__ import annotations

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles
from lifting_recordings.recording import Plate, centre_of_pressure

# Below this a plate is taken as unloaded [N]; the COP of a light load is dominated by noise.
LOADED = 50.0
# The COP must come this near to a foot [m], and the other foot must be twice as far.
_FOOT_REACH = 0.15
_FOOT_RATIO = 2.0


def orient_plates(plates: tuple[Plate, ...]) -> tuple[tuple[Plate, ...], str]:
    """Return the plates as force of the ground on the person (up), in graph axes.

    Raises
    ------
    ConventionError
        Some plates push up and others down.
    """
    signs = {
        p.name: float(np.sign(np.median(p.force[np.argsort(-abs(p.force[:, 2]))][:50, 2])))
        for p in plates
    }
    if len(set(signs.values())) > 1:
        raise ConventionError(f'plate sign: the plates disagree on up and down: {signs}')
    if set(signs.values()) == {-1.0}:
        flipped = tuple(Plate(p.name, p.time, -p.force, -p.moment) for p in plates)
        return flipped, 'Plate sign: the file holds the force on the plate; sign turned.'
    return plates, 'Plate sign: the file holds the force of the ground on the person.'


def _distance_to_foot(point: Array, heel: Array, toe: Array) -> Array:
    along = toe - heel
    share = np.clip(
        np.sum((point - heel) * along, axis=1) / np.sum(along * along, axis=1), 0.0, 1.0
    )
    return np.asarray(np.linalg.norm(point - heel - share[:, None] * along, axis=1))


def _named(plates: tuple[Plate, ...], name: str) -> str:
    found = [p.name for p in plates if p.name == name or p.name.endswith(f'_{name}')]
    if len(found) != 1:
        raise ConventionError(
            f'plates: option names {name!r}; the file has {[p.name for p in plates]}'
        )
    return found[0]


def assign_plates(
    plates: tuple[Plate, ...],
    time: Array,
    markers: Array,
    roles: MarkerRoles,
    option: dict[str, str] | None,
) -> tuple[dict[str, list[Plate]], list[str]]:
    """Return the plates under each foot, from the distance of COP and foot markers.

    Parameters
    ----------
    plates : tuple of Plate
        In graph axes, force on the person.
    time : ndarray, shape (n,)
        Of the markers [s].
    markers : ndarray, shape (n, n_markers, 3)
        [m], graph axes.
    option : dict or None
        Plate name, or its last part ('1' of 'ground_force_1'), to 'right' or 'left'; used where
        given, refused where the COP contradicts it.

    Raises
    ------
    ConventionError
        The COP is near no foot or near both, a foot has no plate, or the option is contradicted.
    """
    feet: dict[str, list[Plate]] = {side: [] for side in SIDES}
    statements = []
    wishes = {_named(plates, name): side for name, side in (option or {}).items()}
    for plate in plates:
        loaded = plate.force[:, 2] > LOADED
        if not np.any(loaded):
            statements.append(f'Plate {plate.name}: never above {LOADED:g} N, left out.')
            continue
        stamps = plate.time[loaded]
        cop = centre_of_pressure(plate.force[loaded], plate.moment[loaded])[:, :2]
        distance = {}
        for side in SIDES:
            ends = []
            for role in ('heel', 'toe'):
                place = roles.require(markers, role, side)
                seen = np.isfinite(place[:, 0])
                ends.append(
                    np.stack(
                        [np.interp(stamps, time[seen], place[seen, k]) for k in range(2)], axis=1
                    )
                )
            distance[side] = float(np.median(_distance_to_foot(cop, *ends)))
        near = min(SIDES, key=lambda side: distance[side])
        far = SIDES[1 - SIDES.index(near)]
        told = ', '.join(f'{side} foot {distance[side] * 1e3:.0f} mm' for side in SIDES)
        clear = distance[near] < _FOOT_REACH and distance[far] > _FOOT_RATIO * distance[near]
        wanted = wishes.get(plate.name)
        if wanted is None and not clear:
            raise ConventionError(
                f'plate {plate.name!r}: its centre of pressure is near no foot or near both '
                f'({told}): give the option plates'
            )
        if wanted is not None and clear and wanted != near:
            raise ConventionError(
                f'plate {plate.name!r}: option says {wanted}, its centre of pressure says {near} '
                f'({told})'
            )
        side = wanted or near
        feet[side].append(plate)
        how = 'option' if wanted else 'centre of pressure'
        statements.append(f'Plate {plate.name}: {side} foot ({how}; {told}).')
    for side in SIDES:
        if not feet[side]:
            raise ConventionError(f'plates: no loaded plate under the {side} foot')
    return feet, statements
