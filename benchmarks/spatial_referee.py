# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""IPOPT on the programmes of the prediction in space, as referee.

It gets the compiled functions of the programme, with exact derivatives and the sparsity of the
Jacobian, through CasADi.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from lift_predictor.core.models.spatial.assembly import spatial_nlp
from lift_predictor.core.models.spatial.lift_model import SOLVER_OPTIONS, SpatialModel
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.solvers.spline_nlp import SplineNlp


@dataclass(frozen=True, eq=False)
class Refereed:
    """IPOPT's answer: objective (NaN: none), iterations, variables and multipliers."""

    objective: float
    iterations: int
    x: Any
    multipliers: tuple[Any, Any]

    @property
    def solved(self) -> bool:
        """Whether it converged."""
        return bool(np.isfinite(self.objective))


class _Call(ca.Callback):
    """A NumPy function of (x) or (x, p, multipliers) as CasADi function with given sparsity."""

    def __init__(self, name: str, sizes: list[int], outputs: list[Any], function: Any) -> None:
        ca.Callback.__init__(self)
        self.sizes, self.outputs, self.function = sizes, outputs, function
        self.construct(name, {})

    def get_n_in(self) -> int:
        return len(self.sizes)

    def get_n_out(self) -> int:
        return len(self.outputs)

    def get_sparsity_in(self, i: int) -> Any:
        return ca.Sparsity.dense(self.sizes[i], 1)

    def get_sparsity_out(self, i: int) -> Any:
        return self.outputs[i]

    def eval(self, arguments: Sequence[Any]) -> list[Any]:
        return list(self.function(*(np.asarray(a).ravel() for a in arguments)))


class Referee:
    """IPOPT on the programme of a task, with exact derivatives.

    Parameters
    ----------
    model : SpatialModel
        Its compiled functions and grid.
    task : SpatialTask
        Task; other ones may differ in their bounds.
    x0 : array
        About where its Jacobian is probed for zeros.
    barrier : float, optional
        First barrier parameter; the model's if omitted.
    warm : bool
        Start from multipliers, as near to the bounds as our method does.
    """

    def __init__(
        self, model: SpatialModel, task: SpatialTask, x0: Any,
        barrier: float | None = None, warm: bool = False,
    ) -> None:  # fmt: skip
        self._model = model
        # Of its own assembler: the derivatives belong to its last point.
        self.programme = p = SpatialModel(model.options).nlp(task)
        a, n, m = p.assembler, p.n, len(p.g_lower)
        everything = np.arange(m, dtype=np.int32)
        rng = np.random.default_rng(0)
        used = np.zeros((m, n), dtype=bool)
        for _ in range(3):
            a.first(x0 + 0.01 * rng.normal(size=n))
            used |= a.dense_rows(everything) != 0.0
        pattern = ca.sparsify(ca.DM(used.astype(float))).sparsity()
        row, column = (np.array(part) for part in pattern.get_triplet())
        upper = ca.Sparsity.upper(n)
        up_row, up_column = (np.array(part) for part in upper.get_triplet())
        one, dense_g = ca.Sparsity.dense(1, 1), ca.Sparsity.dense(m, 1)

        def values(x: Any) -> list[Any]:
            f, g = a.values(x)
            return [f, g]

        def slope(x: Any, _: Any) -> list[Any]:
            f, _, gradient = a.first(x)
            return [f, gradient]

        def jacobian(x: Any, _: Any) -> list[Any]:
            _, g, _ = a.first(x)
            return [g, ca.DM(pattern, a.dense_rows(everything)[row, column])]

        def hessian(x: Any, _: Any, sigma: Any, multiplier: Any) -> list[Any]:
            a.first(x)
            matrix = a.condensed(float(sigma[0]), multiplier, np.zeros(m))
            return [ca.DM(upper, matrix[up_row, up_column])]

        self._calls = (
            _Call('both', [n], [one, dense_g], values),
            _Call('nlp_grad_f', [n, 0], [one, ca.Sparsity.dense(n, 1)], slope),
            _Call('nlp_jac_g', [n, 0], [dense_g, pattern], jacobian),
            _Call('nlp_hess_l', [n, 0, 1, m], [upper], hessian),
        )
        both, grad_f, jac_g, hess_lag = self._calls
        x = ca.MX.sym('x', n)
        f, g = both(x)
        options: dict[str, Any] = {
            'grad_f': grad_f, 'jac_g': jac_g, 'hess_lag': hess_lag, 'no_nlp_grad': True,
            'print_time': False, 'error_on_fail': False, 'calc_lam_p': False,
            'ipopt.print_level': 0, 'ipopt.sb': 'yes',
            'ipopt.tol': 1e-8, 'ipopt.max_iter': 400,
            'ipopt.mu_init': barrier or SOLVER_OPTIONS.barrier,
        }  # fmt: skip
        if warm:
            push = SOLVER_OPTIONS.warm_bound_push
            options |= {'ipopt.warm_start_init_point': 'yes'} | {
                f'ipopt.warm_start_{name}_push': push
                for name in ('bound', 'slack_bound', 'mult_bound')
            }
            options['ipopt.mu_init'] = SOLVER_OPTIONS.warm_barrier
        problem: dict[str, Any] = {'x': x, 'f': f, 'g': g}
        self._ipopt = ca.nlpsol('referee', 'ipopt', problem, options)

    def solve(
        self, x0: Any, task: SpatialTask | None = None, before: Refereed | None = None
    ) -> Refereed:
        """Solve, perhaps with the bounds of another task, and from an answer before."""
        p: SplineNlp = self.programme
        if task is not None:
            parameters = task.parameters.pack()
            p = spatial_nlp(p.assembler, self._model.grid, parameters, task.bounds)
        bounds = {'lbx': p.lower, 'ubx': p.upper, 'lbg': p.g_lower, 'ubg': p.g_upper}
        if before is not None:
            x0 = before.x
            bounds |= {'lam_x0': before.multipliers[0], 'lam_g0': before.multipliers[1]}
        result = self._ipopt(x0=np.clip(x0, p.lower, p.upper), **bounds)
        stats = self._ipopt.stats()
        objective = float(result['f']) if stats['success'] else float('nan')
        x, lam_x, lam_g = (np.asarray(result[name]).ravel() for name in ('x', 'lam_x', 'lam_g'))
        return Refereed(objective, int(stats['iter_count']), x, (lam_x, lam_g))
