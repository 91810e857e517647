# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint centres of a person in a static trial, from landmarks (``data/joint_centres.csv``)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.tables import read_file, read_table
from human_model.typing import Array
from motion_tracker.core.exceptions import CalibrationError
from motion_tracker.core.markers.marker_set import MarkerSet

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


def load_joint_definitions(marker_set: MarkerSet) -> tuple[JointDefinition, ...]:
    """Definitions that belong to a marker set.

    Those of a set of one's own are in a file beside it, ``<set>_joint_centres.csv`` with the
    columns ``joint``, ``method`` and ``markers``.

    Raises
    ------
    CalibrationError
        If the set has none.
    TableError
        If a row is damaged.
    """
    joints = {joint: joint for joint in SEGMENT_OF_JOINT}
    columns = 'joint method markers'
    if marker_set.path is None:
        rows = read_table('motion_tracker', 'joint_centres.csv', f'marker_set {columns}')
        rows = tuple(row for row in rows if row['marker_set'] == marker_set.name)
        where = 'joint_centres.csv'
    else:
        path = marker_set.path.with_name(f'{marker_set.name}_joint_centres.csv')
        rows, where = (read_file(path, columns) if path.is_file() else ()), str(path)
    found = []
    for row in rows:
        names = tuple(row['markers'].split())
        count = row.choice('method', _METHODS)
        if len(names) != count:
            raise row.error('markers', f'{count} markers are needed')
        unknown = [name for name in names if name not in marker_set.names]
        if unknown:
            raise row.error('markers', f'{marker_set.name} has no marker {unknown[0]}')
        found.append(
            JointDefinition(
                row.choice('joint', joints), row['method'], names, row.get('source', where)
            )
        )
    absent = [joint for joint in joints if joint not in {d.joint for d in found}]
    if absent:
        raise CalibrationError(
            f'{where}: no joint centre {", ".join(absent)} for marker set {marker_set.name!r}: '
            f'a static trial needs a table with the columns {columns} and a row for each joint, '
            f'for example knee_r,midpoint,RKNE RKNEM; methods are {", ".join(_METHODS)}. Without '
            '--static the positions of the marker set are used'
        )
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
                f'for {definition.joint} ({definition.source}): if it has another name, write '
                f'recording: {{rename: {{NAME: {absent[0]}}}}} in the subject file'
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
