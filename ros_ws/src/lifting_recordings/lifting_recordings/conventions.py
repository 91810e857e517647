# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Detect and state units, axes and sides of a recording; refuse what is ambiguous.

Every detector returns its finding with one sentence for the report; a finding that the data
contradict, or do not settle, raises `ConventionError` naming the option that does.
"""

from __future__ import annotations

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles
from lifting_recordings.plate_assignment import LOADED
from lifting_recordings.recording import Plate

UNIT_METRES = {'m': 1.0, 'mm': 1e-3, 'cm': 1e-2}
AXES = {
    f'{"+" if sign > 0.0 else "-"}{"xyz"[i]}': sign * np.eye(3)[i]
    for sign in (1.0, -1.0)
    for i in range(3)
}
# A person's markers span between a deep squat and raised arms, as fractions of the stature:
# wide enough for every posture, narrow enough to tell mm, cm and m apart.
_EXTENT = (0.3, 1.6)
# An axis is named only if the direction is within 30 degrees of it.
_AXIS_COSINE = np.cos(np.radians(30.0))
# Left and right are exchanged if the left marker is so far to the right of the other [m]; feet of
# a side stance cross by less.
_CROSSED = 0.04
# Heels and toes of a standing person lie within this height above the floor [m].
_FLOOR_BAND = (-0.03, 0.20)


def _mean(values: Array) -> Array:
    """Return the mean (3,) over the frames in which all is seen."""
    seen = np.isfinite(values).all(axis=1)
    if not seen.any():
        raise ConventionError(
            'the markers of heels, toes, pelvis and trunk are never seen in one frame: name others'
            ' in the subject file under recording.roles'
        )
    return np.asarray(values[seen].mean(axis=0))


def _nearest_axis(direction: Array) -> tuple[str, float]:
    unit = direction / np.linalg.norm(direction)
    name = max(AXES, key=lambda key: float(AXES[key] @ unit))
    return name, float(AXES[name] @ unit)


def metres_per_unit(
    positions: Array, units: str, stature: float, option: str | None
) -> tuple[float, str]:
    """Return the factor to metres.

    Parameters
    ----------
    positions : ndarray, shape (n, n_markers, 3)
        In the file's units.
    units : str
        As stated by the file; '' if it states none.
    stature : float
        [m].
    option : str or None
        'm', 'cm' or 'mm' from the user, which takes the place of the file's statement.

    Raises
    ------
    ConventionError
        Unknown unit, or a unit that makes the person too small or too tall.
    """
    frames = positions[np.isfinite(positions).any(axis=(1, 2))]
    spans = np.nanmax(frames, axis=1) - np.nanmin(frames, axis=1)
    extent = float(np.median(spans.max(axis=1)))
    low, high = (factor * stature for factor in _EXTENT)
    fitting = [name for name, scale in UNIT_METRES.items() if low <= extent * scale <= high]
    stated = (option or units).strip().lower()
    if stated not in UNIT_METRES:
        hint = f'; the markers span {extent:g}, which fits {fitting}' if fitting else ''
        raise ConventionError(
            f'marker units: the file states {units!r}{hint}: give --units m, cm or mm'
        )
    if stated not in fitting:
        raise ConventionError(
            f'marker units: stated {stated!r}, but the markers span {extent:g} {stated} and the '
            f'subject is {stature:g} m tall'
            + (f' (it would fit {fitting[0]!r})' if fitting else '')
            + ': correct subject.stature or give --units'
        )
    return UNIT_METRES[stated], (
        f'Marker units: {stated} ({"option" if option else "stated in the file"}; the markers '
        f'span {extent * UNIT_METRES[stated]:.2f} m of a {stature:.2f} m person).'
    )


def vertical_axis(
    positions: Array, plates: tuple[Plate, ...], roles: MarkerRoles, option: str | None
) -> tuple[str, str]:
    """Return the upward axis of the file, from trunk above feet and from the plates' force.

    Raises
    ------
    ConventionError
        No axis is upward, or markers and plates (or the option) disagree.
    """
    feet = 0.5 * (roles.require(positions, 'heel') + roles.require(positions, 'toe'))
    upward = _mean(roles.require(positions, 'trunk') - feet)
    axis, cosine = _nearest_axis(upward)
    if cosine < _AXIS_COSINE and option is None:
        raise ConventionError(
            f'vertical axis: the trunk is over the feet along {np.round(upward, 3).tolist()}, '
            'which is near no axis: give --vertical (+x, -x, ... -z)'
        )
    if option is not None and option != axis:
        raise ConventionError(
            f'vertical axis: --vertical says {option}, but the trunk is over the feet along {axis}'
        )
    for plate in plates:
        force = _mean(plate.force)
        along, _ = _nearest_axis(force)
        if np.linalg.norm(force) > LOADED and along[1] != axis[1]:
            raise ConventionError(
                f'vertical axis: the markers stand along {axis}, but the mean force of plate '
                f'{plate.name!r} is {np.round(force, 1).tolist()} N: markers and plates are in '
                'different axes'
            )
    evidence = 'trunk markers above foot markers' + (', plate forces agree' if plates else '')
    return axis, f'Vertical axis of the file: {axis} ({evidence}).'


def facing_axis(
    positions: Array, up: Array, roles: MarkerRoles, option: str | None
) -> tuple[str, str]:
    """Return the axis the person faces: pelvis back to front and heel to toe must agree.

    Raises
    ------
    ConventionError
        The two disagree, or the direction is near no axis.
    """
    directions = _directions(positions, up, roles)
    if not directions:
        roles.require(positions, 'heel')
        roles.require(positions, 'toe')
    if len(directions) == 2:
        cosine = float(directions['feet'] @ directions['pelvis'])
        if cosine < (0.0 if option else _AXIS_COSINE):
            angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
            raise ConventionError(
                f'facing direction: toes and pelvis point {angle:.0f} degrees apart: correct the '
                'labels of heels, toes and pelvis (recording.rename in the subject file)'
                + ('' if option else ', or give --facing (+x, -x, ... -z) if the person stands so')
            )
    forward = np.sum(list(directions.values()), axis=0)
    axis, cosine = _nearest_axis(forward)
    if option is not None:
        if AXES[option] @ forward <= 0.0 or abs(AXES[option] @ up) > 0.0:
            raise ConventionError(
                f'facing direction: --facing says {option}, but the markers face {axis}'
            )
        return option, f'Facing direction in the file: {option} (option).'
    if cosine < _AXIS_COSINE:
        raise ConventionError(
            f'facing direction: the person faces {np.round(forward, 2).tolist()}, between two '
            'axes: give --facing (+x, -x, ... -z)'
        )
    angle = np.degrees(np.arccos(min(1.0, cosine)))
    return axis, (
        f'Facing direction in the file: {axis} (from {" and ".join(directions)}, '
        f'{angle:.0f} degrees off the axis).'
    )


def _directions(positions: Array, up: Array, roles: MarkerRoles) -> dict[str, Array]:
    """Return the horizontal unit vectors from heel to toe and from back to front of the pelvis."""
    found = {}
    feet = []
    for side in SIDES:
        heel, toe = (roles.mean(positions, role, side) for role in ('heel', 'toe'))
        if heel is not None and toe is not None:
            feet.append(_mean(toe - heel))
    if feet:
        found['feet'] = np.sum(feet, axis=0)
    back, front = (roles.centre(positions, role) for role in ('pelvis_back', 'pelvis_front'))
    if back is not None and front is not None:
        found['pelvis'] = _mean(front - back)
    level = {name: vector - (vector @ up) * up for name, vector in found.items()}
    return {name: vector / np.linalg.norm(vector) for name, vector in level.items()}


def rotation(up: str, facing: str) -> Array:
    """Return the matrix from the file's axes to x forward, y left, z up; shape (3, 3)."""
    return np.stack((AXES[facing], np.cross(AXES[up], AXES[facing]), AXES[up]))


def check_sides(markers: Array, roles: MarkerRoles) -> str:
    """Check that markers called right are on the right of the person in the median of the frames.

    The direction of the person is taken from the pelvis frame by frame: who turns, or stands with
    one foot before the other, is not taken for a person with exchanged labels.

    Raises
    ------
    ConventionError
        Naming the markers that lie on the wrong side.
    """
    wrong, checked, unclear = [], [], []
    leftward = _leftward(markers, roles)
    for role in ('heel', 'toe', 'pelvis_front', 'pelvis_back', 'trunk'):
        right, left = (roles.mean(markers, role, side) for side in SIDES)
        if right is None or left is None:
            continue
        across = np.sum((left - right) * leftward, axis=1)
        if not np.isfinite(across).any():
            continue
        apart = float(np.nanmedian(across))
        columns = roles.columns(role, 'right') + roles.columns(role, 'left')
        names = f'{" and ".join(roles.names[c] for c in columns)} ({apart * 1e3:+.0f} mm)'
        if apart < -_CROSSED:
            wrong.append(names)
        elif apart <= 0.0:
            unclear.append(names)
        else:
            checked.append(role)
    if wrong:
        raise ConventionError(
            'left and right: the marker called left lies to the right of the other for '
            + ', '.join(wrong)
            + ': labels are swapped; correct them in the subject file, for example '
            'recording: {rename: {RHEE: LHEE, LHEE: RHEE}}'
        )
    said = f'Left and right: labels agree with the facing direction ({", ".join(checked)}).'
    return said + (f' Not settled for {", ".join(unclear)}.' if unclear else '')


def _leftward(markers: Array, roles: MarkerRoles) -> Array:
    """Return the horizontal unit vector (n, 3) to the left of the person; y if not known."""
    leftward = np.tile((0.0, 1.0, 0.0), (len(markers), 1))
    back, front = (roles.centre(markers, role) for role in ('pelvis_back', 'pelvis_front'))
    if back is not None and front is not None:
        forward = (front - back)[:, :2]
        length = np.linalg.norm(forward, axis=1)
        seen = length > 0.0
        leftward[seen, :2] = (
            np.stack((-forward[seen, 1], forward[seen, 0]), axis=1) / length[seen, None]
        )
    return leftward


def check_floor(markers: Array, roles: MarkerRoles, height: float) -> str:
    """Check that the floor is at z = 0 after subtracting `height` [m].

    Raises
    ------
    ConventionError
        The foot markers are not just above the floor.
    """
    feet = np.concatenate(
        [roles.require(markers, role, side)[:, 2] for role in ('heel', 'toe') for side in SIDES]
    )
    lowest = float(np.nanmin(feet))
    if not _FLOOR_BAND[0] <= lowest <= _FLOOR_BAND[1]:
        raise ConventionError(
            f'floor: the lowest foot marker is at z = {lowest:.3f} m: give --floor-height, the '
            'height of the floor in the axes of the file [m]'
        )
    return f'Floor: z = 0 at {height:g} m in the file; lowest foot marker {lowest * 1e3:.0f} mm.'
