# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint torque injury index (thesis eq. 4.12)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array, BoolArray
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import array


def torque_index(torque: Array, lower: Array, upper: Array) -> Array:
    """Ratio of joint torque and dynamic joint strength, thesis eq. 4.12.

    The strength is the upper bound where the torque is positive and the lower bound where it is
    negative, so the index is never negative; 1 means that the whole strength is used.

    Parameters
    ----------
    torque : array, any shape
        Joint torque [N m].
    lower, upper : arrays of the same shape
        Dynamic joint strength in the negative (lower <= 0) and positive (upper >= 0) direction
        [N m]; NaN where no strength is published for a joint.

    Returns
    -------
    array
        The index; infinite where a torque meets no strength at all, NaN where the strength is
        not known.

    Raises
    ------
    InvalidInputError
        If the shapes differ, a lower bound is positive or an upper bound negative, or a torque
        is not finite.
    """
    tau = np.asarray(torque, dtype=np.float64)
    low = array('lower', lower, tau.shape)
    high = array('upper', upper, tau.shape)
    if not np.all(np.isfinite(tau)):
        raise InvalidInputError('torque', float(tau[~np.isfinite(tau)][0]), 'must be finite')
    if np.any(low > 0.0):
        raise InvalidInputError('lower', float(np.nanmax(low)), 'must not be positive')
    if np.any(high < 0.0):
        raise InvalidInputError('upper', float(np.nanmin(high)), 'must not be negative')
    strength = np.where(tau > 0.0, high, low)
    index = np.full(tau.shape, np.inf)
    np.divide(tau, strength, out=index, where=strength != 0.0)
    index[(tau == 0.0) & ~np.isnan(strength)] = 0.0
    return index


def worst_torque_index(torque: Array, lower: Array, upper: Array) -> tuple[int, float] | None:
    """Find the joint with the largest index in one sample; see :func:`torque_index`.

    In plain numbers: for the joints of one body, arithmetic of arrays takes longer to begin than
    this takes altogether.

    Parameters
    ----------
    torque, lower, upper : arrays (n_j,)
        [N m].

    Returns
    -------
    (int, float) or None
        Number of the joint, the first of equal ones, and its index; None if no joint's strength
        is known.

    Raises
    ------
    InvalidInputError
        As :func:`torque_index`.
    """
    worst: tuple[int, float] | None = None
    rows = zip(torque.tolist(), lower.tolist(), upper.tolist(), strict=True)
    for k, (tau, low, high) in enumerate(rows):
        if low > 0.0 or high < 0.0 or not math.isfinite(tau):
            torque_index(torque, lower, upper)
        strength = high if tau > 0.0 else low
        if math.isnan(strength):
            continue
        index = 0.0
        if tau != 0.0:
            index = tau / strength if strength != 0.0 else math.inf
        if worst is None or index > worst[1]:
            worst = k, index
    return worst


@dataclass(frozen=True)
class TorqueIndexPeaks:
    """Largest torque index of every joint over a lift.

    Attributes
    ----------
    joints : tuple of str
    peak : array (n_joints,)
        NaN where no sample was solved or the joint's strength is not known.
    time : array (n_joints,)
        Time of the peak [s], on the clock of the samples; NaN where there is no peak.
    """

    joints: tuple[str, ...]
    peak: Array
    time: Array

    def worst(self) -> tuple[str, float, float]:
        """Return joint, index and time of the largest peak; ('', NaN, NaN) if there is none."""
        if not self.joints or np.all(np.isnan(self.peak)):
            return '', float('nan'), float('nan')
        k = int(np.nanargmax(self.peak))
        return self.joints[k], float(self.peak[k]), float(self.time[k])


def torque_index_peaks(
    time: Array,
    joints: Sequence[str],
    torque: Array,
    lower: Array,
    upper: Array,
    solved: BoolArray,
) -> TorqueIndexPeaks:
    """Find the largest torque index of every joint.

    Parameters
    ----------
    time : array (n,)
        [s].
    joints : sequence of n_j names
    torque, lower, upper : arrays (n, n_j)
        [N m]; rows that are not solved may hold anything.
    solved : array of bool (n,)
        Samples whose solve report is good; the others are left out.
    """
    shape = (len(time), len(joints))
    tau = array('torque', torque, shape)
    low = array('lower', lower, shape)
    high = array('upper', upper, shape)
    nothing = np.full(len(joints), np.nan)
    if not np.any(solved):
        return TorqueIndexPeaks(tuple(joints), nothing, nothing.copy())
    index = torque_index(tau[solved], low[solved], high[solved])
    known = ~np.all(np.isnan(index), axis=0)
    rows = np.argmax(np.where(np.isnan(index), -np.inf, index), axis=0)
    peak = index[rows, np.arange(len(joints))]
    when = np.where(known, np.asarray(time)[solved][rows], np.nan)
    return TorqueIndexPeaks(tuple(joints), peak, when)
