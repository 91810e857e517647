# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The nearest feasible lift of an infeasible task: with less mass, or at other places of the box.

A constraint becomes infeasible first if it is active in the nearest feasible lift: with a little
more mass, or a little further, there is no solution.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final, Protocol

from human_model.report import SolveStatus
from lift_predictor.core.problem.prediction import NearestLift, Prediction

REGULARISATION: Final = 1e-4
"""Factor of the effort [1/s] where the weight alone is maximised: it decides between the lifts of
the same weight, which differ in effort, and costs less than 0.05 % of the weight."""
PLACE_TOLERANCE: Final = 5e-3
"""Distance [m] to which the nearest place is found."""
WHOLE_MASS: Final = 0.999
"""Fraction of a mass that counts as all of it."""
INFEASIBLE_STATUSES: Final = (
    SolveStatus.PREDICTOR_INFEASIBLE,
    SolveStatus.PREDICTOR_UNREACHABLE,
    SolveStatus.PREDICTOR_NOT_CONVERGED,
    SolveStatus.PREDICTOR_VERIFICATION_FAILED,
)
"""Statuses after which the nearest feasible lift is sought."""
DEMANDS: Final = ('posture', 'window', 'technique')
"""First words of constraints that are no limit of the person or the world: the recording or the
task demands them."""


class Way(Protocol):
    """Way of the box from an easy place to the one asked for."""

    @property
    def length(self) -> float:
        """Length [m]."""
        ...

    def at(self, fraction: float) -> tuple[float, float, float]:
        """Return the place in the laboratory at a fraction of the way: 1 is the one asked for."""
        ...

    def missing(self, fraction: float) -> str:
        """Describe the rest of the way from a fraction on; empty: less than half a millimetre."""
        ...


def reduced_mass(found: Prediction, asked: float) -> NearestLift | None:
    """Return the lift with the largest mass up to the one asked for [kg] as the nearest.

    None: not even empty hands can move so, or all of the mass can be lifted.
    """
    if not found.report.ok or found.box_mass > WHOLE_MASS * asked:
        return None
    change = f'{found.box_mass:.2f} kg instead of {asked:.2f} kg'
    return NearestLift(first_limit(found.active_constraints), change, found)


def relax_placement(
    attempt: Callable[[float], Prediction], failed: Prediction, ways: Mapping[str, Way]
) -> NearestLift | None:
    """Find the feasible lift nearest to the places asked for, by bisection of the way to them.

    Parameters
    ----------
    attempt : callable
        Predicts with a fraction, 0 to 1, of the way from easy places to those asked for.
    failed : Prediction
        Result for the places asked for.
    ways : mapping of Way
        By the place that is moved: start, end.

    Returns
    -------
    NearestLift or None
        None: there is no way, or the easy places are infeasible too.
    """
    length = max((way.length for way in ways.values()), default=0.0)
    if length == 0.0:
        return None
    nearest = attempt(0.0)
    if not nearest.report.ok:
        return None
    low, high = 0.0, 1.0
    while (high - low) * length > PLACE_TOLERANCE:
        middle = 0.5 * (low + high)
        tried = attempt(middle)
        if tried.report.ok:
            nearest, low = tried, middle
        else:
            failed, high = tried, middle
    return NearestLift(_limit_of(failed), missing_way(ways, low), nearest)


def missing_way(ways: Mapping[str, Way], fraction: float) -> str:
    """Describe the distance of the places at a fraction of the ways from those asked for."""
    parts = [(name, way.missing(fraction)) for name, way in ways.items()]
    words = [f'the {name} {missing} than asked for' for name, missing in parts if missing]
    return ', '.join(words) or 'the same places to half a millimetre'


def with_nearest(failed: Prediction, nearest: NearestLift | None) -> Prediction:
    """Add the nearest feasible lift to a failed result; None adds nothing."""
    if nearest is None:
        return failed
    status = failed.report.status
    if status is not SolveStatus.PREDICTOR_UNREACHABLE:
        # The solver may have ended otherwise; that less is feasible gives the reason.
        status = SolveStatus.PREDICTOR_INFEASIBLE
    message = (
        f'no feasible motion: {nearest.limit} breaks first; nearest feasible lift: '
        f'{nearest.change}; {failed.report.message}'
    )
    report = replace(failed.report, status=status, message=message)
    return replace(failed, report=report, nearest=nearest)


def first_limit(active: Sequence[str]) -> str:
    """Name of the first limit of the person or the world; a demand only if there is no other."""
    own = [name for name in active if not name.startswith(DEMANDS)]
    return (own or list(active) or ['none'])[0]


def _limit_of(failed: Prediction) -> str:
    if failed.runs and failed.runs[0].violated:
        return failed.runs[0].violated
    if failed.verification is not None and not failed.verification.passed:
        return failed.verification.failures()
    where, _, details = failed.report.message.partition(': ')
    joints = details.rsplit('; ', 1)[-1]
    return f'reach of the hands ({where}; {joints})' if joints else f'reach of the hands ({where})'
