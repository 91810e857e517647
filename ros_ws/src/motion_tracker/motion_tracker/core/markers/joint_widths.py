# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Landmarks that a static trial lacks: medial ones from joint widths, both PSIS from SACR.

Plug-in Gait has no medial markers: the centre of knee, ankle and elbow is half the width of the
joint, plus the radius of the marker, away from the lateral marker (Davis et al. 1991, Hum Mov Sci
10:575). Without a measured width it is half the distance of the two landmarks in the marker set,
scaled to the person. The direction is that of the hips across the body, at right angles to the
limb: in the static trial of squats_bodyweight, whose medial markers were left out, the centres are
within 8 mm (knee), 19 mm (ankle) and 17 mm (elbow) of those with medial markers; those by the
wand markers of Plug-in Gait are within 8 to 78 mm (knee).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from motion_tracker.core.exceptions import CalibrationError
from motion_tracker.core.markers.joint_centres import JointDefinition
from motion_tracker.core.markers.marker_set import MarkerSet

#: Joints whose width can replace the medial marker, with the joint at the other end of the limb.
OTHER_END = {'knee': 'ankle', 'ankle': 'knee', 'elbow': 'shoulder'}

#: Radius of a marker of 14 mm, the default of Plug-in Gait [m].
MARKER_RADIUS = 0.007

#: Cosine between limb and hip axis beyond which the limb does not hang or stand.
_ABDUCTED = 0.7

_SACRUM = 'SACR'


@dataclass(frozen=True)
class Completed:
    """Landmarks of a static trial with those that were derived.

    Attributes
    ----------
    markers : mapping of str to ndarray (3,)
        World [m].
    statements : tuple of str
        For the report.
    """

    markers: Mapping[str, Array]
    statements: tuple[str, ...]


def completed(
    marker_set: MarkerSet,
    definitions: tuple[JointDefinition, ...],
    markers: Mapping[str, Array],
    lengths: Mapping[str, float],
    widths: Mapping[str, float],
) -> Completed:
    """Return the landmarks with those that the definitions need and the trial lacks.

    Parameters
    ----------
    marker_set : MarkerSet
        Set the markers belong to.
    definitions : tuple of JointDefinition
        Of the set; the first marker of a midpoint is the lateral one.
    markers : mapping of str to ndarray (3,)
        Mean positions in the trial, world [m].
    lengths : mapping of str to float
        Segment lengths of the person from anthropometry [m].
    widths : mapping of str to float
        Measured widths of knee, ankle and elbow, without markers [m].

    Raises
    ------
    CalibrationError
        If neither a width nor the marker set gives the way to the centre, or the arms are not
        down.
    """
    found: dict[str, Array] = dict(markers)
    statements: list[str] = []
    by_joint = {definition.joint: definition for definition in definitions}
    _add_spines(by_joint, found, statements)
    leftward = _leftward(by_joint, found)
    placed = marker_set.positions(lengths)
    for joint, definition in by_joint.items():
        kind, side = joint.rsplit('_', 1)
        if definition.method != 'midpoint' or kind not in OTHER_END or leftward is None:
            continue
        lateral, medial = definition.markers
        other = by_joint.get(f'{OTHER_END[kind]}_{side}')
        if medial in found or lateral not in found or other is None:
            continue
        if other.markers[0] not in found:
            continue
        if kind in widths:
            half, source = widths[kind] / 2 + MARKER_RADIUS, 'width in the subject file'
        elif lateral in placed and medial in placed:
            half = float(np.linalg.norm(placed[lateral] - placed[medial])) / 2
            source = f'distance of the landmarks in {marker_set.name}, scaled to the person'
        else:
            raise CalibrationError(
                f'static trial: marker {medial!r} is missing, and the width of the {kind} is not '
                f'known: write subject.joint_widths: {{{kind}: WIDTH}} [m] in the subject file'
            )
        inward = leftward if side == 'r' else -leftward
        limb = found[other.markers[0]] - found[lateral]
        limb = limb / np.linalg.norm(limb)
        if abs(limb @ inward) > _ABDUCTED:
            raise CalibrationError(
                f'static trial: marker {medial!r} is missing, and the {kind} is not beside the '
                'body: record the static trial with the arms down'
            )
        inward = inward - (inward @ limb) * limb
        found[medial] = found[lateral] + 2 * half * inward / np.linalg.norm(inward)
        statements.append(
            f'{joint}: no marker {medial}; centre {1000 * half:.0f} mm inward of {lateral} '
            f'({source})'
        )
    return Completed(found, tuple(statements))


def _add_spines(
    by_joint: Mapping[str, JointDefinition], found: dict[str, Array], statements: list[str]
) -> None:
    """Put both posterior spines at the marker between them, where only that is there."""
    hip = by_joint.get('hip_r')
    if hip is None or hip.method != 'harrington_2007' or _SACRUM not in found:
        return
    spines = hip.markers[2:4]
    if all(name not in found for name in spines):
        found.update(dict.fromkeys(spines, found[_SACRUM]))
        statements.append(f'{" and ".join(spines)}: not seen; {_SACRUM} is their middle')


def _leftward(by_joint: Mapping[str, JointDefinition], found: Mapping[str, Array]) -> Array | None:
    """Return the unit vector (3,) from the right to the left marker of the hips, or None."""
    hips = [by_joint.get(f'hip_{side}') for side in 'rl']
    if None in hips:
        return None
    names = [
        hip.markers[1 if i and len(hip.markers) > 1 else 0] for i, hip in enumerate(hips) if hip
    ]
    if any(name not in found for name in names):
        return None
    across = found[names[1]] - found[names[0]]
    return np.asarray(across / np.linalg.norm(across))
