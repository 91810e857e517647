# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker calibration from a static trial: measured lengths, posture, marker offsets.

The person stands upright, trunk and wrists straight, both feet flat: that defines the zero of the
spine's, the wrists' and the toes' angles, which no landmark gives as well. (1) Joint centres
follow from landmarks, segment lengths from joint centres, the depth of the pelvis from its iliac
spines; the heights of the trunk's joints keep the proportions of the anthropometric tables.
(2) The posture is fitted to the joint centres and to the landmarks that have a place in the marker
set; the height of the foot's landmarks over the ankle is not fitted, because the feet are known to
be flat. (3) Every tracking marker gets the place on its segment where it was seen in that posture.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from human_model.anthropometry import segment_lengths
from human_model.skeletons import Skeleton3D
from human_model.subject import Calibration, Subject
from human_model.typing import Array
from motion_tracker.core.exceptions import CalibrationError
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.inverse_kinematics.solution import IKSettings
from motion_tracker.core.markers.joint_centres import (
    SEGMENT_OF_JOINT,
    JointDefinition,
    joint_centres,
    load_joint_definitions,
)
from motion_tracker.core.markers.joint_widths import completed
from motion_tracker.core.markers.marker_model import MarkerModel, from_calibration
from motion_tracker.core.markers.marker_set import MarkerSet
from motion_tracker.core.markers.segment_measures import measured_lengths

#: Weight of a joint centre in the fit of the posture, against 1 or 2 of a landmark.
CENTRE_WEIGHT = 10.0

#: The same of the ankles: the feet stand where they stand, what does not fit must show higher up.
ANKLE_WEIGHT = 1000.0

#: Coordinates that are zero in the static trial, and the weight that holds them there [m^2/rad^2].
STRAIGHT = (
    'lumbar_extension',
    'lumbar_bending',
    'lumbar_rotation',
    'thorax_extension',
    'thorax_bending',
    'thorax_rotation',
    'wrist_flex_r',
    'wrist_dev_r',
    'wrist_flex_l',
    'wrist_dev_l',
    'mtp_angle_r',
    'mtp_angle_l',
)
STRAIGHT_WEIGHT = 10.0

#: A static trial whose markers move more than this (standard deviation) is not static [m].
LARGEST_SWAY = 0.02

#: A static trial with a landmark or joint centre further than this from its anatomical place is
#: not one [m]: the limit of a marker in a frame, `IKSettings.max_residual`.
LARGEST_MISFIT = 0.08

#: The trunk's lengths, which are scaled together.
_TRUNK = (
    'sacrum_forward',
    'sacrum_height',
    't12l1_forward',
    't12l1_height',
    'shoulder_forward',
    'shoulder_height',
    'c7_forward',
    'c7_height',
)

#: Marker on the spinous process of C7, in all sets; its height gives that of the neck's joint.
_NECK = 'C7'

#: Frames of the static trial the calibrated model is tried on.
_CHECKED_FRAMES = 20


@dataclass(frozen=True, eq=False)
class StaticCalibration:
    """Result of a static trial.

    Attributes
    ----------
    calibration : Calibration
        Offsets, lengths, and the root mean square residual of the calibrated model in the trial.
    posture : ndarray (n_q,)
        Coordinates in the trial [rad or m].
    landmark_rms, landmark_max : float
        Distance of joint centres and landmarks from their anatomical places [m]: how well the
        tables' anatomy fits this person.
    joint_centres : mapping of str to ndarray (3,)
        World [m].
    statements : tuple of str
        Measured and assumed quantities, for the report.
    """

    calibration: Calibration
    posture: Array
    landmark_rms: float
    landmark_max: float
    joint_centres: Mapping[str, Array]
    statements: tuple[str, ...]


def calibrate(
    marker_set: MarkerSet,
    names: Sequence[str],
    positions: npt.ArrayLike,
    subject: Subject,
    widths: Mapping[str, float] | None = None,
) -> StaticCalibration:
    """Calibrate from a static trial.

    Parameters
    ----------
    marker_set
        Set the names belong to.
    names
        Markers of the trial, n.
    positions
        Shape (frames, n, 3), REP-103 world [m]; NaN where not seen.
    subject
        The person; its own ``lengths`` are kept, its ``calibration`` is not used.
    widths
        Measured widths of joints without a medial marker, 'knee', 'ankle' and 'elbow' [m].

    Raises
    ------
    CalibrationError
        If the trial moves, is not in metres, a marker that is needed was never seen, or a
        landmark is too far from its anatomical place.
    """
    array = np.asarray(positions, dtype=np.float64)
    if array.ndim != 3 or array.shape[1:] != (len(names), 3) or not len(array):
        raise CalibrationError(
            f'static trial: positions (frames, {len(names)}, 3) are needed, got {array.shape}'
        )
    mean = _mean_positions(names, array)
    known = {name: mean[name] for name in mean if name in marker_set.names}
    statements = [
        f'static trial of {len(array)} frames, {len(known)} markers of {marker_set.name}'
    ]
    ignored = sorted(set(mean) - set(known))
    if ignored:
        statements.append(f'markers not in {marker_set.name}, ignored: {", ".join(ignored)}')
    absent = [m.name for m in marker_set.markers if m.tracking and m.name not in known]
    if absent:
        statements.append(f'tracking markers not in the static trial: {", ".join(absent)}')
    definitions = load_joint_definitions(marker_set)
    person = replace(subject, calibration=None)
    whole = completed(
        marker_set, definitions, known, segment_lengths(person)[0], dict(widths or {})
    )
    lengths, centres = _measure(marker_set, definitions, whole.markers, person)
    skeleton = Skeleton3D.of(replace(person, lengths={**lengths, **subject.lengths}))
    posture, rms, worst = _posture(marker_set, skeleton, known, centres)
    if _NECK in known and 'c7_height' not in subject.lengths:
        lengths['c7_height'] = float(_local(skeleton, posture, 'thorax', known[_NECK])[2])
        skeleton = Skeleton3D.of(replace(person, lengths={**lengths, **subject.lengths}))
    tracked = [m for m in marker_set.markers if m.tracking and m.name in known]
    offsets = np.array([_local(skeleton, posture, m.segment, known[m.name]) for m in tracked])
    draft = Calibration(
        tuple(m.name for m in tracked), tuple(m.segment for m in tracked), offsets, lengths
    )
    residual = _residual(skeleton, draft, marker_set, names, array, posture)
    statements += whole.statements
    statements += [
        f'{d.joint}: {d.method.replace("_", " ")} of {" ".join(d.markers)} ({d.source})'
        for d in definitions
    ]
    statements.append(
        f'landmarks against anatomy: {1000 * rms:.1f} mm rms, '
        f'{1000 * worst:.1f} mm at most; calibrated model in the trial: '
        f'{1000 * residual:.1f} mm rms'
    )
    return StaticCalibration(
        replace(draft, residual_rms=residual), posture, rms, worst, centres, tuple(statements)
    )


def _local(skeleton: Skeleton3D, posture: Array, segment: str, point: Array) -> Array:
    """World point (3,) [m] in a segment's anatomical frame."""
    frame = skeleton.forward(posture)[skeleton.segments.index(segment)]
    return np.asarray(frame[:3, :3].T @ (point - frame[:3, 3]))


def _mean_positions(names: Sequence[str], array: Array) -> dict[str, Array]:
    if np.nanmax(np.abs(array)) > 50.0:
        raise CalibrationError(
            f'static trial: a coordinate is {np.nanmax(np.abs(array)):.0f} m; '
            'the markers seem to be in millimetres'
        )
    mean = {}
    for i, name in enumerate(names):
        seen = array[np.all(np.isfinite(array[:, i]), axis=1), i]
        if not len(seen):
            continue
        sway = float(seen.std(axis=0).max())
        if sway > LARGEST_SWAY:
            raise CalibrationError(
                f'static trial: marker {name!r} moves, its standard deviation '
                f'is {1000 * sway:.0f} mm, more than '
                f'{1000 * LARGEST_SWAY:.0f} mm'
            )
        mean[name] = seen.mean(axis=0)
    return mean


def _measure(
    marker_set: MarkerSet,
    definitions: tuple[JointDefinition, ...],
    markers: Mapping[str, Array],
    person: Subject,
) -> tuple[dict[str, float], dict[str, Array]]:
    """Segment lengths [m] and joint centres [m] of the trial."""
    predicted = segment_lengths(person)[0]
    placed = marker_set.positions(predicted)
    legs = tuple(d for d in definitions if not d.joint.startswith('shoulder'))
    centres = joint_centres(legs, markers, {})
    leftward = centres['hip_l'] - centres['hip_r']
    leftward[2] = 0.0
    leftward = leftward / np.linalg.norm(leftward)
    heading = np.stack([np.cross(leftward, [0.0, 0.0, 1.0]), leftward, [0.0, 0.0, 1.0]], axis=1)
    shoulders = tuple(d for d in definitions if d.joint.startswith('shoulder'))
    below, breadth = {}, []
    for definition in shoulders:
        marker = placed[definition.markers[0]]
        sign = 1.0 if definition.joint[-1] == 'l' else -1.0
        joint = np.array(
            [
                predicted['shoulder_forward'],
                sign * predicted['shoulder_half_width'],
                predicted['shoulder_height'],
            ]
        )
        below[definition.joint] = heading @ (joint - marker)
        breadth.append(marker[1])
    centres |= joint_centres(shoulders, markers, below)

    def between(a: str, b: str) -> float:
        return float(
            np.mean([np.linalg.norm(centres[f'{a}_{s}'] - centres[f'{b}_{s}']) for s in 'rl'])
        )

    lengths = {
        'hip_half_width': float(np.linalg.norm(centres['hip_r'] - centres['hip_l'])) / 2,
        'thigh': between('hip', 'knee'),
        'shank': between('knee', 'ankle'),
        'upper_arm': between('shoulder', 'elbow'),
        'forearm': between('elbow', 'wrist'),
        'shoulder_half_width': float(np.linalg.norm(centres['shoulder_r'] - centres['shoulder_l']))
        / 2,
    }
    trunk = (
        float(
            np.linalg.norm(
                centres['shoulder_r'] + centres['shoulder_l'] - centres['hip_r'] - centres['hip_l']
            )
        )
        / 2
    )
    lengths |= measured_lengths(marker_set, markers, predicted)
    return lengths | _trunk_lengths(trunk, lengths, predicted), centres


def _trunk_lengths(
    trunk: float, measured: Mapping[str, float], predicted: Mapping[str, float]
) -> dict[str, float]:
    """Lengths [m] of the trunk's parts that add up to the measured one from hips to shoulders.

    The pelvis as far as the sacrum grows with its measured depth, sacrum and spine by one factor
    that fills the rest: the scale set-up of the lifting full-body model does so
    (Scaling_Setup_Pose2Sim_LSTM.xml of pose2sim 0.10.49). Without a measured depth all grow alike.
    """

    def way(*parts: str) -> Array:
        return np.array(
            [sum(predicted[f'{part}_{to}'] for part in parts) for to in ('forward', 'height')]
        )

    pelvis, spine = way('l5s1') - way('sacrum'), way('sacrum', 't12l1', 'shoulder')
    alike = trunk / float(np.linalg.norm(pelvis + spine))
    depth = measured.get('pelvis_depth', alike * predicted['pelvis_depth'])
    pelvis = pelvis * depth / predicted['pelvis_depth']
    along = pelvis @ spine / (spine @ spine)
    factor = float(np.sqrt(along**2 + (trunk**2 - pelvis @ pelvis) / (spine @ spine)) - along)
    l5s1 = pelvis + factor * way('sacrum')
    return {
        'pelvis_depth': depth,
        'l5s1_forward': float(l5s1[0]),
        'l5s1_height': float(l5s1[1]),
        **{name: factor * predicted[name] for name in _TRUNK},
    }


def _posture(
    marker_set: MarkerSet,
    skeleton: Skeleton3D,
    markers: Mapping[str, Array],
    centres: Mapping[str, Array],
) -> tuple[Array, float, float]:
    """Coordinates of the static trial and the misfit of its landmarks (rms, largest) [m]."""
    placed = marker_set.positions(skeleton.parameters.lengths)
    landmarks = [m for m in marker_set.markers if m.name in placed and m.name in markers]
    joints = sorted(centres)
    model = MarkerModel(
        tuple(joints) + tuple(m.name for m in landmarks),
        tuple(SEGMENT_OF_JOINT[j] for j in joints) + tuple(m.segment for m in landmarks),
        np.array([np.zeros(3)] * len(joints) + [placed[m.name] for m in landmarks]),
        np.array(
            [ANKLE_WEIGHT if j.startswith('ankle') else CENTRE_WEIGHT for j in joints]
            + [m.weight for m in landmarks]
        ),
    )
    target = np.array([centres[j] for j in joints] + [markers[m.name] for m in landmarks])
    flat = skeleton.parameters.lengths
    for i, m in enumerate(landmarks, len(joints)):
        if m.segment[:-2] in ('foot', 'toes'):
            below = 0.0 if m.segment.startswith('foot') else flat['mtp_drop']
            target[i, 2] = centres[f'ankle_{m.segment[-1]}'][2] + placed[m.name][2] - below
    loose = IKSettings(max_residual=np.inf, rms_residual=np.inf, max_iterations=200)
    solver = InverseKinematics(skeleton, model, loose, dict.fromkeys(STRAIGHT, STRAIGHT_WEIGHT))
    solution = solver.solve(target)
    if not solution.ok:
        raise CalibrationError(
            f'static trial: the posture could not be fitted: {solution.message}'
        )
    worst = int(np.nanargmax(solution.residuals))
    if solution.residuals[worst] > LARGEST_MISFIT:
        raise CalibrationError(
            f'static trial: {model.names[worst]} is {1000 * solution.residuals[worst]:.0f} mm '
            f'from its anatomical place, more than {1000 * LARGEST_MISFIT:.0f} mm: does the '
            'person stand upright, is the marker on this landmark (recording.rename), is '
            'subject.stature right?'
        )
    return solution.q, solution.rms, solution.maximum


def _residual(
    skeleton: Skeleton3D,
    draft: Calibration,
    marker_set: MarkerSet,
    names: Sequence[str],
    array: Array,
    posture: Array,
) -> float:
    """Root mean square marker distance [m] of the calibrated model over frames of the trial."""
    model = from_calibration(draft, marker_set)
    solver = InverseKinematics(skeleton, model)
    columns = [list(names).index(name) for name in model.names]
    every = max(1, len(array) // _CHECKED_FRAMES)
    squares = []
    for frame in array[::every]:
        solution = solver.solve(frame[columns], posture)
        squares.append(solution.residuals[np.isfinite(solution.residuals)] ** 2)
    return float(np.sqrt(np.mean(np.concatenate(squares))))
