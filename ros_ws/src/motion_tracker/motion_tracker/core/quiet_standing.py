# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Frames in which a person stands still on the plates, and their missing moment.

In quiet standing the centre of pressure lies under the centre of mass, except for the effect of
small accelerations. A constant missing moment shows an error in the place of the plates in the
laboratory, or in the mass distribution of the body.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.compiled import body_frames, newton_euler
from human_model.constants import GRAVITY
from human_model.motion import POINTS
from human_model.skeleton import Skeleton
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.filters import derivatives, zero_phase
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.markers.marker_model import model_for
from motion_tracker.core.markers.marker_set import MarkerSet

#: Cut-off of the motion [Hz], as in the thesis (section 3.4).
_CUTOFF = 6.0


@dataclass(frozen=True)
class StandingSettings:
    """Criteria of quiet standing with empty hands; engineering choices.

    Attributes
    ----------
    speed : float
        Greatest speed of the centre of mass [m/s].
    lean : float
        Greatest angle of the line from hips to C7 with the vertical [rad].
    knee : float
        Greatest flexion of either knee [rad].
    weight : float
        Greatest share of the body weight by which the plates' vertical force may differ from it.
    shortest : float
        Time that must be found in all, and length of the shortest piece that is looked at [s].
    """

    speed: float = 0.05
    lean: float = float(np.radians(15.0))
    knee: float = float(np.radians(20.0))
    weight: float = 0.05
    shortest: float = 0.5


@dataclass(frozen=True, eq=False)
class QuietStanding:
    """Frames of quiet standing.

    Attributes
    ----------
    frames : ndarray (n,)
        Their indices in the recording.
    q, qd, qdd : ndarray (n, n_q)
        Coordinates, filtered without delay, and their rates [rad or m, per s, per s^2].
    """

    frames: npt.NDArray[np.int64]
    q: Array
    qd: Array
    qdd: Array


def coordinates_of(
    subject: Subject, marker_set: MarkerSet | None, names: Sequence[str], positions: npt.ArrayLike
) -> tuple[Skeleton3D, Array]:
    """Skeleton of a subject and its coordinates (n, n_q); NaN where a frame is not good data.

    ``positions`` (n, n_markers, 3) [m] of the markers ``names``; others than the model's are
    passed over.
    """
    places = np.asarray(positions, dtype=np.float64)
    skeleton = Skeleton3D.of(subject)
    model = model_for(subject, marker_set)[0].only(names)
    columns = [list(names).index(name) for name in model.names]
    solver = InverseKinematics(skeleton, model)
    found = np.full((len(places), len(skeleton.coordinates)), np.nan)
    last: Array | None = None
    for i, frame in enumerate(places[:, columns]):
        solution = solver.solve(frame, last)
        last = solution.q if solution.ok else None
        if solution.ok:
            found[i] = solution.q
    return skeleton, found


def find_quiet_standing(
    skeleton: Skeleton,
    rate: float,
    q: npt.ArrayLike,
    force: npt.ArrayLike,
    settings: StandingSettings | None = None,
) -> QuietStanding:
    """Find the frames in which a person stands still with empty hands.

    Parameters
    ----------
    skeleton
        Of the person.
    rate
        Frames per second.
    q
        Coordinates (n, n_q) [rad, m]; rows of NaN where they are not known.
    force
        Of all plates together on the person, at the same times, (n, 3) [N].
    settings
        Criteria.

    Raises
    ------
    TrackerError
        If there is too little of it.
    """
    wanted = settings or StandingSettings()
    motion, forces = (np.asarray(a, dtype=np.float64) for a in (q, force))
    found = [(np.zeros(0, np.int64), *(np.zeros((0, motion.shape[1])),) * 3)]
    known = np.isfinite(np.concatenate((motion, forces), axis=1)).all(axis=1)
    for run in _runs(np.asarray(known)):
        if len(run) < max(2, round(wanted.shortest * rate)):
            continue
        smooth = zero_phase(motion[run], rate, _CUTOFF)
        qd, qdd = derivatives(smooth, rate)
        still = _still(skeleton, rate, smooth, forces[run], wanted)
        # The filter and the spline know less of the ends: one period of the cut-off is left out.
        end = round(rate / _CUTOFF)
        still[:end] = still[len(still) - end :] = False
        found.append((run[still], smooth[still], qd[still], qdd[still]))
    frames, *rows = (np.concatenate(parts) for parts in zip(*found, strict=True))
    if len(frames) < wanted.shortest * rate:
        raise TrackerError(
            f'quiet standing: {len(frames) / rate:.2f} s found, '
            f'{wanted.shortest:g} s upright, slower than {wanted.speed:g} m/s '
            'and with empty hands are needed'
        )
    return QuietStanding(frames, *rows)


def missing_moment(
    skeleton: Skeleton, standing: QuietStanding, force: Array, moment: Array
) -> Array:
    """Moment (n, 3) [N m] about the centre of mass that the ground does not give, world axes.

    ``force`` and ``moment`` (n, 3) of all plates together on the person at the frames of
    ``standing``, moments about the world's origin.
    """
    missing = []
    rows = zip(standing.q, standing.qd, standing.qdd, force, moment, strict=True)
    for q, qd, qdd, push, turn in rows:
        wrench = np.zeros((len(skeleton.segments), 6))
        # The wrench of the ground on the whole body does not depend on its point of attack.
        wrench[0] = [*push, *turn]
        tau = newton_euler(skeleton.tree, q, qd, qdd, wrench, GRAVITY)
        _, origin, axis = body_frames(skeleton.tree, q)
        lacking = np.array([tau[0], -tau[2], tau[1]])
        about_hips = np.linalg.solve(axis[3:6], tau[3:6])
        missing.append(about_hips + np.cross(origin[5] - skeleton.centre_of_mass(q), lacking))
    return np.array(missing)


def _runs(good: npt.NDArray[np.bool_]) -> list[npt.NDArray[np.int64]]:
    """Return the indices of the pieces without gaps."""
    where = np.flatnonzero(good)
    return [run for run in np.split(where, np.flatnonzero(np.diff(where) > 1) + 1) if len(run)]


def _still(
    skeleton: Skeleton, rate: float, q: Array, force: Array, wanted: StandingSettings
) -> npt.NDArray[np.bool_]:
    """Return for each frame (n,) whether it is one of quiet standing."""
    points = skeleton.point_array(q)
    trunk = points[:, POINTS.index('c7')] - points[:, POINTS.index('pelvis')]
    lean = np.arctan2(np.linalg.norm(trunk[:, :2], axis=1), trunk[:, 2])
    knees = q[:, [skeleton.index(f'knee_angle_{side}') for side in 'rl']]
    mass_centre = np.array([skeleton.centre_of_mass(row) for row in q])
    speed = np.linalg.norm(np.gradient(mass_centre, 1.0 / rate, axis=0), axis=1)
    carried = force[:, 2] / (skeleton.total_mass * GRAVITY)
    return np.asarray(
        (speed <= wanted.speed)
        & (lean <= wanted.lean)
        & (knees.max(axis=1) <= wanted.knee)
        & (np.abs(carried - 1.0) <= wanted.weight)
    )
