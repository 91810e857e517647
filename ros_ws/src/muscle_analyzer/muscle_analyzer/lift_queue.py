# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Whole lifts, analysed a few samples at a time so that live samples do not wait for them."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from human_model.motion import BodyMotion
from muscle_analyzer.core.analyzer import MuscleAnalyzer
from muscle_analyzer.core.muscle_analysis import MuscleAnalysis, joined


@dataclass(eq=False)
class WaitingLift:
    """
    A lift that waits for its analysis, or is in the middle of it.

    Attributes
    ----------
    lift_id, source : str
        As `MuscleAnalyzer.analyze` takes them.
    box_mass : float
        [kg].
    motion : BodyMotion
    tracker_status : (n,) array of int
    parts : list of MuscleAnalysis
        What has been analysed, sample by sample.
    """

    lift_id: str
    source: str
    box_mass: float
    motion: BodyMotion
    tracker_status: NDArray[np.int64]
    parts: list[MuscleAnalysis] = field(default_factory=list)


class LiftQueue:
    """
    Analyses lifts in the order of their arrival.

    Parameters
    ----------
    analyzer
        Of the node.
    done
        Takes a lift and its analysis.
    failed
        Takes a lift and the error that ended its analysis.
    errors
        Errors that mean bad input; others are defects and go on to the caller.
    """

    def __init__(
        self,
        analyzer: MuscleAnalyzer,
        done: Callable[[WaitingLift, MuscleAnalysis], None],
        failed: Callable[[WaitingLift, Exception], None],
        errors: tuple[type[Exception], ...],
    ) -> None:
        self._analyzer = analyzer
        self._done = done
        self._failed = failed
        self._errors = errors
        self._lifts: deque[WaitingLift] = deque()

    def __len__(self) -> int:
        """Give the number of lifts that are not finished."""
        return len(self._lifts)

    def add(self, lift: WaitingLift) -> None:
        """Take a lift."""
        self._lifts.append(lift)

    def work(self, duration: float) -> None:
        """
        Go on for about so long [s], at least by one sample.

        A lift is handed over in a call of its own: its messages are large.
        """
        end = time.perf_counter() + duration
        while self._lifts:
            lift = self._lifts[0]
            k = len(lift.parts)
            try:
                if k == len(lift.motion):
                    self._lifts.popleft()
                    self._done(lift, joined(lift.parts))
                    return
                status = lift.tracker_status[k : k + 1]
                lift.parts.append(
                    self._analyzer.analyze(
                        lift.motion[k], lift.lift_id, lift.source, status, continued=k > 0
                    )
                )
            except self._errors as error:
                if self._lifts and self._lifts[0] is lift:
                    self._lifts.popleft()
                self._failed(lift, error)
                return
            if time.perf_counter() > end:
                return

    def finish(self) -> None:
        """Work off everything at once."""
        while self._lifts:
            self.work(float('inf'))
