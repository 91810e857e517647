# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The EMG of a recording, from the blocks of its topic `emg`, and beside a lift's activations."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from lifting_recordings.exceptions import UnreadableBagError
from lifting_recordings.reader import BagReader
from lifting_report.report_data import Activations, EmgFindings, Missing
from muscle_analyzer.core.emg.comparison import LiftActivations, match_envelopes, muscle_of_channel
from muscle_analyzer.core.emg.envelopes import EmgRecording, normalised_envelopes
from muscle_analyzer.core.exceptions import EmgError

TOPIC = 'emg'
_RATE = re.compile(r'^samples, (?P<rate>[0-9.e+]+) Hz$')
_CHANNEL = re.compile(r'^(?P<name>.*) \[(?P<unit>.*)\]$')
#: A block may begin so far from where the one before ends, as a share of a sampling interval.
_GAP = 0.5


def has_emg(bag: Path) -> bool:
    """Return whether a recording has the topic of EMG."""
    with BagReader(bag) as reader:
        return any(name.strip('/') == TOPIC for name in reader.topics)


def emg_of_lift(
    emg: EmgRecording, lift_id: str, activations: Activations | Missing, start: float
) -> EmgFindings | Missing:
    """Lay the EMG of a recording beside the activations of one of its lifts.

    Channels are understood by their names; one that names no muscle and side is left out and
    said. No MVC is known here: each channel is divided by its maximum in the recording.

    Parameters
    ----------
    emg : EmgRecording
    lift_id : str
    activations : Activations or Missing
        Of the recorded lift.
    start : float
        Start of the lift on the clock of the EMG [s].
    """
    if isinstance(activations, Missing):
        return Missing(f'no computed activations to lay the EMG beside: {activations.reason}')
    known, left_out = [], []
    for k, channel in enumerate(emg.channels):
        try:
            muscle_of_channel(channel)
        except EmgError as error:
            left_out.append(str(error))
        else:
            known.append(k)
    if not known:
        return EmgFindings((), tuple(left_out))
    chosen = EmgRecording(
        tuple(emg.channels[k] for k in known), tuple(emg.units[k] for k in known), emg.time,
        emg.values[:, known],
    )  # fmt: skip
    lift = LiftActivations(
        lift_id, activations.time + start, activations.muscles, activations.activation,
        activations.solved,
    )  # fmt: skip
    try:
        matches = match_envelopes(normalised_envelopes(chosen), lift)
    except EmgError as error:
        return Missing(str(error))
    return EmgFindings(matches, tuple(left_out))


def recorded_emg(bag: Path, start: float) -> EmgRecording:
    """Read the EMG of a recording.

    Parameters
    ----------
    bag : Path
    start : float
        Stamp that is zero of the result's time, s.

    Raises
    ------
    UnreadableBagError
        If the recording has no EMG, its blocks do not say what they hold, differ in channels or
        rate, or leave a gap.
    """
    with BagReader(bag) as reader:
        names = [name for name in reader.topics if name.strip('/') == TOPIC]
        blocks = [(stamp, message) for _, stamp, message in reader.messages(names)]
    if not names or not blocks:
        raise UnreadableBagError(f'{bag}: has no EMG (topic {TOPIC!r} is missing or empty)')
    rate, channels, units = _layout(bag, blocks[0][1])
    times, values = [], []
    follows: float | None = None
    for stamp, message in blocks:
        if _layout(bag, message) != (rate, channels, units):
            raise UnreadableBagError(f'{bag}: {TOPIC}: channels or rate change on the way')
        part = np.asarray(message.data, np.float64).reshape(-1, len(channels))
        # Whole nanoseconds first: as seconds since 1970 a double is too coarse.
        begin = (stamp - round(start * 1e9)) * 1e-9
        if follows is not None and abs(begin - follows) > _GAP / rate:
            raise UnreadableBagError(
                f'{bag}: {TOPIC}: block at {begin:.6f} s where {follows:.6f} s was to follow'
            )
        times.append(begin + np.arange(len(part)) / rate)
        values.append(part)
        follows = begin + len(part) / rate
    return EmgRecording(channels, units, np.concatenate(times), np.concatenate(values))


def _layout(bag: Path, message: Any) -> tuple[float, tuple[str, ...], tuple[str, ...]]:
    """Return rate, channel names and units that a block's layout says."""
    labels = [dimension.label for dimension in message.layout.dim]
    rate = _RATE.match(labels[0]) if len(labels) == 2 else None
    found = [_CHANNEL.match(label) for label in labels[1].split(',')] if rate else []
    channels = [match for match in found if match]
    if rate is None or len(channels) != len(found) or len(message.data) % len(found):
        raise UnreadableBagError(
            f'{bag}: {TOPIC}: layout {labels} does not say rate, channels and units of '
            f'{len(message.data)} values'
        )
    return (
        float(rate['rate']),
        tuple(match['name'] for match in channels),
        tuple(match['unit'] for match in channels),
    )
