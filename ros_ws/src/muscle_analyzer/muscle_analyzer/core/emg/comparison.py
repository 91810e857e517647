# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""EMG envelopes beside computed activations: correlation and phase error, channel by channel.

A channel's activation is the mean over the parts that the model makes of its muscle. Correlation
is Pearson's, at equal times. The phase error is the shift of the activation against the envelope
at which they correlate best; it is positive when the activation comes later.

What to expect: EMG precedes force by the electromechanical delay, and static optimisation without
activation dynamics gives activations in phase with force; co-contraction is in the EMG only.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from human_model.tables import read_table
from human_model.typing import Array
from muscle_analyzer.core.emg.envelopes import Envelopes
from muscle_analyzer.core.exceptions import EmgError
from muscle_analyzer.core.loads.analysis import MuscleAnalysis

#: Shifts are tried in steps of 1 ms, a sampling interval of the EMG at its lowest rate.
LAG_STEP = 1e-3
#: Largest shift, as a fraction of the lift; beyond it the two are not the same event.
LARGEST_LAG = 0.5
#: Smallest standard deviation of an activation that is not constant.
CONSTANT = 1e-6
_SIDES = {'r': 'r', 'right': 'r', 'l': 'l', 'left': 'l'}
#: Words that a channel's name may have beside muscle and side.
_FILLERS = frozenset({'emg', 'ch', 'channel', 'raw', 'm'})


@dataclass(frozen=True)
class EmgMuscle:
    """A muscle that EMG is taken from.

    Attributes
    ----------
    code : str
        Short name in the names of channels.
    names : tuple of str
        Other names, small letters.
    muscle : str
        Name for people.
    pattern : str
        Regular expression of the names of its parts in the model, without their side.
    """

    code: str
    names: tuple[str, ...]
    muscle: str
    pattern: str


@dataclass(frozen=True, eq=False)
class EmgMatch:
    """One channel beside the activation of its muscle.

    Attributes
    ----------
    channel, muscle, side : str
    parts : tuple of str
        Muscles of the model whose mean activation was taken.
    time : (n,) array
        Of the samples that were compared, s.
    envelope, activation : (n,) arrays
    normalised_by : str
        What 1 is in the envelope.
    correlation : float
        At equal times; NaN if one of them is constant.
    lag : float
        Phase error, s; NaN if there is no best shift inside the limits.
    lag_percent : float
        In per cent of the lift's duration.
    best_correlation : float
        With that shift.
    rms : float
        Of the difference at equal times.
    note : str
        Why a value is missing; else empty.
    """

    channel: str
    muscle: str
    side: str
    parts: tuple[str, ...]
    time: Array
    envelope: Array
    activation: Array
    normalised_by: str
    correlation: float
    lag: float
    lag_percent: float
    best_correlation: float
    rms: float
    note: str


@dataclass(frozen=True, eq=False)
class LiftActivations:
    """Muscle activations over a lift, wherever they come from.

    Attributes
    ----------
    lift_id : str
    time : (n,) array
        s, on the clock of the EMG.
    muscle_names : tuple of str
    activation : (n, n_m) array
    good : (n,) array of bool
        Samples whose muscle forces are good data.
    """

    lift_id: str
    time: Array
    muscle_names: tuple[str, ...]
    activation: Array
    good: NDArray[np.bool_]

    @classmethod
    def of(cls, analysis: MuscleAnalysis) -> LiftActivations:
        """Return those of an analysis."""
        good = np.array([report.ok for report in analysis.reports])
        return cls(
            analysis.lift_id, analysis.time, analysis.muscle_names, analysis.activation, good
        )


@cache
def emg_muscles() -> tuple[EmgMuscle, ...]:
    """Return the rows of `data/emg_channels.csv`."""
    return tuple(
        EmgMuscle(row['code'], tuple(row['names'].split('|')), row['muscle'], row['pattern'])
        for row in read_table('muscle_analyzer', 'emg_channels.csv', 'code names muscle pattern')
    )


def muscle_of_channel(channel: str) -> tuple[EmgMuscle, str]:
    """Return muscle and side ('r' or 'l') from a channel's name: `BFR`, `EMG_VL_l`, ...

    Raises
    ------
    EmgError
        If the name does not contain both; lists the valid names.
    """
    words = [w for w in re.split(r'[^a-z0-9]+', channel.lower()) if w and w not in _FILLERS]
    sides = [_SIDES[word] for word in words if word in _SIDES]
    rest = ' '.join(word for word in words if word not in _SIDES)
    for muscle in emg_muscles():
        for name in (muscle.code.lower(), *muscle.names):
            for spelled in (name, name.replace(' ', '')):
                if len(sides) == 1 and rest == spelled:
                    return muscle, sides[0]
                if not sides and rest[:-1] == spelled and rest[-1:] in ('r', 'l'):
                    return muscle, rest[-1]
    codes = ', '.join(muscle.code for muscle in emg_muscles())
    raise EmgError(
        f'EMG channel {channel!r} names no muscle and side; known are {codes} with R or L, as in '
        "'BFR' or 'EMG_BF_r'"
    )


def parts_of(muscle: EmgMuscle, side: str, muscle_names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of a muscle's parts on one side of a model, or raise EmgError."""
    ending = f'_{side}'
    found = tuple(
        name
        for name in muscle_names
        if name.endswith(ending) and re.search(muscle.pattern, name.removesuffix(ending))
    )
    if not found:
        raise EmgError(f'the model has no muscle {muscle.pattern!r} on side {side!r}')
    return found


def compare_emg(
    envelopes: Envelopes, analysis: MuscleAnalysis, channels: Mapping[str, str] | None = None
) -> tuple[EmgMatch, ...]:
    """Compare every channel with an analysis of a lift; see `match_envelopes`."""
    return match_envelopes(envelopes, LiftActivations.of(analysis), channels)


def match_envelopes(
    envelopes: Envelopes, lift: LiftActivations, channels: Mapping[str, str] | None = None
) -> tuple[EmgMatch, ...]:
    """Compare every channel with the activation of its muscle over a lift.

    Parameters
    ----------
    envelopes : Envelopes
        Longer than the lift, so that shifted envelopes are known.
    lift : LiftActivations
        Samples whose muscle forces are not good data are left out.
    channels : mapping of str to str, optional
        Names with muscle and side, in place of channels' own names.

    Raises
    ------
    EmgError
        If a channel names no muscle, a name is of no channel, or EMG and lift do not overlap.
    """
    channels = channels or {}
    if unknown := sorted(set(channels) - set(envelopes.channels)):
        raise EmgError(
            f'{unknown[0]!r}: no such EMG channel; channels: {", ".join(envelopes.channels)}'
        )
    good = lift.good & np.isfinite(lift.activation).all(axis=1)
    time = lift.time[good]
    if time.size < 3:
        raise EmgError(f'lift {lift.lift_id!r}: {time.size} good samples to compare with EMG')
    if time[0] < envelopes.time[0] or time[-1] > envelopes.time[-1]:
        raise EmgError(
            f'lift {lift.lift_id!r}, {time[0]:.3f} to {time[-1]:.3f} s, is not within the '
            f'EMG, {envelopes.time[0]:.3f} to {envelopes.time[-1]:.3f} s'
        )
    duration = float(lift.time[-1] - lift.time[0])
    found = []
    for k, channel in enumerate(envelopes.channels):
        muscle, side = muscle_of_channel(channels.get(channel, channel))
        parts = parts_of(muscle, side, lift.muscle_names)
        columns = [lift.muscle_names.index(name) for name in parts]
        activation = lift.activation[good][:, columns].mean(axis=1)
        envelope = np.interp(time, envelopes.time, envelopes.values[:, k])
        lag, best, note = _best_lag(
            time, activation, envelopes.time, envelopes.values[:, k], LARGEST_LAG * duration
        )
        found.append(
            EmgMatch(
                channel=channel,
                muscle=muscle.muscle,
                side=side,
                parts=parts,
                time=time,
                envelope=envelope,
                activation=activation,
                normalised_by=envelopes.normalised_by[k],
                correlation=_correlation(activation, envelope),
                lag=lag,
                lag_percent=100.0 * lag / duration,
                best_correlation=best,
                rms=float(np.sqrt(np.mean((activation - envelope) ** 2))),
                note=note,
            )
        )
    return tuple(found)


def _correlation(one: Array, other: Array) -> float:
    """Return Pearson's correlation; NaN if one of them is constant."""
    a, b = one - one.mean(), other - other.mean()
    if min(a.std(), b.std()) < CONSTANT:
        return float('nan')
    return float(a @ b / np.sqrt((a @ a) * (b @ b)))


def _best_lag(
    time: Array, activation: Array, emg_time: Array, envelope: Array, limit: float
) -> tuple[float, float, str]:
    """Return the shift of best correlation, that correlation, and why there is none."""
    nothing = float('nan')
    if activation.std() < CONSTANT:
        return nothing, nothing, 'activation constant'
    # A shift must not lead out of the recording.
    first = max(-limit, time[-1] - emg_time[-1])
    last = min(limit, time[0] - emg_time[0])
    shifts = LAG_STEP * np.arange(np.ceil(first / LAG_STEP), np.floor(last / LAG_STEP) + 1.0)
    found = np.array(
        [_correlation(activation, np.interp(time - s, emg_time, envelope)) for s in shifts]
    )
    if not np.isfinite(found).any():
        return nothing, nothing, 'envelope constant'
    best = int(np.nanargmax(found))
    if best in (0, shifts.size - 1):
        return nothing, nothing, f'best beyond {shifts[best]:+.3f} s'
    return float(shifts[best]), float(found[best]), ''
