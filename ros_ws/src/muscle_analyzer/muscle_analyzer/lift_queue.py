# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Whole lifts, analysed a few samples at a time so that live samples do not wait for them."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from human_model.motion import BodyMotion
from muscle_analyzer.core.loads.analysis import JoinedParts, MuscleAnalysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

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


class LiftQueue:
    """Analyses lifts in the order of their arrival.

    Parameters
    ----------
    analyzer
        Of the node.
    done
        Takes a lift and its analysis and hands them over in steps, as their messages are large.
    failed
        Takes a lift and the error that ended its analysis.
    errors
        Errors that mean bad input; others are defects and go on to the caller.
    """

    def __init__(
        self,
        analyzer: MuscleAnalyzer,
        done: Callable[[WaitingLift, MuscleAnalysis], Iterator[None]],
        failed: Callable[[WaitingLift, Exception], None],
        errors: tuple[type[Exception], ...],
    ) -> None:
        self.analyzer = analyzer
        self._done = done
        self._failed = failed
        self._errors = errors
        self._lifts: deque[tuple[WaitingLift, Iterator[None]]] = deque()

    def __len__(self) -> int:
        """Return the number of lifts that are not finished."""
        return len(self._lifts)

    def add(self, lift: WaitingLift) -> None:
        """Take a lift."""
        self._lifts.append((lift, self._steps(lift)))

    def work(self, duration: float) -> None:
        """Go on for about so long [s], at least by one step."""
        end = time.perf_counter() + duration
        while self._lifts:
            lift, steps = self._lifts[0]
            try:
                next(steps)
            except StopIteration:
                self._lifts.popleft()
            except self._errors as error:
                self._lifts.popleft()
                self._failed(lift, error)
            if time.perf_counter() > end:
                return

    def finish(self) -> None:
        """Work off everything at once."""
        while self._lifts:
            self.work(float('inf'))

    def _steps(self, lift: WaitingLift) -> Iterator[None]:
        """Analyse a lift and hand it over."""
        parts = JoinedParts(len(lift.motion))
        for k in range(0, len(lift.motion), SAMPLES):
            some = slice(k, k + SAMPLES)
            parts.add(
                self.analyzer.analyze(
                    lift.motion[some],
                    lift.lift_id,
                    lift.source,
                    lift.tracker_status[some],
                    continued=k > 0,
                )
            )
            yield
        yield from self._done(lift, parts.whole())
