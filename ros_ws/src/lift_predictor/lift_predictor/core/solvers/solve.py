# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solve a problem: by the compiled method where its functions are compiled, else in Python."""

from __future__ import annotations

import ctypes
import time
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.compiled_assembler import CompiledAssembler
from lift_predictor.core.solvers.problem import NlpProblem, violated_constraints
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution, Status
from lift_predictor.core.solvers.spline_nlp import SplineNlp

STATUS: Final = (
    Status.OPTIMAL, Status.INFEASIBLE, Status.ITERATION_LIMIT, Status.TIME_LIMIT, Status.STUCK,
    Status.NOT_FINITE, Status.CANCELLED,
)  # fmt: skip
"""In the order of the numbers in interior_point.c."""


class _Settings(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_double) for name in (
            'tolerance', 'infeasible_violation', 'time_limit', 'barrier', 'bound_push',
            'gradient_limit',
        )),
        ('max_iterations', ctypes.c_int),
        ('warm', ctypes.c_int),
        ('stop', ctypes.c_void_p),
    )  # fmt: skip


class _Result(ctypes.Structure):
    _fields_ = (
        ('status', ctypes.c_int),
        ('iterations', ctypes.c_int),
        *((name, ctypes.c_double) for name in (
            'objective', 'primal', 'dual', 'complementarity',
        )),
    )  # fmt: skip


def solve(
    problem: NlpProblem,
    x0: Array,
    options: InteriorPointOptions | None = None,
    warm: Solution | None = None,
) -> Solution:
    """Find a local minimum; parameters and result as of `interior_point.solve`.

    Both ways do the same steps. Differences are those of rounding.

    Raises
    ------
    CancelledError
        The stop flag of the options was set before the end.
    """
    options = options or InteriorPointOptions()
    if options.stop is not None:
        options.stop.check()
    if isinstance(problem, SplineNlp) and isinstance(problem.assembler, CompiledAssembler):
        return _solve_compiled(problem, problem.assembler, x0, options, warm)
    # Imports SciPy.
    from lift_predictor.core.solvers import interior_point

    return interior_point.solve(problem, x0, options, warm)


def _solve_compiled(
    problem: SplineNlp,
    assembler: CompiledAssembler,
    x0: Array,
    options: InteriorPointOptions,
    warm: Solution | None,
) -> Solution:
    begin = time.perf_counter()
    assembler.set_parameters(problem.parameters)
    x = np.array(x0, dtype=float)
    y, z = np.zeros(assembler.m), np.zeros(assembler.n)
    if warm is not None:
        y[:], z[:] = warm.lam_g, warm.lam_x
    settings = _Settings(
        options.tolerance,
        options.infeasible_violation,
        options.time_limit,
        options.barrier if warm is None else options.warm_barrier,
        options.bound_push if warm is None else options.warm_bound_push,
        options.gradient_limit,
        options.max_iterations,
        int(warm is not None),
        None if options.stop is None else options.stop.address,
    )
    result = _Result()
    bounds = (problem.lower, problem.upper, problem.g_lower, problem.g_upper)
    failed = assembler.library.lift_solve(
        assembler.handle,
        *(_pointer(bound) for bound in bounds),
        ctypes.byref(settings),
        *(_pointer(array) for array in (x, y, z)),
        ctypes.byref(result),
    )
    if failed:
        raise MemoryError('no memory for the interior-point method')
    if options.stop is not None:
        options.stop.check()
    status = STATUS[result.status]
    violated: tuple[tuple[str, float], ...] = ()
    if status is not Status.OPTIMAL:
        g = problem.values(x)[1]
        violated = violated_constraints(problem, g, options.infeasible_violation)
    return Solution(
        status, x, result.objective, y, z, result.iterations, result.primal, result.dual,
        result.complementarity, violated, time.perf_counter() - begin,
    )  # fmt: skip


def _pointer(array: Array) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
