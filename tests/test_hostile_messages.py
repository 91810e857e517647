# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""No message ends a station: whatever comes on a topic is used, or refused in words.

Messages of a recording and of its results are changed at random (numbers that are none, texts that
are paths or megabytes, arrays that do not fit, bytes cut off or flipped) and given to the stations
as the nodes give them.  Any exception but a refusal is a defect.  `make test-long` tries 200 000.
"""

from __future__ import annotations

import resource
import struct
import traceback
from collections import Counter
from copy import deepcopy
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest
from rosbags.serde import SerdeError

from human_model.exceptions import LiftingError
from injury_monitor.station import MonitorStation
from lift_predictor.station import PredictorStation
from lifting_messages import LiftingMessagesError, decode, encode
from lifting_messages.station import Station
from lifting_recordings.reader import BagReader
from motion_tracker.station import TrackerStation
from muscle_analyzer.station import AnalyzerStation

BAG = 'symmetric_7kg'
#: Messages of a topic that are changed, evenly spread over the recording.
ORIGINALS = 12
STATIONS = {
    'tracker': TrackerStation,
    'analyzer': AnalyzerStation,
    'predictor': PredictorStation,
    'monitor': MonitorStation,
}
#: Share of the 200 000: by what a message costs.
LONG = {'tracker': 100_000, 'analyzer': 30_000, 'predictor': 5_000, 'monitor': 65_000}
SHORT = {'tracker': 1500, 'analyzer': 250, 'predictor': 100, 'monitor': 1500}
NUMBERS = (np.nan, np.inf, -np.inf, 1e308, -1e308, 1e-308, -1.0, 0.0, 1e9)
WHOLE = (0, 1, -1, 255, 2**16 - 1, 2**31 - 1, -(2**31), 2**32 - 1)
TEXTS = (
    '', ' ', 'x' * 300, '../../etc/passwd', '/etc/passwd', 'a\nb', 'a\0b', '\n', 'ä' * 1000,
    'x' * 100_000, 'nan', '%s{}', '\u202e',
)  # fmt: skip


def changed_value(rng: np.random.Generator, value: Any) -> Any:
    """Return something hostile of the same type."""
    if isinstance(value, np.ndarray):
        match rng.integers(6):
            case 0:
                return value[:0]
            case 1:
                return np.concatenate([value, value])
            case 2:
                return value[:-1]
            case 3:
                return np.resize(value if value.size else np.zeros(1, value.dtype), 20_000)
        result = value.copy()
        if result.size:
            choices = NUMBERS if result.dtype.kind == 'f' else (0, 1, np.iinfo(result.dtype).max)
            where = rng.random(result.size) < rng.choice([0.05, 1.0])
            result[where] = rng.choice(choices, np.count_nonzero(where))
        return result
    if isinstance(value, bool):
        return not value
    if isinstance(value, float):
        return float(rng.choice(NUMBERS))
    if isinstance(value, int):
        return int(rng.choice(WHOLE))
    if isinstance(value, str):
        return TEXTS[rng.integers(len(TEXTS))]
    return [] if rng.random() < 0.5 else value * 2


def changed(rng: np.random.Generator, message: Any) -> Any:
    """Change one field of a message in place, at any depth; return the message."""
    inside = message
    while True:
        names = [field.name for field in fields(inside) if field.name != '__msgtype__']
        name = names[rng.integers(len(names))]
        value = getattr(inside, name)
        if not is_dataclass(value):
            setattr(inside, name, changed_value(rng, value))
            return message
        inside = value


def hostile(rng: np.random.Generator, message: Any) -> bytes:
    """Return a serialised message with changes in its fields or in its bytes."""
    for _ in range(20):
        try:
            data = encode(changed(rng, deepcopy(message)))
            break
        except (SerdeError, struct.error, OverflowError, TypeError, ValueError):
            continue  # a value that the type cannot hold
    else:
        data = encode(message)
    match rng.integers(8):
        case 0:
            return data[: rng.integers(len(data))]
        case 1:
            flipped = bytearray(data)
            for place in rng.integers(len(data), size=rng.integers(1, 9)):
                flipped[place] ^= 1 << rng.integers(8)
            return bytes(flipped)
        case 2:
            return bytes(rng.integers(256, size=rng.integers(200), dtype=np.uint8))
    return data


@pytest.fixture(scope='module')
def originals(bags: Any, offline: Any) -> dict[str, list]:
    """Return messages of the recording and of its results by topic."""
    found: dict[str, list] = {}
    for path in (bags / BAG, offline(bags / BAG)):
        with BagReader(path) as bag:
            for name, _, message in bag.messages():
                topic = name.strip('/').removeprefix('station_1/')
                found.setdefault(topic, []).append(message)
    found['body_motion'] = [found['measured_lift'][0].motion]
    return {
        topic: messages[:: max(1, len(messages) // ORIGINALS)] for topic, messages in found.items()
    }


def new_station(kind: type[Station], originals: dict[str, list]) -> Station:
    """Return a station that knows person and task."""
    station = kind(name='station_1')
    for topic in ('subject', 'task'):
        list(station.receive(topic, originals[topic][0]))
    return station


def try_station(name: str, originals: dict[str, list], count: int) -> None:
    """Feed hostile messages; fail with each kind of defect, its number and its place."""
    kind = STATIONS[name]
    rng = np.random.default_rng([count, *name.encode()])
    topics = [topic for topic in kind.INPUTS if topic.name in originals]
    station = new_station(kind, originals)
    defects: Counter[str] = Counter()
    refused = 0
    for number in range(count):
        topic = topics[rng.integers(len(topics))]
        messages = originals[topic.name]
        data = hostile(rng, messages[rng.integers(len(messages))])
        try:
            list(station.receive(topic.name, decode(data, topic.type)))
            if name == 'predictor' and number % 25:
                continue  # a prediction takes half a second
            list(station.finish())
        except (LiftingError, LiftingMessagesError):
            refused += 1
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            where = f'{place.filename.rpartition("/src/")[2]}:{place.lineno}'
            defects[f'{topic.name}: {type(error).__name__}: {str(error)[:80]} at {where}'] += 1
        if number % 100 == 99:
            station = new_station(kind, originals)
    assert not defects, '\n'.join(f'{n} x {text}' for text, n in defects.most_common())
    assert refused > count // 20, 'the messages were not hostile'


@pytest.mark.parametrize('name', STATIONS)
def test_hostile_messages(name: str, originals: dict[str, list]) -> None:
    try_station(name, originals, SHORT[name])


@pytest.mark.long
@pytest.mark.parametrize('name', STATIONS)
def test_many_hostile_messages(name: str, originals: dict[str, list]) -> None:
    try_station(name, originals, LONG[name] // 20)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try_station(name, originals, LONG[name] - LONG[name] // 20)
    growth = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert growth < 100_000, f'{growth} kB'
