# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift run --offline`: the stations of the graph in one process, without middleware.

Every output goes to the inputs of the other stations, as the topics of the graph do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from injury_monitor.station import MonitorStation
from lift_predictor.station import PredictorStation
from lifting_cli.graph_errors import SessionError
from lifting_cli.live.state import FOLLOWED, LiveState
from lifting_cli.live.view import LiveView
from lifting_cli.recording_summary import NO_LIFT, gauge_limits, summarise
from lifting_cli.topics import RESULT_TOPICS
from lifting_messages import Message
from lifting_messages.station import Output, Station
from lifting_recordings.reader import BagReader
from lifting_report.results_writer import ResultsWriter
from motion_tracker.station import TrackerStation
from muscle_analyzer.station import AnalyzerStation

Emit = Callable[[str, Message], None]


class _Warnings:
    """A log that passes on warnings and errors."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        self.warning = self.error = warn

    def info(self, message: str, /) -> None:
        """Do nothing."""


class OfflineGraph:
    """The stations of the four packages, joined by calls instead of topics.

    Parameters
    ----------
    name : str
        Name of the station, which the alarms carry.
    emit : callable
        Takes topic and message of each output.
    warn : callable
        Takes each warning and input error as a text.
    """

    def __init__(self, name: str, emit: Emit, warn: Callable[[str], None]) -> None:
        self._emit = emit
        log = _Warnings(warn)
        self._tracker = TrackerStation(name=name, log=log)
        self._stations: tuple[Station, ...] = (
            self._tracker,
            AnalyzerStation(name=name, log=log),
            PredictorStation(name=name, log=log),
            MonitorStation(name=name, log=log),
        )
        self._readers: dict[str, list[Station]] = {}
        for station in self._stations:
            for topic in station.INPUTS:
                self._readers.setdefault(topic.name, []).append(station)
        for station in self._stations:
            station.has_subscribers = lambda topic: topic in {*self._readers, *RESULT_TOPICS}

    def feed(self, topic: str, message: Message) -> None:
        """Take a message of the recording, and do all work that it causes."""
        self._deliver(topic, message)
        self._work()

    def flush(self) -> None:
        """End the recording.

        Raises
        ------
        SessionError
            If nothing was tracked.
        """
        if self._tracker.tracker is None:
            raise SessionError(
                'nothing was tracked: subject and task are missing or were refused; '
                f'{self._tracker.waiting} samples left out'
            )
        for station in self._stations:
            self._route(station.flush())
            self._work()

    def _deliver(self, topic: str, message: Message) -> None:
        for station in self._readers.get(topic, ()):
            with station.guard(topic):
                self._route(station.receive(topic, message))

    def _route(self, outputs: Iterable[Output]) -> None:
        for topic, message in outputs:
            self._emit(topic, message)
            self._deliver(topic, message)

    def _work(self) -> None:
        while any(station.pending for station in self._stations):
            for station in self._stations:
                self._route(station.finish())


def run_offline(bag_path: Path, output: Path, station: str = 'station_1') -> Path:
    """Run a recording through the stations; return the results file.

    Raises
    ------
    lifting_recordings.exceptions.BagError
        If the recording cannot be read.
    SessionError
        If it has no subject and task.
    """
    summary = summarise(bag_path)
    output.mkdir(parents=True, exist_ok=True)
    results = output / 'results.mcap'
    state = LiveState(summary.start)
    view = LiveView(state, summary.duration, gauge_limits(summary))
    with BagReader(bag_path) as bag, ResultsWriter(results, station) as writer, view:

        def emit(topic: str, message: Message) -> None:
            if topic in RESULT_TOPICS:
                writer.write(topic, message)
            if topic in FOLLOWED:
                view.add(state.update(message))
                view.refresh()

        graph = OfflineGraph(station, emit, view.warn)
        names = {name: name.strip('/') for name in bag.topics}
        wanted = [n for n, short in names.items() if short in (*summary.inputs, 'subject', 'task')]
        for name, _, message in bag.messages(wanted):
            graph.feed(names[name], message)
            if names[name] in ('subject', 'task'):
                writer.write_decoded(names[name], message, bag.types)
        graph.flush()
        if not state.lifts_ended:
            view.warn(NO_LIFT)
        if bag.loss is not None:
            view.warn(str(bag.loss))
    return results
