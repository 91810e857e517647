# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a raw recording in its file's conventions to one in the graph's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings import conventions
from lifting_recordings.body_weight import check_weight
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles
from lifting_recordings.plate_assignment import (
    LOADS,
    Carried,
    assign_plates,
    by_name,
    orient_plates,
    select_plates,
)
from lifting_recordings.recording import Plate, RawRecording, Recording

# Body weight on the plates against the entered mass, as a share.
MASS_TOLERANCE = 0.05
# A surface of a plate that is further from the floor is said [m].
_FLUSH = 0.02


@dataclass(frozen=True)
class ConventionOptions:
    """What the user settles when the data do not.

    Attributes
    ----------
    units : str or None
        'm', 'cm' or 'mm'.
    vertical, facing : str or None
        Axis of the file, '+x' to '-z'.
    floor_height : float
        Height of the floor in the file's axes [m].
    plates : Mapping of str to str
        Plate name, or its last part ('1' of 'ground_force_1'), to 'right', 'left', 'both', 'box'
        or 'none'.
    mass_tolerance : float
        Allowed share between plate weight and entered mass.
    """

    units: str | None = None
    vertical: str | None = None
    facing: str | None = None
    floor_height: float = 0.0
    plates: Mapping[str, str] = field(default_factory=dict)
    mass_tolerance: float = MASS_TOLERANCE

    def __post_init__(self) -> None:
        """Refuse unknown axes, units and sides."""
        for name in ('vertical', 'facing'):
            value = getattr(self, name)
            if value is not None and value not in conventions.AXES:
                raise ConventionError(
                    f'--{name} {value}: {value!r} is not one of {", ".join(conventions.AXES)}'
                )
        if self.units is not None and self.units not in conventions.UNIT_METRES:
            raise ConventionError(f'--units {self.units}: {self.units!r} is not m, cm or mm')
        for name, load in self.plates.items():
            if load not in LOADS:
                raise ConventionError(
                    f'--plate {name}={load}: {load!r} is not one of {", ".join(LOADS)}'
                )


def align(
    raw: RawRecording,
    stature: float,
    carried: Carried,
    options: ConventionOptions,
    extra_roles: Mapping[str, str] | None = None,
) -> Recording:
    """Detect the conventions of a recording, state them and convert.

    Parameters
    ----------
    raw : RawRecording
        As read.
    stature : float
        Of the subject [m].
    carried : Carried
        Masses of person and box, and the markers of the box.
    options : ConventionOptions
        Settles what is ambiguous.
    extra_roles : Mapping of str to str, optional
        Roles of markers the importer does not know by name.

    Raises
    ------
    ConventionError
        Anything ambiguous or contradictory; the message names the file.
    """
    try:
        return _aligned(raw, stature, carried, options, extra_roles)
    except ConventionError as error:
        raise ConventionError(f'{raw.path}: {error}') from error


def _aligned(
    raw: RawRecording,
    stature: float,
    carried: Carried,
    options: ConventionOptions,
    extra_roles: Mapping[str, str] | None,
) -> Recording:
    said: list[str] = list(raw.notes)
    wishes = by_name(raw.plates, options.plates)
    loaded, texts = select_plates(raw.plates, wishes)
    said += texts
    roles = MarkerRoles(raw.names, extra_roles)
    scale, text = conventions.metres_per_unit(raw.positions, raw.units, stature, options.units)
    said.append(text)
    positions = raw.positions * scale
    up, text = conventions.vertical_axis(positions, loaded, roles, options.vertical)
    said.append(text)
    facing, text = conventions.facing_axis(positions, conventions.AXES[up], roles, options.facing)
    said.append(text)
    turn = conventions.rotation(up, facing)
    origin = np.array([0.0, 0.0, options.floor_height])
    markers = positions @ turn.T - origin
    said.append(conventions.check_sides(markers, roles))
    said.append(conventions.check_floor(markers, roles, options.floor_height))
    plates: dict[str, Plate] = {}
    if loaded:
        turned = tuple(_turn(plate, turn, origin) for plate in loaded)
        said += [text for plate in turned for text in _raised(plate)]
        upward, text = orient_plates(turned)
        said.append(text)
        feet, texts = assign_plates(upward, raw.time, markers, roles, wishes, carried)
        said += texts
        plates = {side: _sum(side, feet[side]) for side in SIDES if feet[side]}
    if plates:
        height = roles.mean(markers, 'pelvis_front')
        said.append(
            check_weight(
                plates,
                carried,
                options.mass_tolerance,
                raw.time,
                None if height is None else height[:, 2],
            )
        )
    else:
        said.append(
            f'No {"loaded plate under a foot" if raw.plates else "force plates"} in the recording.'
        )
    return Recording(
        path=raw.path,
        names=raw.names,
        time=raw.time,
        markers=markers,
        plates=plates,
        analog=raw.analog,
        statements=tuple(said),
    )


def _turn(plate: Plate, turn: Array, origin: Array) -> Plate:
    force = plate.force @ turn.T
    moment = plate.moment @ turn.T - np.cross(origin, force)
    corners = None if plate.corners is None else plate.corners @ turn.T - origin
    return Plate(plate.name, plate.time, force, moment, corners=corners)


def _raised(plate: Plate) -> list[str]:
    """Return a warning about a plate whose surface is not at the height of the floor."""
    height = 0.0 if plate.corners is None else float(plate.corners[:, 2].mean())
    if abs(height) <= _FLUSH:
        return []
    return [
        f'Warning: the surface of plate {plate.name} is {1e3 * height:+.0f} mm from the floor: '
        'give --floor-height if the floor is there, else the parameter plate_surface_height of '
        'the tracker.'
    ]


def _sum(side: str, plates: list[Plate]) -> Plate:
    first = plates[0]
    for plate in plates[1:]:
        if plate.time.shape != first.time.shape or not np.allclose(plate.time, first.time):
            raise ConventionError(
                f'plates {first.name!r} and {plate.name!r} under one foot have different stamps: '
                f'leave one out with --plate {plate.name}=none'
            )
    return Plate(
        side,
        first.time,
        np.sum([p.force for p in plates], axis=0),
        np.sum([p.moment for p in plates], axis=0),
    )
