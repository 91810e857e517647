# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Runs from several starts, and from the best of them displaced: there are many local minima.

The displacements are basin hopping (Wales and Doye 1997, Global optimization by basin-hopping, J.
Phys. Chem. A 101) that only goes downhill. Their number is given, and they come from a fixed seed,
so that the answer does not depend on the clock unless the time limit is met.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np

from lift_predictor.core.spatial.grid import SpatialGrid
from lift_predictor.core.spatial.prediction import SpatialOptimum
from lift_predictor.core.spatial.refine import as_start
from lift_predictor.core.spatial.starts import SpatialStart, mirrored

Progress = Callable[[int, int, float], None]
"""Told after each run: runs done, runs in all, best objective so far (NaN: none yet)."""

SPREAD: Final = 0.3
"""Standard deviation of the displacements: the best of 0.15 and 0.3 on ten random lifts [rad]."""
SEED: Final = 7


def runs_from(
    run: Callable[[SpatialStart], SpatialOptimum],
    starts: Sequence[SpatialStart],
    hops: int,
    grid: SpatialGrid,
    deadline: tuple[float, float],
    progress: Progress | None = None,
    mirror: bool = False,
) -> tuple[SpatialOptimum, ...]:
    """Run from all starts, then from the best solution so far, displaced; the best comes first.

    Parameters
    ----------
    run : callable
        Solves the task at the nodes.
    starts : sequence of SpatialStart
        Initial guesses, the most promising first.
    hops : int
        Displaced runs; none where no start led to a solution.
    grid : SpatialGrid
        Sizes of the programme.
    deadline : pair of float
        On the clock of `time.perf_counter`: no start but the first is begun after the first of
        them, no displaced run after the second.
    progress : callable, optional
        Told after each run; what it raises ends the work.
    mirror : bool
        Displace to the other side, see `starts.mirrored`.
    """
    runs: list[SpatialOptimum] = []
    for start in _all_starts(starts, hops, grid, runs, mirror):
        if runs and time.perf_counter() > deadline[len(runs) >= len(starts)]:
            break
        runs.append(run(start))
        if progress is not None:
            solved = [one.solution.objective for one in runs if one.converged]
            progress(len(runs), len(starts) + hops, min(solved, default=float('nan')))
    return tuple(sorted(runs, key=_rank))


def _all_starts(
    starts: Sequence[SpatialStart],
    hops: int,
    grid: SpatialGrid,
    runs: list[SpatialOptimum],
    mirror: bool,
) -> Iterator[SpatialStart]:
    yield from starts
    rng = np.random.default_rng(SEED)
    for number in range(hops):
        best = min(runs, key=_rank)
        if not best.converged:
            break
        yield displaced(as_start(best, grid), number, rng, mirror)


def displaced(
    start: SpatialStart, number: int, rng: np.random.Generator, mirror: bool = False
) -> SpatialStart:
    """Displace a start: by turns the whole motion of each coordinate, and each control value."""
    rows = start.control.shape[0] if number % 2 else 1
    shift = SPREAD * rng.normal(size=(rows, start.control.shape[1]))
    if mirror:
        shift = mirrored(shift)
    return SpatialStart(f'hop {number + 1}', start.control + shift, start.box_mass, start.duration)


def _rank(one: SpatialOptimum) -> tuple[bool, float]:
    return (not one.converged, one.solution.objective if one.converged else one.solution.primal)
