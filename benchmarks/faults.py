# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of the input streams, each played into tracker and analysis: wrong loads that look good.

A case is wrong when the peak L5-S1 compression of its good samples, live or of the measured lift,
differs by more than 2 % from the peak of the recording without a fault. A live peak that is
missing because its samples are marked is not wrong; neither is a lift that is marked itself.

    .venv/bin/python -m benchmarks.faults [NAME ...]
"""

import json
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from lifting_messages.conversions import subject_from_msg
from lifting_recordings.reader import BagReader
from motion_tracker.core.tracked import MeasuredLift, TrackedFrame
from motion_tracker.station import TrackerStation
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

ROOT = Path(__file__).resolve().parents[1]
BAG = ROOT / 'bags' / 'symmetric_12kg'
RESULTS = ROOT / 'benchmarks' / 'results' / 'faults.json'

#: Deviation of a peak that counts as wrong.
TOLERANCE = 0.02

STREAMS = {
    'markers': 'markers',
    'box/pose': 'box',
    'force_plates/right/wrench': 'right',
    'force_plates/left/wrench': 'left',
}


@dataclass(frozen=True)
class Sample:
    """A message of a stream, with its stamp and the time of its arrival [s]."""

    stream: str
    stamp: float
    arrival: float
    topic: str
    message: Any

    def moved(self, seconds: float) -> 'Sample':
        """Return the sample with another stamp."""
        return replace(self, stamp=self.stamp + seconds)

    def stamped(self) -> Any:
        """Return the message with the stamp of the sample."""
        nanoseconds = round(self.stamp * 1e9)
        stamp = replace(
            self.message.header.stamp,
            sec=nanoseconds // 10**9,
            nanosec=nanoseconds % 10**9,
        )
        return replace(self.message, header=replace(self.message.header, stamp=stamp))


#: Fault: samples of a recording with stamps from 0, to samples in the order of their arrival.
Fault = Callable[[list[Sample]], list[Sample]]


@cache
def recording() -> tuple[Any, Any, tuple[Sample, ...]]:
    """Subject, task and samples of the recording; stamps from 1000 s."""
    subject = task = None
    samples = []
    with BagReader(BAG) as reader:
        for name, _, message in reader.messages(list(reader.topics)):
            topic = name.strip('/')
            if topic == 'subject':
                subject = message
            elif topic == 'task':
                task = message
            else:
                stamp = message.header.stamp
                time = 1000.0 + (stamp.sec - 10**9) + stamp.nanosec * 1e-9
                samples.append(Sample(STREAMS[topic], time, time, topic, message))
    return subject, task, tuple(samples)


@dataclass
class Outcome:
    """Result of a case.

    Attributes
    ----------
    frames, good : int
        Live samples before the end of the recording is stated, and those with a good load.
    live : float
        Peak of the good live samples [N].
    assessed : list of float
        Peak of the good samples of each measured lift [N]; NaN for a lift whose report is not
        good.
    reports : list of str
        Of the lifts: status, good samples, samples, and the message.
    time, load : ndarray
        Of the live samples [s], [N]; NaN where the status is not good.
    """

    frames: int = 0
    good: int = 0
    live: float = np.nan
    assessed: list[float] = field(default_factory=list)
    reports: list[str] = field(default_factory=list)
    time: np.ndarray = field(default_factory=lambda: np.zeros(0))
    load: np.ndarray = field(default_factory=lambda: np.zeros(0))


@cache
def analyzer() -> MuscleAnalyzer:
    """Return the analyzer of the person of the recording."""
    return MuscleAnalyzer(subject_from_msg(recording()[0]))


def play(samples: Iterable[Sample]) -> Outcome:
    """Play samples into the tracker in real time of their arrival, and compute their loads."""
    subject, task, _ = recording()
    now = [0.0]
    station = TrackerStation(clock=lambda: now[0])
    outputs: list[Any] = [*station.track('subject', subject), *station.track('task', task)]
    for sample in samples:
        now[0] = sample.arrival
        outputs += station.track(sample.topic, sample.stamped())
    outcome = Outcome()
    frames = [output for output in outputs if isinstance(output, TrackedFrame)]
    outputs += station.end()
    outcome.frames = len(frames)
    times, loads = [], []
    for frame in frames:
        analysis = analyzer().analyze(frame.motion, '', 'live', [int(frame.status)])
        good = analysis.spine_status[0] == 0
        times.append(float(frame.motion.time[0]))
        loads.append(float(analysis.compression[0]) if good else np.nan)
    outcome.time, outcome.load = np.array(times), np.array(loads)
    outcome.good = int(np.isfinite(outcome.load).sum())
    outcome.live = float(np.nanmax(outcome.load)) if outcome.good else np.nan
    for lift in (output for output in outputs if isinstance(output, MeasuredLift)):
        analysis = analyzer().analyze(lift.lift.motion, lift.lift.lift_id, 'measured', lift.status)
        good = analysis.spine_status == 0
        peak = float(analysis.compression[good].max()) if good.any() else np.nan
        outcome.assessed.append(peak)
        outcome.reports.append(
            f'{int(lift.lift.report.status)}/{good.sum()}/{len(good)} {lift.lift.report.message}'
        )
    return outcome


def gone(stream: str, start: float, end: float) -> Fault:
    """Return the fault of a stream without samples between two times [s]."""
    return lambda samples: [
        s for s in samples if s.stream != stream or not start <= s.arrival - 1000.0 < end
    ]


def one_stamp(stream: str, at: float, offset: float, count: int = 1) -> Fault:
    """Return the fault of ``count`` samples from ``at`` with stamps off by ``offset`` [s]."""

    def fault(samples: list[Sample]) -> list[Sample]:
        result, left = [], count
        for s in samples:
            if left and s.stream == stream and s.arrival - 1000.0 >= at:
                left -= 1
                result.append(s.moved(offset))
            else:
                result.append(s)
        return result

    return fault


def stepped(streams: Sequence[str], at: float, offset: float) -> Fault:
    """Return the fault of a clock that steps by ``offset`` at a time [s]."""
    return lambda samples: [
        s.moved(offset) if s.stream in streams and s.arrival - 1000.0 >= at else s for s in samples
    ]


def jitter(streams: Sequence[str], rms: float) -> Fault:
    """Return the fault of stamps with normally distributed errors [s]."""

    def fault(samples: list[Sample]) -> list[Sample]:
        rng = np.random.default_rng(5)
        return [
            s.moved(float(rng.normal(0.0, rms))) if s.stream in streams else s for s in samples
        ]

    return fault


def stamped_on_arrival(streams: Sequence[str], rms: float) -> Fault:
    """Return the fault of stamps of the arrival, which is delayed at random but in order."""

    def fault(samples: list[Sample]) -> list[Sample]:
        rng = np.random.default_rng(6)
        last = dict.fromkeys(STREAMS.values(), 0.0)
        result = []
        for s in samples:
            if s.stream in streams:
                at = max(last[s.stream] + 1e-5, s.arrival + abs(float(rng.normal(0.0, rms))))
                last[s.stream] = at
                result.append(replace(s, stamp=at, arrival=at))
            else:
                result.append(s)
        return sorted(result, key=lambda s: s.arrival)

    return fault


def out_of_order(streams: Sequence[str], delay: float, exchanged: float = 0.0) -> Fault:
    """Return the fault of messages on the way for up to ``delay`` [s], each its own time."""

    def fault(samples: list[Sample]) -> list[Sample]:
        rng = np.random.default_rng(7)
        result = []
        for s in samples:
            if s.stream in streams:
                extra = float(rng.uniform(0.0, delay))
                if exchanged and rng.uniform() >= exchanged:
                    extra = 0.0
                result.append(replace(s, arrival=s.arrival + extra))
            else:
                result.append(s)
        return sorted(result, key=lambda s: s.arrival)

    return fault


def lost(stream: str, share: float) -> Fault:
    """Return the fault of a share of samples that are lost."""

    def fault(samples: list[Sample]) -> list[Sample]:
        rng = np.random.default_rng(8)
        return [s for s in samples if s.stream != stream or rng.uniform() >= share]

    return fault


def box_moved(
    start: float, end: float, change: Callable[[float, np.ndarray], np.ndarray]
) -> Fault:
    """Return the fault of box poses changed between two times [s]."""

    def fault(samples: list[Sample]) -> list[Sample]:
        held: list[np.ndarray] = []
        result = []
        for s in samples:
            if s.stream == 'box' and start <= s.arrival - 1000.0 < end:
                p = s.message.pose.position
                place = np.array([p.x, p.y, p.z])
                held.append(place)
                x, y, z = change(s.arrival - 1000.0, held[0] if change is frozen else place)
                position = replace(p, x=float(x), y=float(y), z=float(z))
                pose = replace(s.message.pose, position=position)
                result.append(replace(s, message=replace(s.message, pose=pose)))
            else:
                result.append(s)
        return result

    return fault


def frozen(_time: float, place: np.ndarray) -> np.ndarray:
    """Return the first place."""
    return place


def shifted(*offset: float) -> Callable[[float, np.ndarray], np.ndarray]:
    """Return a change by an offset [m]."""
    return lambda _time, place: place + np.array(offset)


def noisy(rms: float) -> Callable[[float, np.ndarray], np.ndarray]:
    """Return a change by noise [m]."""
    rng = np.random.default_rng(9)
    return lambda _time, place: place + rng.normal(0.0, rms, 3)


def twice(fault: Fault) -> Fault:
    """Return the fault in the first of two passes of the recording, 9 s apart."""

    def both(samples: list[Sample]) -> list[Sample]:
        first = fault(samples)
        again = [replace(s, stamp=s.stamp + 9.0, arrival=s.arrival + 9.0) for s in samples]
        return first + again

    return both


ALL = tuple(STREAMS.values())
PLATES = ('right', 'left')

CASES: dict[str, Fault] = {
    'clean': lambda samples: samples,
    'twice': twice(lambda samples: samples),
    'box gone 4.4 to 5.4 s': gone('box', 4.4, 5.4),
    'box gone 3.9 to 4.9 s': gone('box', 3.9, 4.9),
    'box gone 4.4 to 4.6 s': gone('box', 4.4, 4.6),
    'box gone 50 ms': gone('box', 4.4, 4.45),
    'box gone 5.2 to 6.2 s': gone('box', 5.2, 6.2),
    'box gone from 4.5 s': gone('box', 4.5, 99.0),
    'box gone until 4.3 s': gone('box', -1.0, 4.3),
    'box frozen 4.4 to 5.4 s': box_moved(4.4, 5.4, frozen),
    'box frozen 4.2 s on': box_moved(4.2, 99.0, frozen),
    'box frozen 5.0 to 5.2 s': box_moved(5.0, 5.2, frozen),
    'box stray 30 cm, 1 frame': box_moved(4.6, 4.609, shifted(0.3, 0.0, 0.0)),
    'box stray 5 cm up, 1 frame': box_moved(4.6, 4.609, shifted(0.0, 0.0, 0.05)),
    'box stray 30 cm up, 0.2 s': box_moved(4.6, 4.8, shifted(0.0, 0.0, 0.3)),
    'box shifted 10 cm in the lift': box_moved(4.6, 5.0, shifted(0.1, 0.0, 0.0)),
    'box shifted 5 cm up, 1 s': box_moved(4.3, 5.3, shifted(0.0, 0.0, 0.05)),
    'box noise 5 mm in the lift': box_moved(4.2, 5.6, noisy(0.005)),
    'box at the origin 0.3 s': box_moved(4.6, 4.9, lambda _t, p: 0.0 * p),
    'one marker frame +1e6 s': twice(one_stamp('markers', 1.0, 1e6)),
    'one marker frame +10 s': twice(one_stamp('markers', 1.0, 10.0)),
    'one marker frame +0.5 s': one_stamp('markers', 4.5, 0.5),
    'one marker frame -1e6 s': twice(one_stamp('markers', 1.0, -1e6)),
    'three marker frames +1e6 s': twice(one_stamp('markers', 1.0, 1e6, 3)),
    'one plate sample +1e6 s': twice(one_stamp('right', 1.0, 1e6)),
    'one box pose +1e6 s': twice(one_stamp('box', 1.0, 1e6)),
    'one box pose -1e6 s': twice(one_stamp('box', 1.0, -1e6)),
    'cameras back 5 s': twice(stepped(('markers', 'box'), 6.5, -5.0)),
    'markers back 5 s': twice(stepped(('markers',), 6.5, -5.0)),
    'plates back 5 s': twice(stepped(PLATES, 6.5, -5.0)),
    'all back 0.5 s in the lift': stepped(ALL, 4.7, -0.5),
    'all back 2 s in the lift': stepped(ALL, 4.7, -2.0),
    'all forward 1 h in the lift': stepped(ALL, 4.7, 3600.0),
    'all forward 0.5 s in the lift': stepped(ALL, 4.7, 0.5),
    'markers jitter 1 ms': jitter(('markers',), 0.001),
    'markers jitter 3 ms': jitter(('markers',), 0.003),
    'markers and box jitter 3 ms': jitter(('markers', 'box'), 0.003),
    'markers and box on arrival 3 ms': stamped_on_arrival(('markers', 'box'), 0.003),
    'all on arrival 3 ms': stamped_on_arrival(ALL, 0.003),
    'all out of order 5 ms': out_of_order(ALL, 0.005),
    'all out of order 50 ms': out_of_order(ALL, 0.05),
    'all 2 % exchanged, 50 ms': out_of_order(ALL, 0.05, 0.02),
    'markers gone 0.5 s': gone('markers', 4.4, 4.9),
    'markers gone 50 ms': gone('markers', 4.5, 4.55),
    'markers lost 1 %': lost('markers', 0.01),
    'markers lost 10 %': lost('markers', 0.1),
    'plates lost 1 %': lost('right', 0.01),
    'right plate gone 20 ms': gone('right', 4.6, 4.62),
    'right plate gone 0.3 s': gone('right', 4.6, 4.9),
    'plates offset 3 s': lambda samples: [
        s.moved(3.0) if s.stream in PLATES else s for s in samples
    ],
}


def wrong(outcome: Outcome, clean: Outcome) -> list[str]:
    """Return in words which peaks are wrong although they look good."""
    found = []
    peak = int(np.nanargmax(clean.load))
    near = np.abs(outcome.time - clean.time[peak]) < 0.015
    covered = bool(near.any()) and bool(np.isfinite(outcome.load[near]).all())
    high = outcome.live > (1 + TOLERANCE) * clean.live
    low = covered and outcome.live < (1 - TOLERANCE) * clean.live
    if high or low:
        found.append(f'live {outcome.live:.0f} N')
    for value, report in zip(outcome.assessed, outcome.reports, strict=True):
        if report.startswith('0/') and abs(value / clean.assessed[0] - 1) > TOLERANCE:
            found.append(f'assessed {value:.0f} N')
    return found


def main(names: Sequence[str]) -> None:
    """Run the cases and write the results."""
    _, _, samples = recording()
    clean = play(samples)
    rows, wrongs = {}, 0
    for name, fault in CASES.items():
        if names and not any(part in name for part in names):
            continue
        outcome = play(fault(list(samples)))
        found = wrong(outcome, clean)
        wrongs += bool(found)
        print(f'{name:34s} {outcome.live:5.0f} N', *outcome.assessed, *found)
        rows[name] = {
            'live_peak_n': round(outcome.live, 1) if outcome.good else None,
            'assessed_n': [
                round(peak, 1) if np.isfinite(peak) else None for peak in outcome.assessed
            ],
            'reports': outcome.reports,
            'wrong_with_good_status': found,
        }
    if not names:
        results = {'cases': len(rows), 'wrong_with_good_status': wrongs, 'rows': rows}
        RESULTS.write_text(json.dumps(results, indent=1) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main(sys.argv[1:])
