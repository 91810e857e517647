# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The part of one package in the graph, without ROS: messages in, messages out.

A node, the offline run and the tests drive the same stations, so they give the same messages.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, ClassVar, Protocol, TypeAlias

from human_model.exceptions import LiftingError
from lifting_messages.exceptions import TopicError
from lifting_messages.message_types import Message
from lifting_messages.parameters import defaults
from lifting_messages.topics import Topic

#: Topic and message.
Output: TypeAlias = tuple[str, Message]


class Log(Protocol):
    """The methods that the loggers of rclpy and of Python share."""

    def info(self, message: str, /) -> object:
        """Log information."""

    def warning(self, message: str, /) -> object:
        """Log a warning."""

    def error(self, message: str, /) -> object:
        """Log an error."""


class NoLog:
    """A log that keeps nothing."""

    def info(self, message: str, /) -> None:
        """Do nothing."""

    def warning(self, message: str, /) -> None:
        """Do nothing."""

    def error(self, message: str, /) -> None:
        """Do nothing."""


class Station:
    """Messages of the input topics to messages of the output topics.

    A subclass sets `PACKAGE`, `INPUTS` and `OUTPUTS` and fills `handlers` in `prepare`. Results
    of whole lifts that take long are computed in `work`, in bounded steps, while live samples
    come in between.

    Parameters
    ----------
    values : mapping, optional
        Parameters of the package by name; the defaults of its `data/parameters.yaml` if absent.
    name : str
        Name of the station: the namespace of its topics.
    log : Log, optional
    clock : callable, optional
        Current time [s] for live streams, by which late results are given up; None for files,
        where nothing is late.

    Attributes
    ----------
    handlers : dict
        Function of each input topic.
    counts : Counter
        Messages and errors by kind, for diagnostics.
    last_error : str
    has_subscribers, has_publishers : callable
        Whether an output is subscribed to, and an input is published.
    """

    PACKAGE: ClassVar[str]
    INPUTS: ClassVar[tuple[Topic, ...]]
    OUTPUTS: ClassVar[tuple[Topic, ...]]

    def __init__(
        self,
        values: Mapping[str, Any] | None = None,
        name: str = '',
        log: Log | None = None,
        clock: Callable[[], float] | None = None,
    ) -> None:
        self.values = defaults(self.PACKAGE) if values is None else values
        self.name = name.strip('/')
        self.log: Log = NoLog() if log is None else log
        self.clock = clock
        self.handlers: dict[str, Callable[[Message], Iterator[Output]]] = {}
        self.counts: Counter[str] = Counter()
        self.last_error = ''
        self.has_subscribers: Callable[[str], bool] = lambda _: True
        self.has_publishers: Callable[[str], bool] = lambda _: False
        self.prepare()

    def prepare(self) -> None:
        """Create what the parameters ask for, and fill `handlers`; the constructor calls it."""

    def warm_up(self) -> None:
        """Load what the first messages need: models and compiled functions."""

    def receive(self, topic: str, message: Message) -> Iterator[Output]:
        """Take a message of an input topic; yield the messages of the output topics.

        Raises
        ------
        LiftingError
            If the package refuses the message.
        TopicError
            If the topic is none of `INPUTS`.
        """
        handler = self.handlers.get(topic)
        if handler is None:
            raise TopicError(self.PACKAGE, topic)
        return handler(message)

    @contextmanager
    def guard(self, topic: str) -> Iterator[None]:
        """Count a message; report the exception of refused input instead of raising it.

        Any other exception is a defect and raised.
        """
        self.counts[topic] += 1
        try:
            yield
        except LiftingError as error:
            self.report_error(f'{topic}: {error}')

    def start(self) -> Iterator[Output]:
        """Yield the messages for subscribers when the node becomes active."""
        return iter(())

    def tick(self) -> Iterator[Output]:
        """Yield the messages that the clock of the machine causes; called once a second."""
        return iter(())

    def close(self) -> None:
        """Close the files."""

    @property
    def pending(self) -> bool:
        """Whether `work` has something to do."""
        return False

    def work(self, duration: float) -> Iterator[Output]:
        """Work on whole lifts for about this time [s], at least by one step."""
        del duration
        return iter(())

    def flush(self) -> Iterator[Output]:
        """Give out everything that waits: no further input will come."""
        return iter(())

    def finish(self) -> Iterator[Output]:
        """Finish all pending work."""
        while self.pending:
            yield from self.work(float('inf'))

    def report_error(self, text: str) -> None:
        """Count an input error; log it unless it repeats the last one."""
        self.counts['errors'] += 1
        if text != self.last_error:
            self.log.error(text)
        self.last_error = text
