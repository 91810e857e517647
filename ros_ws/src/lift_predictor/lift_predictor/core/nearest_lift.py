# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What can be done instead of an infeasible lift, in the plane and in space.

A limit breaks first if it binds in the nearest lift that can be done: with a little more mass, or
a little further, there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from human_model.report import SolveStatus

if TYPE_CHECKING:
    from lift_predictor.core.sagittal.prediction import PredictedLift2D
    from lift_predictor.core.spatial.prediction import PredictedLift3D

P = TypeVar('P', 'PredictedLift2D', 'PredictedLift3D')

REGULARISATION: Final = 1e-4
"""Factor of the effort [1/s] where the weight alone is maximised: it decides between the lifts of
the same weight, which differ in effort, and costs less than 0.05 % of the weight."""
PLACE_TOLERANCE: Final = 5e-3
"""Distance [m] to which the nearest place is found."""
ALL: Final = 0.999
"""Share of a mass that counts as all of it."""
INFEASIBLE_STATUSES: Final = (
    SolveStatus.PREDICTOR_INFEASIBLE,
    SolveStatus.PREDICTOR_UNREACHABLE,
    SolveStatus.PREDICTOR_NOT_CONVERGED,
    SolveStatus.PREDICTOR_VERIFICATION_FAILED,
)
"""Outcomes after which it is asked what is feasible."""
DEMANDS: Final = ('posture', 'window', 'technique')
"""What names of rows begin with that are no limit of the person or the world: a recording, or who
asks for the lift, wants them."""


@dataclass(frozen=True, eq=False)
class NearestLift(Generic[P]):
    """What can be done instead of an infeasible task.

    Attributes
    ----------
    limit : str
        Name of the limit that breaks first.
    change : str
        What is changed, by how much.
    prediction : PredictedLift2D or PredictedLift3D
        The changed lift, solved and checked.
    """

    limit: str
    change: str
    prediction: P


def lighter(found: P, asked: float, binding: Sequence[str]) -> NearestLift[P] | None:
    """Return the lift with the largest mass up to the one asked for as the nearest.

    Parameters
    ----------
    found : PredictedLift2D or PredictedLift3D
        Solved for the largest mass.
    asked : float
        Mass that was asked for [kg].
    binding : sequence of str
        Limits that it touches, the one that costs most first.

    Returns
    -------
    NearestLift or None
        None: not even empty hands can move so, or all of the mass can be lifted.
    """
    if not found.report.ok or found.box_mass > ALL * asked:
        return None
    change = f'{found.box_mass:.2f} kg instead of {asked:.2f} kg'
    return NearestLift(first_limit(binding), change, found)


def closer_lift(
    attempt: Callable[[float], P], failed: P, reach: float, change: Callable[[float], str]
) -> NearestLift[P] | None:
    """Find the lift nearest to the places asked for, on the way from places that are easy.

    Parameters
    ----------
    attempt : callable
        Predicts with a share, 0 to 1, of the way from easy places to those asked for.
    failed : PredictedLift2D or PredictedLift3D
        What became of the places asked for.
    reach : float
        Length of the whole way [m].
    change : callable
        Says in words what a share changes.

    Returns
    -------
    NearestLift or None
        None: the easy places cannot be met either.
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


def with_nearest(failed: P, nearest: NearestLift[P] | None) -> P:
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
    """Name of the first limit of the person or the world; a demand only if there is no other."""
    own = [name for name in binding if not name.startswith(DEMANDS)]
    return (own or list(binding) or ['none'])[0]


def _limit_of(failed: PredictedLift2D | PredictedLift3D) -> str:
    if failed.optima and failed.optima[0].violated:
        return failed.optima[0].violated
    if failed.verification is not None and not failed.verification.passed:
        return failed.verification.failures()
    where, _, details = failed.report.message.partition(': ')
    joints = details.rsplit('; ', 1)[-1]
    return f'reach of the hands ({where}; {joints})' if joints else f'reach of the hands ({where})'
