# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where one recording ends and the next begins, when each stream arrives in its own time.

A recording that is played again starts with stamps of the past. Each stream keeps its own order,
but streams overtake each other: when the markers begin anew, plate samples of the recording
before may still come. So every stream counts its own beginnings, and samples of a later recording
wait until no stream is left in the earlier one.

A stamp is checked before it counts. A stamp that jumps is held until the next stamps of its
stream either go on from it, which confirms the jump, or return, which makes it a stray: it is
dropped and counted. A stream whose clock alone was set back does not hold the others for ever:
after `WAIT` seconds by the clock, or `MOST` waiting samples, all streams begin another recording.
"""

from collections import Counter, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

T = TypeVar('T')

#: Stamps this much before the newest one of their stream begin another recording [s]. An
#: engineering choice: messages of one stream overtake each other by less, and a clock that is set
#: moves by more (ntpd slews offsets below its step threshold of 0.128 s, RFC 5905, STEPT).
RESTART = 0.1

#: A stamp this much, or three steps, after the newest one of its stream is held until the next
#: stamps confirm it [s]. An engineering choice: longer than the gaps that are bridged.
LEAP = 0.3

#: Stamps in a row that confirm a jump. An engineering choice: a driver that fails for three
#: samples is still recognized, and 100 Hz confirm a jump in 0.03 s.
CONFIRM = 4

#: Longest time by the clock that samples wait for streams that have not begun anew [s]; the
#: deadline of a diagnostic is 2 s.
WAIT = 1.5

#: Most samples that wait: 16 s of two plates at 2500 Hz, as the history of a subscriber.
MOST = 80_000


@dataclass
class _Stream(Generic[T]):
    newest: float = -float('inf')
    step: float = 0.0
    recording: int = 0
    held: list[tuple[float, T]] = field(default_factory=list)


@dataclass
class RecordingSegmenter(Generic[T]):
    """Sorts the samples of several streams by recording.

    Attributes
    ----------
    restart : float
        See `RESTART` [s].
    clock : callable, optional
        Current time [s] of the machine; without one, samples wait for the other streams as long as
        there is room.
    current : int
        Number of the recording whose samples pass.
    notices : list of str
        Faults of clocks since the owner took them last.
    counts : Counter
        Dropped samples by kind.
    """

    restart: float = RESTART
    clock: Callable[[], float] | None = None
    current: int = 0
    notices: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    _streams: dict[str, _Stream[T]] = field(default_factory=dict)
    _waiting: deque[tuple[int, T]] = field(default_factory=deque)
    _since: float = 0.0

    @property
    def idle(self) -> bool:
        """Whether no stream is known yet."""
        return not self._streams

    def expect(self, streams: Iterable[str]) -> None:
        """Name the streams that will come, so that a late one is not left behind."""
        for name in streams:
            self._streams.setdefault(name, _Stream(recording=self.current))

    def push(
        self, stream: str, stamp: float, sample: T, last: float | None = None
    ) -> list[tuple[int, T]]:
        """Take one sample; return the samples that may pass now, with their recording.

        Parameters
        ----------
        stream
            Name of the stream.
        stamp
            [s].
        sample
            Anything.
        last
            Stamp of the end of a block of samples [s].
        """
        state = self._streams.get(stream)
        if state is None:
            state = self._streams[stream] = _Stream(recording=self.current)
        if state.newest == -float('inf'):
            # The first stamp may be the wrong one: then the others confirm a jump from it.
            return self._accept(state, stamp, [sample], last)
        leap = max(LEAP, 3.0 * state.step)
        if state.newest - self.restart <= stamp <= state.newest + leap:
            self._drop_strays(stream, state)
            return self._accept(state, stamp, [sample], last)
        held = state.held
        if held and not held[-1][0] - self.restart <= stamp <= held[-1][0] + leap:
            self._drop_strays(stream, state)
        held.append((stamp, sample))
        if len(held) < CONFIRM:
            return []
        samples = [sample for _, sample in held]
        back = held[0][0] < state.newest
        earliest, newest = min(at for at, _ in held), max(at for at, _ in held)
        held.clear()
        if not back:
            self.notices.append(
                f'{stream}: stamps leap forward by {earliest - state.newest:.3f} s: a pause, or a '
                'clock that was set'
            )
            return self._accept(state, newest, samples, last)
        self.notices.append(
            f'{stream}: stamps went back by {state.newest - earliest:.3f} s: '
            'another recording begins when the other streams follow'
        )
        state.recording += 1
        state.newest = -float('inf')
        return self._accept(state, newest, samples, last)

    def end(self) -> list[tuple[int, T]]:
        """Return everything that waits, recording by recording: nothing more will come."""
        for name, state in self._streams.items():
            self._drop_strays(name, state)
        passed = sorted(self._waiting, key=lambda entry: entry[0])
        self.current = max((number for number, _ in passed), default=self.current) + 1
        self._waiting.clear()
        self._streams.clear()
        return passed

    def _drop_strays(self, stream: str, state: _Stream[T]) -> None:
        if state.held:
            self.counts[f'{stream}: stamps far from those around them'] += len(state.held)
            state.held.clear()

    def _accept(
        self, state: _Stream[T], stamp: float, samples: list[T], last: float | None
    ) -> list[tuple[int, T]]:
        newest = max(state.newest, stamp if last is None else last)
        if newest > state.newest > -float('inf'):
            state.step = min(newest - state.newest, 1.0)
        state.newest = newest
        if state.recording == self.current:
            passed = [(self.current, sample) for sample in samples]
            return passed + (self._overdue() if self._waiting else [])
        if not self._waiting and self.clock is not None:
            self._since = self.clock()
        self._waiting.extend((state.recording, sample) for sample in samples)
        earliest = min(other.recording for other in self._streams.values())
        if earliest > self.current:
            return self._release(earliest)
        return self._overdue()

    def _overdue(self) -> list[tuple[int, T]]:
        """Return samples that have waited too long for streams whose clocks were not set."""
        late = self.clock is not None and self.clock() - self._since > WAIT
        if not late and len(self._waiting) < MOST:
            return []
        behind = [name for name, one in self._streams.items() if one.recording == self.current]
        self.notices.append(
            'clocks differ: the stamps of '
            + ', '.join(name for name in self._streams if name not in behind)
            + ' went back, those of '
            + ', '.join(behind)
            + ' did not; another recording begins'
        )
        newest = min(number for number, _ in self._waiting)
        for state in self._streams.values():
            state.recording = max(state.recording, newest)
        return self._release(newest)

    def _release(self, recording: int) -> list[tuple[int, T]]:
        self.current = recording
        passed = [entry for entry in self._waiting if entry[0] == recording]
        self._waiting = deque(entry for entry in self._waiting if entry[0] != recording)
        if self._waiting and self.clock is not None:
            self._since = self.clock()
        return passed
