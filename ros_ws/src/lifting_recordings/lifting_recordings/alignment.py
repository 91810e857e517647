# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a raw recording in its file's conventions to one in the graph's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from human_model.constants import GRAVITY, SIDES
from human_model.typing import Array
from lifting_recordings import conventions
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles
from lifting_recordings.plate_assignment import assign_plates, orient_plates
from lifting_recordings.recording import Plate, RawRecording, Recording

# Body weight on the plates against the entered mass, as a share.
MASS_TOLERANCE = 0.05
_QUIET_SECONDS = 1.0
_QUIET_SPREAD = 0.02


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
        Plate name to 'right' or 'left'.
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
                    f'option {name}: {value!r} is not one of {", ".join(conventions.AXES)}'
                )
        if self.units is not None and self.units not in conventions.UNIT_METRES:
            raise ConventionError(f'option units: {self.units!r} is not m, cm or mm')
        for name, side in self.plates.items():
            if side not in SIDES:
                raise ConventionError(f'option plates: {name}: {side!r} is not right or left')


def align(
    raw: RawRecording,
    stature: float,
    mass: float,
    options: ConventionOptions,
    extra_roles: Mapping[str, str] | None = None,
) -> Recording:
    """Detect the conventions of `raw`, state them and convert.

    Parameters
    ----------
    raw : RawRecording
        As read.
    stature, mass : float
        Of the subject [m], [kg].
    options : ConventionOptions
        Settles what is ambiguous.
    extra_roles : Mapping of str to str, optional
        Roles of markers the importer does not know by name.

    Raises
    ------
    ConventionError
        Anything ambiguous or contradictory.
    """
    said: list[str] = list(raw.notes)
    roles = MarkerRoles(raw.names, extra_roles)
    scale, text = conventions.metres_per_unit(raw.positions, raw.units, stature, options.units)
    said.append(text)
    positions = raw.positions * scale
    up, text = conventions.vertical_axis(positions, raw.plates, roles, options.vertical)
    said.append(text)
    facing, text = conventions.facing_axis(positions, conventions.AXES[up], roles, options.facing)
    said.append(text)
    turn = conventions.rotation(up, facing)
    origin = np.array([0.0, 0.0, options.floor_height])
    markers = positions @ turn.T - origin
    said.append(conventions.check_sides(markers, roles))
    said.append(conventions.check_floor(markers, roles, options.floor_height))
    plates: dict[str, Plate] = {}
    if raw.plates:
        turned = tuple(_turn(plate, turn, origin) for plate in raw.plates)
        upward, text = orient_plates(turned)
        said.append(text)
        feet, texts = assign_plates(upward, raw.time, markers, roles, dict(options.plates))
        said += texts
        plates = {side: _sum(side, feet[side]) for side in SIDES}
        said.append(_check_weight(plates, mass, options.mass_tolerance))
    else:
        said.append('No force plates in the recording.')
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
    return Plate(plate.name, plate.time, force, moment)


def _sum(side: str, plates: list[Plate]) -> Plate:
    first = plates[0]
    for plate in plates[1:]:
        if plate.time.shape != first.time.shape or not np.allclose(plate.time, first.time):
            raise ConventionError(
                f'plates {first.name!r} and {plate.name!r} under one foot have different stamps'
            )
    return Plate(
        side,
        first.time,
        np.sum([p.force for p in plates], axis=0),
        np.sum([p.moment for p in plates], axis=0),
    )


def _check_weight(plates: dict[str, Plate], mass: float, tolerance: float) -> str:
    """Compare the weight in the first quiet second with the entered mass."""
    right, left = plates['right'], plates['left']
    total = right.force[:, 2] + np.interp(right.time, left.time, left.force[:, 2])
    step = float(np.median(np.diff(right.time)))
    window = max(2, round(_QUIET_SECONDS / step))
    weight, where = float(np.mean(total)), 'mean of the whole recording'
    for start in range(0, total.size - window + 1, max(1, window // 10)):
        part = total[start : start + window]
        if np.std(part) < _QUIET_SPREAD * np.mean(part):
            weight = float(np.mean(part))
            where = f'quiet standing at {right.time[start]:.2f} s'
            break
    weighed = weight / GRAVITY
    off = weighed / mass - 1.0
    if abs(off) > tolerance:
        raise ConventionError(
            f'body mass: the plates say {weighed:.1f} kg ({where}), the subject file '
            f'subject.mass says {mass:g} kg, {off * 100:+.1f} %: allowed are '
            f'{tolerance * 100:g} % (option mass_tolerance)'
        )
    return f'Body mass on the plates: {weighed:.1f} kg ({where}), {off * 100:+.1f} % of entered.'
