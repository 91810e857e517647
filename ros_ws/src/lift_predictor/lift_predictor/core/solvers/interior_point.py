# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Primal-dual interior-point method with a filter line search, condensed to the variables.

After Waechter and Biegler (2006), On the implementation of an interior-point filter line-search
algorithm for large-scale nonlinear programming, Math. Program. 106: slacks and bound multipliers
are eliminated, so that one dense symmetric matrix of the size of the variables is factored in each
iteration. Meant for few variables and many inequality constraints. Limits count iterations: the
result does not depend on the clock.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.constants import (
    ACCEPTABLE_FACTOR,
    KAPPA_EPSILON,
    KAPPA_MU,
    KAPPA_SIGMA,
    KAPPA_SOC,
    LARGEST_FIRST_MULTIPLIER,
    MAX_RESTORATIONS,
    MULTIPLIER_SCALE,
    RESTORED_FACTOR,
    RESTORED_PUSH,
    RESTORED_SLACK_PUSH,
    SHORT_STEP,
    SHORT_STEPS,
    SOC_LIMIT,
    TAU_LEAST,
    THETA_MU,
    TINY,
)
from lift_predictor.core.solvers.line_filter import Filter
from lift_predictor.core.solvers.newton import InertiaMemory, NewtonSystem
from lift_predictor.core.solvers.problem import NlpProblem, violated_constraints
from lift_predictor.core.solvers.restoration import constraint_violation, restore
from lift_predictor.core.solvers.scaling import ScaledNlp, ScaledPoint
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution, Status


@dataclass
class _State:
    """Iterate: v = (free variables, slacks), constraint multipliers, bound multipliers of v."""

    v: Array
    y: Array
    zl: Array
    zu: Array


@dataclass
class _Step:
    v: Array
    y: Array
    zl: Array
    zu: Array


def solve(
    problem: NlpProblem,
    x0: Array,
    options: InteriorPointOptions | None = None,
    warm: Solution | None = None,
) -> Solution:
    """Find a local minimum.

    Parameters
    ----------
    problem : NlpProblem
        What to solve.
    x0 : array, shape (n,)
        Start; moved inside the bounds.
    options : InteriorPointOptions, optional
        Settings.
    warm : Solution, optional
        Solution of a similar problem with the same constraints: the initial multipliers.

    Returns
    -------
    Solution
        Its status says whether it is one.

    Raises
    ------
    CancelledError
        The stop flag of the options was set before the end.
    """
    return _Solver(problem, x0, options or InteriorPointOptions(), warm).run()


class _Solver:
    def __init__(
        self, problem: NlpProblem, x0: Array, options: InteriorPointOptions, warm: Solution | None
    ) -> None:
        self.begin = time.perf_counter()
        self.options = options
        self.p = p = ScaledNlp(problem, x0, options.gradient_limit)
        self.has_l, self.has_u = np.isfinite(p.lower), np.isfinite(p.upper)
        self.mu = options.barrier if warm is None else options.warm_barrier
        push = options.bound_push if warm is None else options.warm_bound_push
        x = self._inside(np.asarray(x0, dtype=float)[p.free], slice(0, p.n), push)
        self.point: ScaledPoint = p.linearise(x)
        s = self._inside(self.point.g[p.unequal], slice(p.n, None), push)
        v = np.concatenate((x, s))
        self.state = self._multipliers(v) if warm is None else self._warm(v, warm)
        self.memory = InertiaMemory()
        self.iterations = self.restorations = self.short_steps = 0
        self.filter = Filter(self._theta(self.point.g, v))

    def _inside(self, values: Array, part: slice, push: float) -> Array:
        """Move values off their bounds (ibid., section 3.6)."""
        low, high = self.p.lower[part], self.p.upper[part]
        width = np.where(np.isfinite(high - low), high - low, np.inf)
        from_low = np.minimum(push * np.maximum(1.0, np.abs(low)), push * width)
        from_high = np.minimum(push * np.maximum(1.0, np.abs(high)), push * width)
        with np.errstate(invalid='ignore'):
            least = np.where(np.isfinite(low), low + from_low, -np.inf)
            most = np.where(np.isfinite(high), high - from_high, np.inf)
        return np.clip(values, least, most)

    def _multipliers(self, v: Array) -> _State:
        """Multipliers of bounds and inequality constraints on the central path."""
        low, high = self._distances(v)
        zl = np.minimum(self.mu / low, LARGEST_FIRST_MULTIPLIER)
        zu = np.minimum(self.mu / high, LARGEST_FIRST_MULTIPLIER)
        y = np.zeros(self.p.m)
        y[self.p.unequal] = (zu - zl)[self.p.n :]
        return _State(v, y, zl, zu)

    def _warm(self, v: Array, warm: Solution) -> _State:
        p = self.p
        y = p.objective_scale * warm.lam_g / p.g_scale
        bound = np.concatenate((p.objective_scale * warm.lam_x[p.free], y[p.unequal]))
        low, high = self._distances(v)
        zl = np.where(self.has_l, np.maximum(-bound, self.mu / low), 0.0)
        zu = np.where(self.has_u, np.maximum(bound, self.mu / high), 0.0)
        return _State(v, y, zl, zu)

    def _distances(self, v: Array) -> tuple[Array, Array]:
        return v - self.p.lower, self.p.upper - v

    def _theta(self, g: Array, v: Array) -> float:
        return float(np.abs(self._residual(g, v)).sum())

    def _residual(self, g: Array, v: Array) -> Array:
        """Violation of the constraints as equations: g - target, and g - s for inequalities."""
        residual = g.copy()
        residual[self.p.equal] -= self.p.target
        residual[self.p.unequal] -= v[self.p.n :]
        return residual

    def _phi(self, f: float, v: Array) -> float:
        low, high = self._distances(v)
        logs = np.log(low[self.has_l]).sum() + np.log(high[self.has_u]).sum()
        return f - self.mu * float(logs)

    def _errors(self, mu: float) -> tuple[float, float, float]:
        """Primal, dual and complementarity error (ibid., equation 5, before scaling)."""
        st, p = self.state, self.p
        dual = np.concatenate(
            (self.point.gradient + self.point.transposed(st.y), -st.y[p.unequal])
        )
        dual += st.zu - st.zl
        low, high = self._distances(st.v)
        products = np.concatenate(
            (low[self.has_l] * st.zl[self.has_l] - mu, high[self.has_u] * st.zu[self.has_u] - mu)
        )
        primal = np.abs(self._residual(self.point.g, st.v)).max(initial=0.0)
        return float(primal), float(np.abs(dual).max()), float(np.abs(products).max(initial=0.0))

    def _scaled_error(self, mu: float) -> float:
        st = self.state
        primal, dual, complementarity = self._errors(mu)
        z = float(st.zl.sum() + st.zu.sum())
        bounds = int(self.has_l.sum() + self.has_u.sum())
        s_d = max(MULTIPLIER_SCALE, (float(np.abs(st.y).sum()) + z) / max(len(st.y) + bounds, 1))
        s_c = max(MULTIPLIER_SCALE, z / max(bounds, 1))
        return max(primal, MULTIPLIER_SCALE * dual / s_d, MULTIPLIER_SCALE * complementarity / s_c)

    def _late(self) -> bool:
        if self.options.stop is not None:
            self.options.stop.check()
        return time.perf_counter() - self.begin > self.options.time_limit

    def run(self) -> Solution:
        """Iterate until solved or a limit is met."""
        options = self.options
        if not (np.isfinite(self.point.objective) and np.all(np.isfinite(self.point.g))):
            return self._end(Status.NOT_FINITE)
        while True:
            if self._scaled_error(0.0) <= options.tolerance:
                return self._end(Status.OPTIMAL)
            self._reduce_barrier()
            if self.iterations >= options.max_iterations:
                return self._end(Status.ITERATION_LIMIT)
            if self._late():
                return self._end(Status.TIME_LIMIT)
            self.iterations += 1
            try:
                system, sigma = self._factorise()
            except np.linalg.LinAlgError:
                return self._end(Status.STUCK)
            residual = self._residual(self.point.g, self.state.v)
            primal = float(np.abs(residual).max(initial=0.0))
            step = self._step(system, sigma, residual)
            blocked = not self._line_search(system, sigma, step)
            stuck = self.short_steps == SHORT_STEPS and primal > options.tolerance
            if blocked or stuck:
                self.short_steps = 0
                status = self._restore()
                if status is not None:
                    return self._end(status)

    def _reduce_barrier(self) -> None:
        least = self.options.tolerance / 10.0
        while self.mu > least and self._scaled_error(self.mu) <= KAPPA_EPSILON * self.mu:
            self.mu = max(least, min(KAPPA_MU * self.mu, self.mu**THETA_MU))
            self.filter.clear()

    def _factorise(self) -> tuple[NewtonSystem, Array]:
        st, p = self.state, self.p
        low, high = self._distances(st.v)
        sigma = st.zl / low + st.zu / high
        weight = np.zeros(p.m)
        weight[p.unequal] = sigma[p.n :]
        matrix = self.point.condensed(1.0, st.y, weight)
        matrix[np.diag_indices(p.n)] += sigma[: p.n]
        return NewtonSystem(matrix, self.point.equality, self.memory), sigma

    def _step(self, system: NewtonSystem, sigma: Array, residual: Array) -> _Step:
        """Newton step for the present barrier parameter and a residual of the constraints."""
        st, p, mu = self.state, self.p, self.mu
        low, high = self._distances(st.v)
        barrier = mu / high - mu / low
        inner = np.zeros(p.m)
        inner[p.unequal] = sigma[p.n :] * residual[p.unequal] + barrier[p.n :]
        right = -(self.point.gradient + barrier[: p.n]) - self.point.transposed(inner)
        dx, y_equal = system.solve(right, residual[p.equal])
        ds = self.point.times(dx)[p.unequal] + residual[p.unequal]
        dv = np.concatenate((dx, ds))
        y = np.zeros(p.m)
        y[p.equal] = y_equal
        y[p.unequal] = sigma[p.n :] * ds + barrier[p.n :]
        return _Step(
            dv,
            y - st.y,
            mu / low - st.zl - st.zl / low * dv,
            mu / high - st.zu + st.zu / high * dv,
        )

    def _longest(self, dv: Array) -> float:
        """Fraction-to-the-boundary rule for variables and slacks."""
        low, high = self._distances(self.state.v)
        tau = max(TAU_LEAST, 1.0 - self.mu)
        return min(1.0, tau / max(float((-dv / low).max()), float((dv / high).max()), tau))

    def _line_search(self, system: NewtonSystem, sigma: Array, step: _Step) -> bool:
        st, p = self.state, self.p
        low, high = self._distances(st.v)
        slope = float(
            self.point.gradient @ step.v[: p.n] + (self.mu / high - self.mu / low) @ step.v
        )
        theta = self._theta(self.point.g, st.v)
        phi = self._phi(self.point.objective, st.v)
        longest = alpha = self._longest(step.v)
        self.short_steps = self.short_steps + 1 if longest < SHORT_STEP else 0
        least = self.filter.least_step(theta, slope)
        if np.all(np.abs(step.v) <= TINY * (1.0 + np.abs(st.v))):
            self._take(st.v + longest * step.v, longest, step)
            return True
        while alpha >= least:
            v = st.v + alpha * step.v
            f, g = p.values(v[: p.n])
            trial = self._theta(g, v), self._phi(f, v)
            accepted, enter = self.filter.judge((theta, phi), trial, slope, alpha)
            if not accepted and alpha == longest and trial[0] >= theta:
                corrected = self._second_order(system, sigma, g, v, alpha, (theta, phi, slope))
                if corrected is not None:
                    v, enter, step = corrected
                    accepted = True
            if accepted:
                if enter:
                    self.filter.add(theta, phi)
                self._take(v, alpha, step)
                return True
            alpha *= 0.5
        return False

    def _second_order(
        self, system: NewtonSystem, sigma: Array, g: Array, v: Array, alpha: float,
        now: tuple[float, float, float],
    ) -> tuple[Array, bool, _Step] | None:  # fmt: skip
        """Correct the step for the constraints' curvature (ibid., section 2.4)."""
        theta, phi, slope = now
        residual = self._residual(self.point.g, self.state.v)
        before = theta
        after = self._residual(g, v)
        for _ in range(SOC_LIMIT):
            residual = alpha * residual + after
            if not np.all(np.isfinite(residual)):
                return None
            step = self._step(system, sigma, residual)
            length = self._longest(step.v)
            v = self.state.v + length * step.v
            f, g = self.p.values(v[: self.p.n])
            after = self._residual(g, v)
            trial = float(np.abs(after).sum()), self._phi(f, v)
            accepted, enter = self.filter.judge((theta, phi), trial, slope, alpha)
            if accepted:
                return v, enter, step
            if not trial[0] <= KAPPA_SOC * before:
                return None
            before, alpha = trial[0], length
        return None

    def _take(self, v: Array, alpha: float, step: _Step) -> None:
        st = self.state
        tau = max(TAU_LEAST, 1.0 - self.mu)
        z = np.concatenate((st.zl[self.has_l], st.zu[self.has_u]))
        dz = np.concatenate((step.zl[self.has_l], step.zu[self.has_u]))
        dual = min(1.0, tau / max(float((-dz / z).max(initial=0.0)), tau))
        low, high = self._distances(v)
        zl, zu = st.zl + dual * step.zl, st.zu + dual * step.zu
        # Multipliers stay near the central path (ibid., equation 16).
        zl = np.clip(zl, self.mu / (KAPPA_SIGMA * low), KAPPA_SIGMA * self.mu / low)
        zu = np.clip(zu, self.mu / (KAPPA_SIGMA * high), KAPPA_SIGMA * self.mu / high)
        self.state = _State(v, st.y + alpha * step.y, zl, zu)
        self.point = self.p.linearise(v[: self.p.n])

    def _restore(self) -> Status | None:
        """Leave a point where no step is accepted; the status if that is not possible."""
        p, options = self.p, self.options
        theta = self._theta(self.point.g, self.state.v)
        phi = self._phi(self.point.objective, self.state.v)
        if self._scaled_error(0.0) <= ACCEPTABLE_FACTOR * options.tolerance:
            return Status.OPTIMAL
        self.restorations += 1
        if theta <= options.tolerance or self.restorations > MAX_RESTORATIONS:
            return Status.STUCK
        self.filter.add(theta, phi)
        x = self.state.v[: p.n]
        left = options.max_iterations - self.iterations
        restored = restore(p, x, RESTORED_FACTOR * options.infeasible_violation, left, self._late)
        self.iterations += restored.iterations
        x = self._inside(restored.x, slice(0, p.n), RESTORED_PUSH)
        self.point = p.linearise(x)
        largest = float(np.abs(constraint_violation(p, self.point.g)).max())
        s = self._inside(self.point.g[p.unequal], slice(p.n, None), RESTORED_SLACK_PUSH)
        self.state = self._multipliers(np.concatenate((x, s)))
        if restored.minimum and largest > options.infeasible_violation:
            return Status.INFEASIBLE
        if self.iterations >= options.max_iterations:
            return Status.ITERATION_LIMIT
        return None

    def _end(self, status: Status) -> Solution:
        return _finish(self, status)


def _finish(solver: _Solver, status: Status) -> Solution:
    """Unscaled result and residuals of the present iterate."""
    p, st = solver.p, solver.state
    source = p.source
    x = np.clip(p.full(st.v[: p.n]), source.lower, source.upper)
    raw = source.linearise(x)
    y = p.g_scale * st.y / p.objective_scale
    gradient = raw.gradient + raw.transposed(y)
    bound = -gradient
    bound[p.free] = (st.zu - st.zl)[: p.n] / p.objective_scale
    excess = np.maximum(source.g_lower - raw.g, raw.g - source.g_upper)
    violated = violated_constraints(source, raw.g, solver.options.infeasible_violation)
    has_l, has_u = solver.has_l, solver.has_u
    low, high = st.v - p.lower, p.upper - st.v
    scale = 1.0 / p.objective_scale
    products = scale * np.concatenate(((st.zl[has_l] * low[has_l]), (st.zu[has_u] * high[has_u])))
    return Solution(
        status, x, raw.objective, y, bound, solver.iterations,
        max(float(excess.max(initial=0.0)), 0.0),
        float(np.abs(gradient + bound).max()),
        float(products.max(initial=0.0)),
        violated if status is not Status.OPTIMAL else (),
        time.perf_counter() - solver.begin,
    )  # fmt: skip
