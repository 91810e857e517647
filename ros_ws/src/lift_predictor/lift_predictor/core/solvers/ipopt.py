# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""IPOPT on any `NlpProblem`, through CasADi: reference solver, and fallback in the plane.

IPOPT gets the values, gradient, sparse Jacobian and Hessian of the Lagrangian that our own solver
gets: where the functions are compiled, it calls the same compiled functions.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import casadi as ca
import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.problem import Linearisation, NlpProblem, violated_constraints
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution, Status

SETTINGS: Final[Mapping[str, Any]] = {
    'print_level': 0,
    'sb': 'yes',
    'tol': 1e-8,
    'max_iter': 500,
}
"""Options of all runs by the names of IPOPT's manual; the tolerance is IPOPT's default."""
STATUS: Final = {
    'Infeasible_Problem_Detected': Status.INFEASIBLE,
    'Maximum_Iterations_Exceeded': Status.ITERATION_LIMIT,
    'Maximum_WallTime_Exceeded': Status.TIME_LIMIT,
    'Invalid_Number_Detected': Status.NOT_FINITE,
}
"""Meaning of IPOPT's return values other than success; all others are `Status.STUCK`."""
PROBES: Final = 3
PROBE_DISTANCE: Final = 0.01
"""Points where the Jacobian is evaluated to find its zeros, and their distance from the start."""

Evaluation = Callable[..., Sequence[float | Array]]


class IpoptSolver:
    """IPOPT for problems of one structure; built once, used for different bounds and starts.

    Parameters
    ----------
    problem : NlpProblem
        First problem. The others have Jacobians with the same zeros.
    x0 : ndarray, shape (n,)
        The zeros of the Jacobian are found near this point.
    settings : mapping, optional
        Options of IPOPT in addition to `SETTINGS`.
    """

    def __init__(
        self, problem: NlpProblem, x0: Array, settings: Mapping[str, Any] | None = None
    ) -> None:
        self._problem = problem
        self._point: tuple[Array, Linearisation] | None = None
        n, m = problem.n, len(problem.g_lower)
        pattern = self._pattern(np.asarray(x0, dtype=float))
        scalar, column, upper = ca.Sparsity.dense(1, 1), ca.Sparsity.dense, ca.Sparsity.upper(n)
        row, col = (np.array(part) for part in pattern.get_triplet())
        upper_row, upper_col = (np.array(part) for part in upper.get_triplet())

        def gradient(x: Array, _: Array) -> Sequence[float | Array]:
            point = self._linearise(x)
            return point.objective, point.gradient

        def jacobian(x: Array, _: Array) -> Sequence[float | Array]:
            point = self._linearise(x)
            return point.g, point.jacobian()[row, col]

        def hessian(x: Array, _: Array, sigma: Array, lam_g: Array) -> Sequence[float | Array]:
            matrix = self._linearise(x).condensed(float(sigma[0]), lam_g, np.zeros(m))
            return (matrix[upper_row, upper_col],)

        # CasADi keeps no reference to a callback.
        self._callbacks = (
            _Callback('values', (n,), (scalar, column(m, 1)), self._values),
            _Callback('nlp_grad_f', (n, 0), (scalar, column(n, 1)), gradient),
            _Callback('nlp_jac_g', (n, 0), (column(m, 1), pattern), jacobian),
            _Callback('nlp_hess_l', (n, 0, 1, m), (upper,), hessian),
        )
        values, grad_f, jac_g, hess_lag = self._callbacks
        options: dict[str, Any] = {
            'grad_f': grad_f, 'jac_g': jac_g, 'hess_lag': hess_lag, 'no_nlp_grad': True,
            'print_time': False, 'error_on_fail': False, 'calc_lam_p': False,
        }  # fmt: skip
        options |= {f'ipopt.{k}': v for k, v in {**SETTINGS, **(settings or {})}.items()}
        x = ca.MX.sym('x', n)
        f, g = values(x)
        self._ipopt = ca.nlpsol('ipopt', 'ipopt', {'x': x, 'f': f, 'g': g}, options)

    def solve(self, problem: NlpProblem, x0: Array, warm: Solution | None = None) -> Solution:
        """Find a local minimum.

        Parameters
        ----------
        problem : NlpProblem
            Problem with the structure of the first one.
        x0 : ndarray, shape (n,)
            Start; moved into the bounds.
        warm : Solution, optional
            Solution of a similar problem: the initial multipliers, if the settings have
            `warm_start_init_point`.
        """
        begin = time.perf_counter()
        self._problem, self._point = problem, None
        low = np.concatenate((problem.lower, problem.g_lower))
        high = np.concatenate((problem.upper, problem.g_upper))
        start = {'x0': np.clip(x0, problem.lower, problem.upper)}
        if warm is not None:
            start |= {'lam_x0': warm.lam_x, 'lam_g0': warm.lam_g}
        n = problem.n
        result = self._ipopt(**start, lbx=low[:n], ubx=high[:n], lbg=low[n:], ubg=high[n:])
        stats = self._ipopt.stats()
        solve_time = time.perf_counter() - begin
        x, lam_x, lam_g = (np.asarray(result[k]).ravel() for k in ('x', 'lam_x', 'lam_g'))
        self._point = None
        point = self._linearise(x)
        values, multipliers = np.concatenate((x, point.g)), np.concatenate((lam_x, lam_g))
        slack = np.where(multipliers > 0.0, high - values, values - low)
        # A multiplier of an infinite bound should be 0: its size is the error.
        slack = np.where(np.isfinite(slack), slack, 1.0)
        active = multipliers != 0.0
        status = STATUS.get(str(stats['return_status']), Status.STUCK)
        return Solution(
            status=Status.OPTIMAL if stats['success'] else status,
            x=x,
            objective=point.objective,
            lam_g=lam_g,
            lam_x=lam_x,
            iterations=int(stats['iter_count']),
            primal=float(np.maximum(low - values, values - high).max(initial=0.0)),
            dual=float(np.abs(point.gradient + point.transposed(lam_g) + lam_x).max()),
            complementarity=float(np.abs(multipliers * slack)[active].max(initial=0.0)),
            violated=violated_constraints(
                problem, point.g, InteriorPointOptions.infeasible_violation
            ),
            solve_time=solve_time,
        )

    def _pattern(self, x0: Array) -> ca.Sparsity:
        rng = np.random.default_rng(0)
        used = np.zeros((len(self._problem.g_lower), self._problem.n), dtype=bool)
        for _ in range(PROBES):
            x = x0 + PROBE_DISTANCE * rng.normal(size=len(x0))
            used |= self._problem.linearise(x).jacobian() != 0.0
        return ca.sparsify(ca.DM(used.astype(float))).sparsity()

    def _values(self, x: Array) -> Sequence[float | Array]:
        if self._point is not None and np.array_equal(self._point[0], x):
            return self._point[1].objective, self._point[1].g
        return self._problem.values(x)

    def _linearise(self, x: Array) -> Linearisation:
        """Return the derivatives at x; IPOPT requests them one by one at the same point."""
        if self._point is None or not np.array_equal(self._point[0], x):
            self._point = x, self._problem.linearise(x)
        return self._point[1]


class _Callback(ca.Callback):
    """A NumPy function as a CasADi function with outputs of given sparsity."""

    def __init__(
        self,
        name: str,
        sizes: Sequence[int],
        outputs: Sequence[ca.Sparsity],
        function: Evaluation,
    ) -> None:
        ca.Callback.__init__(self)
        self.sizes, self.outputs, self.function = sizes, outputs, function
        self.construct(name, {})

    def get_n_in(self) -> int:
        return len(self.sizes)

    def get_n_out(self) -> int:
        return len(self.outputs)

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.sizes[i], 1)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        return self.outputs[i]

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(
        self, arguments: Sequence[memoryview | None], results: Sequence[memoryview | None]
    ) -> int:
        """Evaluate in place: `eval` would copy all numbers through Python objects."""
        none = np.zeros(0)
        values = self.function(
            *(none if a is None else np.frombuffer(a).copy() for a in arguments)
        )
        for result, value in zip(results, values, strict=True):
            if result is not None:
                np.frombuffer(result)[:] = value
        return 0
