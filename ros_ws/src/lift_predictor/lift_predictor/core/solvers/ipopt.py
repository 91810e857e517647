# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""IPOPT with exact derivatives on the lift programme: referee and fallback of our own solver."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any, Final

import casadi as ca
import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.sagittal.grid import LiftBounds
from lift_predictor.core.solvers.compiled import Programme
from lift_predictor.core.solvers.solver_run import (
    ACTIVE_MULTIPLIER,
    FEASIBILITY_TOLERANCE,
    Guess,
    Progress,
    SolverRun,
    best_first,
    runs_until,
)

TOLERANCE: Final = 1e-8
"""IPOPT's default relative tolerance."""


class LiftSolver:
    """IPOPT on one programme; built once, used for any person and task.

    Parameters
    ----------
    programme : Programme
        Compiled functions.
    time_limit : float
        Wall time of one IPOPT run at most [s].
    max_iterations : int
        Iterations of one run at most.
    settings : mapping, optional
        Further options of IPOPT by their names in its manual.
    """

    def __init__(
        self,
        programme: Programme,
        time_limit: float = 10.0,
        max_iterations: int = 500,
        settings: Mapping[str, Any] | None = None,
    ) -> None:
        self.programme = programme
        self.time_limit = time_limit
        options: dict[str, Any] = {
            'print_time': False,
            'error_on_fail': False,
            'calc_lam_p': False,
            'ipopt.print_level': 0,
            'ipopt.sb': 'yes',
            'ipopt.tol': TOLERANCE,
            'ipopt.max_iter': max_iterations,
            'ipopt.max_wall_time': time_limit,
        }
        options |= {f'ipopt.{name}': value for name, value in (settings or {}).items()}
        if programme.library is not None:
            self._ipopt = ca.nlpsol('lift', 'ipopt', str(programme.library), options)
        else:
            functions = programme.functions
            options |= {
                'grad_f': functions['nlp_grad_f'],
                'jac_g': functions['nlp_jac_g'],
                'hess_lag': functions['nlp_hess_l'],
            }
            x, p = ca.MX.sym('x', programme.grid.n_variables), functions['nlp'].mx_in('p')
            f, g = functions['nlp'](x, p)
            self._ipopt = ca.nlpsol('lift', 'ipopt', {'x': x, 'p': p, 'f': f, 'g': g}, options)

    def solve(self, parameters: Array, bounds: LiftBounds, start: Guess) -> SolverRun:
        """Run IPOPT from one start.

        Parameters
        ----------
        parameters : array
            `LiftParameters.pack`.
        bounds : LiftBounds
            Demands of the task.
        start : Start
            Initial guess.
        """
        begin = time.perf_counter()
        grid = self.programme.grid
        lbx, ubx = bounds.variables(grid)
        lbg, ubg = bounds.constraints(grid)
        x0 = np.clip(np.append(start.control, start.box_mass), lbx, ubx)
        result = self._ipopt(x0=x0, p=parameters, lbx=lbx, ubx=ubx, lbg=lbg, ubg=ubg)
        stats = self._ipopt.stats()
        elapsed = time.perf_counter() - begin

        x = np.asarray(result['x']).ravel()
        lam_x, lam_g = (np.asarray(result[key]).ravel() for key in ('lam_x', 'lam_g'))
        _, gradient = self.programme.functions['nlp_grad_f'](x, parameters)
        g, jacobian = self.programme.functions['nlp_jac_g'](x, parameters)
        g = np.asarray(g).ravel()
        stationarity = np.asarray(gradient).ravel() + lam_x + jacobian.sparse().T @ lam_g
        values = np.concatenate((x, g))
        low, high = np.concatenate((lbx, lbg)), np.concatenate((ubx, ubg))
        violation, index = _largest_violation(values, low, high)
        multipliers = np.concatenate((lam_x, lam_g))
        slack = np.where(multipliers > 0.0, high - values, values - low)
        # A bound that is infinite must have no multiplier: what is left counts by itself.
        slack = np.where(np.isfinite(slack), slack, 1.0)
        active = multipliers != 0.0
        complementarity = np.abs(multipliers[active] * slack[active])
        return SolverRun(
            start=start.name,
            converged=bool(stats['success']) and violation <= FEASIBILITY_TOLERANCE,
            status=str(stats['return_status']),
            control=x[: grid.n_splined].reshape(grid.spline.n_free, -1),
            box_mass=float(x[-1]),
            objective=float(result['f']),
            iterations=int(stats['iter_count']),
            violation=violation,
            violated=self._name(index) if violation > FEASIBILITY_TOLERANCE else '',
            active_constraints=self._active_constraints(multipliers, low, high),
            stationarity=float(np.abs(stationarity).max()),
            complementarity=float(complementarity.max(initial=0.0)),
            solve_time=elapsed,
        )

    def solve_all(
        self,
        parameters: Array,
        bounds: LiftBounds,
        starts: Sequence[Guess],
        deadline: float = float('inf'),
        progress: Progress | None = None,
    ) -> tuple[SolverRun, ...]:
        """Run IPOPT from every start, as far as the time allows; the best comes first.

        Converged runs come before the others, then the lower effort, or the smaller violation
        where none converged. The first start always runs; later ones are left out after the
        deadline (on the clock of `time.perf_counter`).
        """
        return best_first(
            runs_until(
                deadline, lambda start: self.solve(parameters, bounds, start), starts, progress
            )
        )

    def _active_constraints(
        self, multipliers: Array, low: Array, high: Array
    ) -> tuple[tuple[str, float], ...]:
        """Inequalities with a multiplier, in the order of its size."""
        size = np.where(low < high, np.abs(multipliers), 0.0)
        order = np.argsort(-size)[: np.count_nonzero(size > ACTIVE_MULTIPLIER)]
        return tuple((self._name(int(i)), float(size[i])) for i in order)

    def _name(self, index: int) -> str:
        n = self.programme.grid.n_variables
        if index >= n:
            return self.programme.grid.constraint_names[index - n]
        return self.programme.grid.variable_name(index)


def _largest_violation(values: Array, low: Array, high: Array) -> tuple[float, int]:
    excess = np.maximum(low - values, values - high)
    index = int(np.argmax(excess))
    return float(max(excess[index], 0.0)), index
