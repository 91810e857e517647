# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the interior-point method and what it gives back."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from human_model.typing import Array
from lift_predictor.core.solvers.stop import StopFlag


class Status(StrEnum):
    """How a solve ended; only `OPTIMAL` is a solution."""

    OPTIMAL = 'optimal'
    INFEASIBLE = 'infeasible'
    ITERATION_LIMIT = 'iteration limit'
    TIME_LIMIT = 'time limit'
    STUCK = 'no further progress'
    NOT_FINITE = 'functions not finite at the start'
    CANCELLED = 'cancelled'


@dataclass(frozen=True)
class InteriorPointOptions:
    """Settings; the constants of the method are those of Waechter and Biegler (2006) or of IPOPT.

    Attributes
    ----------
    tolerance : float
        Largest scaled KKT error of a solution (IPOPT's default).
    infeasible_violation : float
        A point where the violation cannot be reduced locally is infeasible above this largest
        violation of a scaled constraint (IPOPT's `constr_viol_tol`).
    max_iterations : int
        Iterations at most, those of the feasibility restoration included.
    time_limit : float
        Wall time at most [s]; a last resort, as results must not depend on the clock.
    barrier : float
        Barrier parameter at the start.
    bound_push : float
        Least distance of the start from its bounds, relative to their size and distance.
    warm_barrier, warm_bound_push : float
        The same for warm starts.
    gradient_limit : float
        Objective and constraints are scaled down where their gradients at the start are larger.
    stop : StopFlag, optional
        Ends the work before the next iteration.
    """

    tolerance: float = 1e-8
    infeasible_violation: float = 1e-4
    max_iterations: int = 300
    time_limit: float = 60.0
    barrier: float = 0.1
    bound_push: float = 1e-2
    warm_barrier: float = 1e-4
    warm_bound_push: float = 1e-5
    gradient_limit: float = 100.0
    stop: StopFlag | None = None


@dataclass(frozen=True, eq=False)
class Solution:
    """Where a solve ended.

    Attributes
    ----------
    status : Status
        Only `OPTIMAL` is a solution.
    x : array, shape (n,)
        Variables.
    objective : float
        f(x).
    lam_g : array, shape (m,)
        Multipliers of the constraints: gradient + J' lam_g + lam_x = 0; positive at an upper
        bound.
    lam_x : array, shape (n,)
        Multipliers of the variables' bounds, positive at an upper bound (of fixed variables: the
        sensitivity of the objective to the value).
    iterations : int
        Iterations, restoration included.
    primal : float
        Largest violation of a constraint or bound, unscaled.
    dual : float
        Largest element of the gradient of the Lagrangian, unscaled.
    complementarity : float
        Largest product of a multiplier and its distance to the bound, unscaled.
    violated : tuple of (str, float)
        Names and violations of the most violated constraints of an infeasible result.
    solve_time : float
        Wall time [s].
    """

    status: Status
    x: Array
    objective: float
    lam_g: Array
    lam_x: Array
    iterations: int
    primal: float
    dual: float
    complementarity: float
    violated: tuple[tuple[str, float], ...]
    solve_time: float

    @property
    def ok(self) -> bool:
        """Whether this is a solution."""
        return self.status is Status.OPTIMAL
