# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What a force plate carries: a foot, both feet, the box or nothing; and the sign of its force."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from human_model.constants import GRAVITY, SIDES
from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles
from lifting_recordings.recording import Plate, centre_of_pressure

#: What can be on a plate.
BOTH, BOX, NONE = 'both', 'box', 'none'
LOADS = (*SIDES, BOTH, BOX, NONE)

# Below this a plate is taken as unloaded [N]; the COP of a light load is dominated by noise.
LOADED = 50.0
# A plate that is loaded for a shorter time in all is idle [s]: such loads are spikes.
_LOADED_SECONDS = 0.1
# The COP must come this near to a foot [m], and the other foot must be twice as far.
_FOOT_REACH = 0.15
_FOOT_RATIO = 2.0
# Share of the body weight above which a single plate between the feet carries both.
_BOTH_SHARE = 0.8
# Distance of the COP from the middle of the box markers [m], and deviation of the load from the
# weight of the box as a share, up to which a plate away from the feet carries the box.
_BOX_REACH = 0.35
_BOX_SHARE = 0.2


@dataclass(frozen=True)
class Carried:
    """What the plates may have to carry.

    Attributes
    ----------
    mass : float
        Of the person [kg].
    box_mass : float
        Of the box [kg]; 0 without one.
    box_markers : sequence of str
        Names of the markers on the box.
    """

    mass: float
    box_mass: float = 0.0
    box_markers: Sequence[str] = field(default=())


def by_name(plates: tuple[Plate, ...], option: Mapping[str, str]) -> dict[str, str]:
    """Return the option by whole name of the plate; '1' also names 'ground_force_1'.

    Raises
    ------
    ConventionError
        The option names no plate, or several.
    """
    wishes = {}
    for name, load in option.items():
        found = [p.name for p in plates if p.name == name or p.name.endswith(f'_{name}')]
        if len(found) != 1:
            raise ConventionError(
                f'--plate {name}={load}: the file has no plate of this name, it has '
                f'{[p.name for p in plates]}'
            )
        wishes[found[0]] = load
    return wishes


def select_plates(
    plates: tuple[Plate, ...], wishes: Mapping[str, str]
) -> tuple[tuple[Plate, ...], list[str]]:
    """Return the plates that carry something, with a statement for each of the others.

    Raises
    ------
    ConventionError
        A plate cannot be used and is not left out by option.
    """
    kept, statements = [], []
    for plate in plates:
        if wishes.get(plate.name) == NONE:
            statements.append(f'Plate {plate.name}: left out (option).')
            continue
        if plate.problem:
            raise ConventionError(
                f'plate {plate.name!r} cannot be used: {plate.problem}: leave it out with '
                f'--plate {plate.name}=none'
            )
        loaded = np.linalg.norm(plate.force, axis=1) > LOADED
        step = float(np.median(np.diff(plate.time))) if plate.time.size > 1 else 0.0
        if np.count_nonzero(loaded) * step < _LOADED_SECONDS:
            statements.append(
                f'Plate {plate.name}: above {LOADED:g} N for less than {_LOADED_SECONDS:g} s, '
                'left out.'
            )
            continue
        kept.append(plate)
    return tuple(kept), statements


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
        up = [name for name, sign in signs.items() if sign > 0.0]
        down = [name for name, sign in signs.items() if sign <= 0.0]
        raise ConventionError(
            f'plate sign: the plates disagree on up and down: {", ".join(up)} up, '
            f'{", ".join(down)} down: correct the file, or leave plates out with --plate NAME=none'
        )
    if set(signs.values()) == {-1.0}:
        flipped = tuple(
            Plate(p.name, p.time, -p.force, -p.moment, corners=p.corners) for p in plates
        )
        return flipped, 'Plate sign: the file holds the force on the plate; sign turned.'
    return plates, 'Plate sign: the file holds the force of the ground on the person.'


def assign_plates(
    plates: tuple[Plate, ...],
    time: Array,
    markers: Array,
    roles: MarkerRoles,
    wishes: Mapping[str, str],
    carried: Carried,
) -> tuple[dict[str, list[Plate]], list[str]]:
    """Return the plates under each foot, from the distance of COP and foot markers.

    A plate under both feet becomes two (see `share_between_feet`), one under the box is left out.

    Parameters
    ----------
    plates : tuple of Plate
        Loaded ones, in graph axes, force on the person.
    time : ndarray, shape (n,)
        Of the markers [s].
    markers : ndarray, shape (n, n_markers, 3)
        [m], graph axes.
    roles : MarkerRoles
        Of the markers.
    wishes : Mapping of str to str
        Plate name to one of `LOADS`; used where given, refused where the COP contradicts a foot.
    carried : Carried
        Person and box.

    Raises
    ------
    ConventionError
        The COP is near no foot or near both and nothing else explains the load, a foot has no
        plate, or the option is contradicted.
    """
    feet: dict[str, list[Plate]] = {side: [] for side in SIDES}
    statements = []
    for plate in plates:
        place = _Place(plate, time, markers, roles)
        near = place.foot()
        wanted = wishes.get(plate.name)
        if wanted in SIDES and near is not None and wanted != near:
            raise ConventionError(
                f'plate {plate.name!r}: --plate says {wanted}, its centre of pressure says {near} '
                f'({place})'
            )
        load, why = wanted or near, 'option' if wanted else 'centre of pressure'
        if load is None and place.carries_box(markers, roles, carried):
            load, why = BOX, 'its load stands away from the feet'
        if load is None and len(plates) == 1 and place.carries_both(carried.mass):
            load, why = BOTH, 'the only loaded plate carries the body weight'
        if load is None:
            raise ConventionError(
                f'plate {plate.name!r}: its centre of pressure is near no foot or near both '
                f'({place}), its load is {place.load:.0f} N: give '
                f'--plate {plate.name}=SIDE with right, left, both, box or none'
            )
        if load == BOX:
            statements.append(f'Plate {plate.name}: the box ({why}; {place}), left out.')
            continue
        if load == BOTH:
            for side, part in share_between_feet(plate, *place.middles()).items():
                feet[side].append(part)
            statements.append(
                f'Plate {plate.name}: both feet ({why}). Its force is shared between the feet by '
                'the lever rule: the torques of the legs are an estimate.'
            )
            continue
        feet[load].append(plate)
        statements.append(f'Plate {plate.name}: {load} foot ({why}; {place}).')
    missing = [side for side in SIDES if not feet[side]]
    if len(missing) == 1:
        names = ', '.join(f'--plate {p.name}=none' for p in plates)
        raise ConventionError(
            f'plates: no loaded plate under the {missing[0]} foot: give --plate NAME=both if both '
            f'feet stand on one plate, or import without plates by {names}'
        )
    return feet, statements


def share_between_feet(plate: Plate, right: Array, left: Array) -> dict[str, Plate]:
    """Return one plate per foot that together are the given one.

    The centre of pressure of the plate divides the way from one foot to the other, and the wrench
    is shared in proportion (lever rule, an engineering choice): each foot's share acts at the
    middle of the foot, moved by the rest of the way to the centre of pressure. The sum of force
    and moment is that of the plate at any time.

    Parameters
    ----------
    plate : Plate
        In graph axes, force on the person.
    right, left : ndarray, shape (n, 2)
        Middles of the feet at the stamps of the plate [m].
    """
    between = left - right
    length = np.maximum(np.sum(between * between, axis=1), 1e-9)
    loaded = plate.force[:, 2] > LOADED
    cop = np.zeros((len(plate.time), 3))
    cop[loaded] = centre_of_pressure(plate.force[loaded], plate.moment[loaded])
    part = np.clip(np.sum((cop[:, :2] - right) * between, axis=1) / length, 0.0, 1.0)
    part = np.where(loaded, part, 0.5)
    rest = cop[:, :2] - right - part[:, None] * between
    free = plate.moment - np.cross(cop, plate.force)
    found = {}
    for side, share, foot in (('right', 1.0 - part, right), ('left', part, left)):
        force = share[:, None] * plate.force
        at = np.zeros_like(cop)
        at[loaded, :2] = (foot + rest)[loaded]
        moment = np.cross(at, force) + share[:, None] * free
        found[side] = Plate(plate.name, plate.time, force, moment)
    return found


class _Place:
    """Where the load of a plate is against the feet.

    Parameters
    ----------
    plate : Plate
        Loaded.
    time, markers, roles
        See `assign_plates`.
    """

    def __init__(self, plate: Plate, time: Array, markers: Array, roles: MarkerRoles) -> None:
        loaded = plate.force[:, 2] > LOADED
        self._plate, self._time = plate, time
        self._stamps = plate.time[loaded]
        self._cop = centre_of_pressure(plate.force[loaded], plate.moment[loaded])[:, :2]
        self._ends = {
            side: [roles.require(markers, role, side) for role in ('heel', 'toe')]
            for side in SIDES
        }
        #: Median of the load [N].
        self.load = float(np.median(plate.force[loaded, 2]))
        self._distance = {
            side: float(np.median(_distance_to_line(self._cop, *(self._at(e) for e in ends))))
            for side, ends in self._ends.items()
        }

    def __str__(self) -> str:
        return ', '.join(f'{side} foot {self._distance[side] * 1e3:.0f} mm' for side in SIDES)

    def _at(self, place: Array, stamps: Array | None = None) -> Array:
        """Return a marker's x and y (n, 2) at the stamps of the loaded samples, or at others."""
        seen = np.isfinite(place[:, 0])
        stamps = self._stamps if stamps is None else stamps
        return np.stack(
            [np.interp(stamps, self._time[seen], place[seen, k]) for k in range(2)], axis=1
        )

    def foot(self) -> str | None:
        """Return the foot that is clearly nearest; None if there is none."""
        near = min(SIDES, key=lambda side: self._distance[side])
        far = SIDES[1 - SIDES.index(near)]
        clear = self._distance[near] < _FOOT_REACH
        return near if clear and self._distance[far] > _FOOT_RATIO * self._distance[near] else None

    def middles(self) -> tuple[Array, Array]:
        """Return the middles of the right and the left foot (n, 2) at all stamps of the plate."""
        right, left = (
            0.5 * sum((self._at(end, self._plate.time) for end in ends), start=np.zeros(1))
            for ends in (self._ends[side] for side in SIDES)
        )
        return right, left

    def carries_both(self, mass: float) -> bool:
        """Whether the load is the weight of a person, between the feet."""
        heels, toes = zip(*(self._ends[side] for side in SIDES), strict=True)
        middle = [0.5 * (self._at(h) + self._at(t)) for h, t in zip(heels, toes, strict=True)]
        away = float(np.median(_distance_to_line(self._cop, *middle)))
        return away < _FOOT_REACH and self.load > _BOTH_SHARE * mass * GRAVITY

    def carries_box(self, markers: Array, roles: MarkerRoles, carried: Carried) -> bool:
        """Whether the load is away from the feet, and that of the box or under its markers."""
        if carried.box_mass <= 0.0 or min(self._distance.values()) < _FOOT_REACH:
            return False
        if abs(self.load / (carried.box_mass * GRAVITY) - 1.0) < _BOX_SHARE:
            return True
        columns = [roles.names.index(n) for n in carried.box_markers if n in roles.names]
        if not columns:
            return False
        box = markers[:, columns].mean(axis=1)
        if not np.isfinite(box[:, 0]).any():
            return False
        away = np.linalg.norm(self._at(box) - self._cop, axis=1)
        return float(np.median(away)) < _BOX_REACH


def _distance_to_line(point: Array, start: Array, end: Array) -> Array:
    """Return the distance (n,) of points from the line between two others, all of shape (n, 2)."""
    along = end - start
    share = np.clip(
        np.sum((point - start) * along, axis=1) / np.maximum(np.sum(along * along, axis=1), 1e-12),
        0.0,
        1.0,
    )
    return np.asarray(np.linalg.norm(point - start - share[:, None] * along, axis=1))
