# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Infeasible tasks: which limit breaks first, and the nearest lift that can be done.

A task can ask for too heavy a box or for places that are out of reach, balance or strength. Two
ways lead back, tried in this order: the same lift with the largest mass that can be lifted so (the
programme of the maximum weight, the given mass as its upper bound), and the same mass carried
between places on the way from where it was recorded to where it was asked for. A limit breaks
first if it binds there: with a little more mass, or a little further, there is no lift.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from human_model.report import SolveStatus
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.sagittal.prediction import NearestLift, PredictedLift2D
from lift_predictor.core.sagittal.task import INSTANTS, Box, LiftTask2D
from lift_predictor.core.solvers.optimum import Start

Array = NDArray[np.float64]

TIE_BREAK: Final = 1e-4
"""Factor of the effort [1/s] where the weight alone is maximised: it decides between the lifts of
the same weight, which differ in effort, and costs less than 0.05 % of the weight."""
PLACE_TOLERANCE: Final = 5e-3
"""Distance [m] to which the nearest place is found."""
ALL: Final = 0.999
"""Share of a mass that counts as all of it."""
HOPELESS: Final = (
    SolveStatus.PREDICTOR_INFEASIBLE,
    SolveStatus.PREDICTOR_UNREACHABLE,
    SolveStatus.PREDICTOR_NOT_CONVERGED,
    SolveStatus.PREDICTOR_VERIFICATION_FAILED,
)
"""Outcomes after which it is asked what is feasible."""
POSTURE: Final = 'posture (4.8)'

Solve = Callable[[LiftTask2D, Sequence[Start]], PredictedLift2D]
Attempt = Callable[[float], PredictedLift2D]


def lighter_lift(solve: Solve, task: LiftTask2D, starts: Sequence[Start]) -> NearestLift | None:
    """Find the same lift with the largest mass up to the task's.

    Parameters
    ----------
    solve : callable
        Solves a task and checks the solution.
    task : LiftTask2D
        Without a solution for its mass.
    starts : sequence of Start
        Initial guesses.

    Returns
    -------
    NearestLift or None
        None: not even empty hands can move so, or all of the mass can be lifted.
    """
    asked = float(task.bounds.box_mass[1])
    if asked == 0.0:
        return None
    parameters = replace(task.parameters, objective=np.array([TIE_BREAK, 1.0]))
    bounds = replace(task.bounds, box_mass=np.array([0.0, asked]))
    # Half the mass asked for is nearer to what is possible than all of it.
    begun = [replace(start, box_mass=0.5 * asked) for start in starts]
    found = solve(replace(task, parameters=parameters, bounds=bounds), begun)
    if not found.report.ok or found.box_mass > ALL * asked:
        return None
    return NearestLift(
        limit=first_limit([name for name, _ in found.optima[0].binding]),
        change=f'{found.box_mass:.2f} kg instead of {asked:.2f} kg',
        prediction=found,
    )


def closer_lift(
    attempt: Attempt, failed: PredictedLift2D, reach: float, change: Callable[[float], str]
) -> NearestLift | None:
    """Find the lift nearest to the places asked for, on the way from those of the recorded lift.

    Parameters
    ----------
    attempt : callable
        Predicts with a share, 0 to 1, of the way from recorded places to those asked for.
    failed : PredictedLift2D
        What became of the places asked for.
    reach : float
        Length of the whole way [m].
    change : callable
        Says in words what a share changes.

    Returns
    -------
    NearestLift or None
        None: the recorded places cannot be met either.
    """
    nearest = attempt(0.0)
    if not nearest.report.ok:
        return None
    low, high = 0.0, 1.0
    while (high - low) * reach > PLACE_TOLERANCE:
        middle = 0.5 * (low + high)
        tried = attempt(middle)
        if tried.report.ok:
            nearest, low = tried, middle
        else:
            failed, high = tried, middle
    return NearestLift(_limit_of(failed), change(low), nearest)


def with_nearest(failed: PredictedLift2D, nearest: NearestLift | None) -> PredictedLift2D:
    """Add to a failed result what was found to be feasible; None adds nothing."""
    if nearest is None:
        return failed
    status = failed.report.status
    if status is not SolveStatus.PREDICTOR_UNREACHABLE:
        # The solver may have given up in other words; that less can be done says why.
        status = SolveStatus.PREDICTOR_INFEASIBLE
    message = (
        f'no feasible motion: {nearest.limit} breaks first; nearest feasible lift: '
        f'{nearest.change}; {failed.report.message}'
    )
    report = replace(failed.report, status=status, message=message)
    return replace(failed, report=report, nearest=nearest)


def first_limit(binding: Sequence[str]) -> str:
    """Name of the first limit of the person or the world; a posture only if there is no other."""
    own = [name for name in binding if not name.startswith(POSTURE)]
    return (own or list(binding) or ['none'])[0]


def _limit_of(failed: PredictedLift2D) -> str:
    if failed.optima and failed.optima[0].violated:
        return failed.optima[0].violated
    if failed.verification is not None and not failed.verification.passed:
        return failed.verification.failures()
    where, _, details = failed.report.message.partition(': ')
    joints = details.rsplit('; ', 1)[-1]
    return f'reach of the hands ({where}; {joints})' if joints else f'reach of the hands ({where})'


def way_to(task: LiftTask2D, box: Box) -> Array:
    """Return the way (2, 2) of the grip at start and end, recorded to asked for [m].

    Parameters
    ----------
    task : LiftTask2D
        With the recorded places.
    box : Box
        With the places asked for.
    """
    way = np.zeros((2, 2))
    for row, place in enumerate((box.start, box.end)):
        if place is not None:
            grip = task.plane.into(np.asarray(place, dtype=float)) - task.parameters.box_from_hand
            way[row] = grip - task.bounds.hand[row]
    return way


def missing_way(way: Array, share: float) -> str:
    """Say how far the places of a share of the way are from those asked for."""
    words = []
    for row, when in enumerate((INSTANTS[0], INSTANTS[-1])):
        forward, up = (share - 1.0) * way[row]
        parts = [
            f'{1e3 * abs(amount):.0f} mm {more if amount > 0.0 else less}'
            for amount, more, less in (
                (forward, 'farther forward', 'nearer'),
                (up, 'higher', 'lower'),
            )
            if abs(amount) >= 5e-4
        ]
        if parts:
            words.append(f'the {when} {" and ".join(parts)} than asked for')
    if not words:
        raise TaskError('the places asked for are those of the recorded lift')
    return ', '.join(words)
