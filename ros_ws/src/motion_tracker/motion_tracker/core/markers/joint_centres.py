# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint centres of a person in a static trial, from landmarks (``data/joint_centres.csv``)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.tables import read_table
from human_model.typing import Array
from motion_tracker.core.exceptions import CalibrationError

#: Segment whose proximal joint each centre is.
SEGMENT_OF_JOINT = {
    f'{joint}_{side}': f'{segment}_{side}'
    for side in 'rl'
    for joint, segment in (
        ('hip', 'thigh'),
        ('knee', 'shank'),
        ('ankle', 'foot'),
        ('shoulder', 'upper_arm'),
        ('elbow', 'forearm'),
        ('wrist', 'hand'),
    )
}

_METHODS = {'marker': 1, 'midpoint': 2, 'harrington_2007': 5, 'below_marker': 1}


@dataclass(frozen=True)
class JointDefinition:
    """How one joint centre follows from markers."""

    joint: str
    method: str
    markers: tuple[str, ...]
    source: str


def load_joint_definitions(marker_set: str) -> tuple[JointDefinition, ...]:
    """Definitions that belong to a marker set.

    Raises
    ------
    CalibrationError
        If the set has none.
    """
    joints = {joint: joint for joint in SEGMENT_OF_JOINT}
    found = []
    for row in read_table(
        'motion_tracker', 'joint_centres.csv', 'marker_set joint method markers'
    ):
        if row['marker_set'] != marker_set:
            continue
        names = tuple(row['markers'].split())
        count = row.choice('method', _METHODS)
        if len(names) != count:
            raise row.error('markers', f'{count} markers are needed')
        found.append(
            JointDefinition(row.choice('joint', joints), row['method'], names, row['source'])
        )
    if not found:
        raise CalibrationError(f'joint_centres.csv: no joint centres for {marker_set!r}')
    return tuple(found)


def harrington_hip(
    right_asis: Array,
    left_asis: Array,
    right_psis: Array,
    left_psis: Array,
    malleolus: Array,
    side: str,
) -> Array:
    """Hip centre (3,) [m] by the regression of Harrington et al. 2007 (J Biomech 40:595).

    In pelvic axes at mid-ASIS, x forward in the plane of ASIS and PSIS, y up, z right, with pelvic
    depth PD, pelvic width PW and leg length LL (ASIS to medial malleolus):
    ``x = -0.24 PD - 9.9 mm``, ``y = -0.16 PW - 0.04 LL - 7.1 mm``,
    ``z = +-(0.28 PD + 0.16 PW + 7.9 mm)``.

    Parameters
    ----------
    right_asis, left_asis, right_psis, left_psis, malleolus
        World positions (3,) [m]; the medial malleolus is that of ``side``.
    side
        ``'r'`` or ``'l'``.
    """
    front, back = (right_asis + left_asis) / 2, (right_psis + left_psis) / 2
    width = float(np.linalg.norm(right_asis - left_asis))
    depth = float(np.linalg.norm(front - back))
    leg = float(np.linalg.norm((right_asis if side == 'r' else left_asis) - malleolus))
    rightward = (right_asis - left_asis) / width
    forward = front - back
    forward = forward - rightward * (forward @ rightward)
    forward = forward / np.linalg.norm(forward)
    upward = np.cross(rightward, forward)
    sign = 1.0 if side == 'r' else -1.0
    return np.asarray(
        front
        + (-0.24 * depth - 0.0099) * forward
        + (-0.16 * width - 0.04 * leg - 0.0071) * upward
        + sign * (0.28 * depth + 0.16 * width + 0.0079) * rightward
    )


def joint_centres(
    definitions: tuple[JointDefinition, ...],
    markers: Mapping[str, Array],
    below: Mapping[str, Array],
) -> dict[str, Array]:
    """Joint centres (3,) [m] by name of the joint.

    Parameters
    ----------
    definitions
        Of the marker set.
    markers
        Mean positions (3,) in the static trial, world [m].
    below
        For joints of method ``below_marker``: vector (3,) from marker to joint, world [m].

    Raises
    ------
    CalibrationError
        If a marker that is needed is not there.
    """
    centres = {}
    for definition in definitions:
        absent = [name for name in definition.markers if name not in markers]
        if absent:
            raise CalibrationError(
                f'static trial: marker {absent[0]!r} is missing, it is needed '
                f'for {definition.joint} ({definition.source})'
            )
        at = [np.asarray(markers[name]) for name in definition.markers]
        if definition.method == 'harrington_2007':
            centres[definition.joint] = harrington_hip(
                at[0], at[1], at[2], at[3], at[4], definition.joint[-1]
            )
        elif definition.method == 'below_marker':
            centres[definition.joint] = at[0] + below[definition.joint]
        else:
            centres[definition.joint] = np.mean(at, axis=0)
    return centres
