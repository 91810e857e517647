# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The graph's input topics of a bag as arrays, for work without ROS."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings.exceptions import UnreadableBagError
from lifting_recordings.reader import BagLoss, BagReader
from lifting_recordings.recording import Plate

_LATCHED = ('subject', 'task')


@dataclass(frozen=True)
class BagStreams:
    """Input of the graph, times in seconds from `start_ns`.

    Attributes
    ----------
    path : Path
        The bag.
    start_ns : int
        Earliest header stamp of a stream [ns].
    subject, task : object or None
        Decoded messages, fields as in lifting_interfaces; None when the bag has none.
    marker_names : tuple of str
        In the order of their index in the recording.
    marker_time : ndarray (n,)
        [s], strictly increasing.
    marker_frame : ndarray (n,) of int
        Camera frame numbers.
    markers : ndarray (n, m, 3)
        [m]; NaN where not seen.
    plates : dict of str to Plate
        'right', 'left': wrench about the laboratory origin.
    box_time, box_position, box_quaternion : ndarray (k,), (k, 3), (k, 4)
        [s], [m], x y z w; empty when no box is tracked.
    loss : BagLoss or None
        What is missing of a cut-off bag.
    problems : tuple of str
        What was left out and why: stamps that do not increase, values that are not finite.
    """

    path: Path
    start_ns: int
    subject: Any
    task: Any
    marker_names: tuple[str, ...]
    marker_time: Array
    marker_frame: np.ndarray[Any, np.dtype[np.int64]]
    markers: Array
    plates: dict[str, Plate]
    box_time: Array
    box_position: Array
    box_quaternion: Array
    loss: BagLoss | None
    problems: tuple[str, ...]


def load_streams(path: str | Path, namespace: str = '') -> BagStreams:
    """Read the input topics of a bag.

    Parameters
    ----------
    path : str or Path
        The bag.
    namespace : str
        Under which the topics are stored.

    Raises
    ------
    UnreadableBagError
        No bag, or one without markers.
    """
    station = namespace.strip('/')
    prefix = f'/{station}/' if station else '/'
    with BagReader(path) as bag:
        collector = _Collector(bag.path)
        full = {name: '/' + name.lstrip('/') for name in bag.topics}
        known = {
            name: stored.removeprefix(prefix)
            for name, stored in full.items()
            if stored.startswith(prefix) and stored.removeprefix(prefix) in collector.topics
        }
        for name, _, message in bag.messages(list(known)):
            collector.take(known[name], message)
        return collector.result(bag.loss)


class _Collector:
    """Gathers messages per topic, dropping those whose stamp does not increase."""

    topics = (*_LATCHED, 'markers', 'box/pose', *(f'force_plates/{side}/wrench' for side in SIDES))

    def __init__(self, path: Path) -> None:
        self._path = path
        self._messages: dict[str, list[Any]] = {name: [] for name in self.topics}
        self._stamps: dict[str, list[int]] = {name: [] for name in self.topics}
        self._problems: dict[tuple[str, str], list[int]] = {}

    def take(self, topic: str, message: Any) -> None:
        """Keep one message, or note why not."""
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        stamps = self._stamps[topic]
        if topic not in _LATCHED:
            if stamps and stamp <= stamps[-1]:
                kind = 'duplicated' if stamp == stamps[-1] else 'unsorted'
                self._note(topic, f'{kind} stamp', stamp)
                return
            if topic != 'markers' and not np.all(np.isfinite(_numbers(topic, message))):
                self._note(topic, 'value that is not finite', stamp)
                return
        stamps.append(stamp)
        self._messages[topic].append(message)

    def _note(self, topic: str, what: str, stamp: int) -> None:
        self._problems.setdefault((topic, what), []).append(stamp)

    def result(self, loss: BagLoss | None) -> BagStreams:
        """Return the arrays."""
        frames = self._messages['markers']
        if not frames:
            raise UnreadableBagError(f'{self._path}: topic markers holds no usable message')
        streams = [s[0] for t, s in self._stamps.items() if t not in _LATCHED and s]
        start = min(streams)
        order: dict[str, int] = {}
        for frame in frames:
            for marker in frame.markers:
                order.setdefault(marker.marker_name, marker.marker_index)
        names = tuple(sorted(order, key=lambda name: order[name]))
        column = {name: i for i, name in enumerate(names)}
        places = np.full((len(frames), len(names), 3), np.nan)
        for row, frame in zip(places, frames, strict=True):
            for marker in frame.markers:
                t = marker.translation
                row[column[marker.marker_name]] = t.x, t.y, t.z
        # NaN in one coordinate makes the whole marker unseen.
        broken = np.any(np.isnan(places), axis=2) & ~np.all(np.isnan(places), axis=2)
        places[broken] = np.nan
        box = self._messages['box/pose']
        poses = np.array([_numbers('box/pose', m) for m in box]).reshape(-1, 7)
        return BagStreams(
            path=self._path,
            start_ns=start,
            subject=self._last('subject'),
            task=self._last('task'),
            marker_names=names,
            marker_time=self._time('markers', start),
            marker_frame=np.array([m.frame_number for m in frames], dtype=np.int64),
            markers=places,
            plates={
                side: self._plate(side, start)
                for side in SIDES
                if self._messages[f'force_plates/{side}/wrench']
            },
            box_time=self._time('box/pose', start),
            box_position=poses[:, :3].copy(),
            box_quaternion=poses[:, 3:].copy(),
            loss=loss,
            problems=self._said(start),
        )

    def _last(self, topic: str) -> Any:
        return self._messages[topic][-1] if self._messages[topic] else None

    def _time(self, topic: str, start: int) -> Array:
        return np.array([(s - start) * 1e-9 for s in self._stamps[topic]], dtype=np.float64)

    def _plate(self, side: str, start: int) -> Plate:
        topic = f'force_plates/{side}/wrench'
        values = np.array([_numbers(topic, m) for m in self._messages[topic]])
        return Plate(side, self._time(topic, start), values[:, :3].copy(), values[:, 3:].copy())

    def _said(self, start: int) -> tuple[str, ...]:
        return tuple(
            f'{self._path}: {topic}: {len(stamps)} messages left out: {what}, '
            f'first at {(stamps[0] - start) * 1e-9:.3f} s'
            for (topic, what), stamps in self._problems.items()
        )


def _numbers(topic: str, message: Any) -> tuple[float, ...]:
    """Return force and moment, or position and quaternion."""
    if topic == 'box/pose':
        p, q = message.pose.position, message.pose.orientation
        return p.x, p.y, p.z, q.x, q.y, q.z, q.w
    f, m = message.wrench.force, message.wrench.torque
    return f.x, f.y, f.z, m.x, m.y, m.z
