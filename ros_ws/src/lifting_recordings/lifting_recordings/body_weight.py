# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The weight on the plates in quiet standing against the masses of the subject file."""

from __future__ import annotations

import numpy as np

from human_model.constants import GRAVITY
from human_model.typing import Array
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.plate_assignment import Carried
from lifting_recordings.recording import Plate

# Quiet standing: a window of a second, or of half a second if the mean of the recording does not
# agree either, in which the load has at most this standard deviation, as a share, ...
_QUIET_SECONDS, _SHORT_SECONDS = 1.0, 0.5
_QUIET_SPREAD = 0.02
# ... and the pelvis is at least at this share of its greatest height: who sits does not stand.
_STANDING_SHARE = 0.9


def check_weight(
    plates: dict[str, Plate],
    carried: Carried,
    tolerance: float,
    time: Array,
    pelvis_height: Array | None,
) -> str:
    """Compare the weight in quiet standing, with or without the box, with the entered masses.

    Parameters
    ----------
    plates : dict
        'right' and 'left' to Plate.
    carried : Carried
        Person and box.
    tolerance : float
        Allowed share.
    time : ndarray, shape (n,)
        Of the markers [s].
    pelvis_height : ndarray, shape (n,), or None
        [m]; NaN where not seen.

    Raises
    ------
    ConventionError
        The plates contradict the mass of the person.
    """
    right, left = plates['right'], plates['left']
    stamps = right.time
    total = right.force[:, 2] + np.interp(stamps, left.time, left.force[:, 2])
    mass, held = carried.mass, carried.mass + carried.box_mass
    standing = _standing(stamps, time, pelvis_height)
    start = _quiet(stamps, total, standing, _QUIET_SECONDS)
    if start is None and abs(float(np.mean(total)) / GRAVITY / mass - 1.0) > tolerance:
        start = _quiet(stamps, total, standing, _SHORT_SECONDS)
    if start is None:
        weighed, where = float(np.mean(total)) / GRAVITY, 'mean of the whole recording'
    else:
        weighed, where = start[1] / GRAVITY, f'quiet standing at {start[0]:.2f} s'
    off = weighed / mass - 1.0
    if abs(off) <= tolerance:
        return (
            f'Body mass on the plates: {weighed:.1f} kg ({where}), {off * 100:+.1f} % of entered.'
        )
    if carried.box_mass > 0.0:
        if abs(weighed / held - 1.0) <= tolerance and start is not None:
            return (
                f'Mass of body and box on the plates: {weighed:.1f} kg ({where}), '
                f'{(weighed / held - 1.0) * 100:+.1f} % of entered; the box is in the hands.'
            )
        if start is None and mass <= weighed <= held * (1.0 + tolerance):
            return (
                f'Warning: no quiet standing to compare the body mass with; on the plates '
                f'{weighed:.1f} kg on average, between {mass:g} kg of the body and {held:g} kg '
                'with the box.'
            )
    box = f' or, with task.box_mass, {held:g} kg' if carried.box_mass > 0.0 else ''
    raise ConventionError(
        f'body mass: the plates say {weighed:.1f} kg ({where}), the subject file '
        f'subject.mass says {mass:g} kg{box}, {off * 100:+.1f} %: allowed are '
        f'{tolerance * 100:g} %: correct subject.mass, or give --mass-tolerance'
    )


def _standing(stamps: Array, time: Array, height: Array | None) -> Array:
    """Whether the pelvis is high at the stamps of the plates; true where it is not known."""
    if height is None or not np.isfinite(height).any():
        return np.ones(stamps.size, dtype=bool)
    seen = np.isfinite(height)
    return np.asarray(
        np.interp(stamps, time[seen], height[seen]) > _STANDING_SHARE * np.max(height[seen])
    )


def _quiet(
    stamps: Array, total: Array, standing: Array, seconds: float
) -> tuple[float, float] | None:
    """Return start [s] and mean load [N] of the first quiet window, or None."""
    window = max(2, round(seconds / float(np.median(np.diff(stamps)))))
    for start in range(0, total.size - window + 1, max(1, window // 10)):
        inside = slice(start, start + window)
        part = total[inside]
        if np.std(part) < _QUIET_SPREAD * np.mean(part) and standing[inside].all():
            return float(stamps[start]), float(np.mean(part))
    return None
