# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Whole lifts, analysed a few samples at a time so that live samples do not wait for them."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from human_model.exceptions import LiftingError
from human_model.motion import BodyMotion
from muscle_analyzer.core.loads.analysis import JoinedParts, MuscleAnalysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

T = TypeVar('T')

SAMPLES: Final = 2
"""Samples that are analysed in one step: together they take hardly longer than one."""


@dataclass(frozen=True, eq=False)
class WaitingLift:
    """A lift that waits for its analysis.

    Attributes
    ----------
    lift_id, source : str
        As `MuscleAnalyzer.analyze` takes them.
    box_mass : float
        [kg].
    motion : BodyMotion
    tracker_status : (n,) array of int
    """

    lift_id: str
    source: str
    box_mass: float
    motion: BodyMotion
    tracker_status: NDArray[np.int64]


class LiftQueue(Generic[T]):
    """Analyses lifts in the order of their arrival.

    Parameters
    ----------
    results
        Yields the results of a lift's analysis one by one, as their messages are large.
    failed
        Takes a lift and the error that ended its analysis.
    """

    def __init__(
        self,
        results: Callable[[WaitingLift, MuscleAnalyzer, MuscleAnalysis], Iterator[T]],
        failed: Callable[[WaitingLift, LiftingError], None],
    ) -> None:
        self._results = results
        self._failed = failed
        self._lifts: deque[tuple[WaitingLift, Iterator[T | None]]] = deque()

    def __len__(self) -> int:
        """Return the number of lifts that are not finished."""
        return len(self._lifts)

    def add(self, lift: WaitingLift, analyzer: MuscleAnalyzer) -> None:
        """Queue a lift for analysis by the analyzer of its person."""
        self._lifts.append((lift, self._steps(lift, analyzer)))

    def work(self, duration: float) -> Iterator[T]:
        """Continue for about this time [s], at least by one step; yield results."""
        end = time.perf_counter() + duration
        while self._lifts:
            lift, steps = self._lifts[0]
            try:
                result = next(steps)
            except StopIteration:
                self._lifts.popleft()
            except LiftingError as error:
                self._lifts.popleft()
                self._failed(lift, error)
            else:
                if result is not None:
                    yield result
            if time.perf_counter() > end:
                return

    def _steps(self, lift: WaitingLift, analyzer: MuscleAnalyzer) -> Iterator[T | None]:
        """Analyse a lift, then yield its results; None ends a step without a result."""
        parts = JoinedParts(len(lift.motion))
        for k in range(0, len(lift.motion), SAMPLES):
            some = slice(k, k + SAMPLES)
            parts.add(
                analyzer.analyze(
                    lift.motion[some],
                    lift.lift_id,
                    lift.source,
                    lift.tracker_status[some],
                    continued=k > 0,
                )
            )
            yield None
        yield from self._results(lift, analyzer, parts.whole())
