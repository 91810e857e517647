# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled kernel against CasADi's virtual machine and against finite differences."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from lift_predictor.core.models.sagittal.assembly import (
    sagittal_assembler,
    sagittal_library,
    sagittal_nlp,
)
from lift_predictor.core.models.sagittal.grid import LiftBounds, SagittalGrid
from lift_predictor.core.models.sagittal.parameters import LiftParameters
from lift_predictor.core.solvers import cache, library
from lift_predictor.core.solvers.layout import Channel, Group
from lift_predictor.core.solvers.library import NodeLibrary, load_library
from lift_predictor.core.solvers.node_function import NodeFunction
from lift_predictor.core.solvers.spline_nlp import SplineNlp, make_assembler

needs_compiler = pytest.mark.skipif(
    cache.find_compiler() is None, reason='no C compiler on this machine'
)
GRIDS = (SagittalGrid(7, 25), SagittalGrid(5, 5), SagittalGrid(6, 13))


def every_operation() -> list[NodeFunction]:
    """Make a function with all operations, two channels, scalars, a row that is linear."""
    z, s, p = ca.SX.sym('z', 3 * 2 + 1), ca.SX.sym('s', 2), ca.SX.sym('p', 3)
    a, b = z[0], z[3]
    rows = ca.vertcat(
        ca.sin(a) * ca.cos(b) + ca.tan(0.1 * a),
        ca.exp(0.1 * b) / (2.0 + ca.tanh(z[4])) + p[0] * s[0] ** 2,
        ca.sqrt(1.0 + a**2) * ca.log(2.0 + b**2) - z[6] ** 3 * s[1],
        ca.fmin(a, b) + ca.fmax(a, p[1]) * ca.fabs(b) + ca.sign(a) * ca.copysign(z[1], b),
        ca.if_else(ca.logic_and(a > 0.0, b <= 1.0), a * b, a - b) + ca.atan2(a, 2.0 + b),
        ca.if_else(ca.logic_or(a == 0.0, p[2] != 0.0), z[5], z[2]),
        ca.asin(0.1 * a) + ca.acos(0.5 * ca.sin(b)) + ca.atan(a) + (1.5 + 0.1 * a) ** 2.5,
        z[2],
    )
    cost = ca.sumsqr(z) * s[0] - 1.0 / (3.0 + s[1] ** 2) - 2.0 * ca.sqrt(4.0 + (a * b) ** 2)
    report = NodeFunction('report', z, s, p, z[0] + 2.0 * p[0], differentiable=False)
    return [NodeFunction('all', z, s, p, rows, cost), report]


def programme_of(functions: NodeLibrary, n_points: int) -> SplineNlp:
    """Two components on a spline of 6 control points, one free value at each instant."""
    spline = SagittalGrid(8, 11).spline
    times = np.linspace(0.0, 1.0, n_points)
    basis = np.stack([spline.basis(times, order) for order in range(3)])
    at = basis.shape[2] * 2
    channels = (Channel(0, 2, basis), Channel(at, 1, np.eye(n_points)[None]))
    n = at + n_points + 2
    group = Group('all', channels, (n - 2, n - 1), 8, np.linspace(0.1, 0.3, n_points))
    assembler = make_assembler(functions, [group], n)
    low = np.full(assembler.m, -1.0)
    high = np.where(np.arange(assembler.m) % 5 == 0, low, 1.0)
    free = np.full(n, -np.inf), np.full(n, np.inf)
    p = np.array([0.3, 0.1, 1.0])
    return SplineNlp(assembler, p, free, (low, high), lambda i: f'row {i}', str)


def loaded(monkeypatch: pytest.MonkeyPatch, folder: Path, compiler: bool) -> NodeLibrary:
    monkeypatch.setenv('LIFT_CACHE', str(folder))
    if not compiler:
        monkeypatch.setenv('CC', '/no/such/compiler')
    result = load_library('operations', [Path(__file__)], every_operation)
    monkeypatch.delenv('CC', raising=False)
    return result


@needs_compiler
@pytest.mark.parametrize('vector_library', [True, False])
@pytest.mark.parametrize('n_points', [1, 11, 40])
def test_all_operations_and_channels_agree_with_the_virtual_machine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, vector_library: bool, n_points: int
) -> None:
    if not vector_library:
        monkeypatch.setattr(library, 'VECTOR_LIBM', ('-lno_such_library',))
    fast = programme_of(loaded(monkeypatch, tmp_path, True), n_points)
    slow = programme_of(loaded(monkeypatch, tmp_path, False), n_points)
    rng = np.random.default_rng(5)
    x = rng.uniform(-2.0, 2.0, fast.n)
    m = len(fast.g_lower)
    step, y, weight = rng.normal(size=fast.n), rng.normal(size=m), rng.uniform(size=m)
    one, two = fast.linearise(x), slow.linearise(x)
    close = {'rtol': 1e-12, 'atol': 1e-12}
    assert fast.values(x)[0] == pytest.approx(slow.values(x)[0], rel=1e-13)
    np.testing.assert_allclose(fast.values(x)[1], slow.values(x)[1], **close)
    np.testing.assert_allclose(one.g, two.g, **close)
    np.testing.assert_allclose(one.gradient, two.gradient, **close)
    np.testing.assert_allclose(one.equality, two.equality, **close)
    np.testing.assert_allclose(one.times(step), two.times(step), **close)
    np.testing.assert_allclose(one.transposed(y), two.transposed(y), **close)
    matrix = one.condensed(0.7, y, weight)
    np.testing.assert_allclose(matrix, two.condensed(0.7, y, weight), rtol=1e-10, atol=1e-10)
    np.testing.assert_array_equal(matrix, matrix.T)


@pytest.fixture(scope='module')
def sagittal() -> NodeLibrary:
    return sagittal_library()


def bounds(grid: SagittalGrid, mass: float) -> LiftBounds:
    posture = np.full((3, 6), 3.0)
    return LiftBounds(
        np.full(6, -3.0), np.full(6, 3.0), -posture, posture, np.ones((2, 2)), np.full(2, mass)
    )


@pytest.mark.parametrize('grid', GRIDS, ids=str)
def test_operators_of_the_sagittal_nlp_are_those_of_its_matrices(
    sagittal: NodeLibrary, parameters: LiftParameters, grid: SagittalGrid
) -> None:
    parameters = replace(parameters, objective=np.array([0.4, 0.8]))
    programme = sagittal_nlp(
        sagittal_assembler(sagittal, grid), grid, parameters.pack(), bounds(grid, 7.0)
    )
    rng = np.random.default_rng(3)
    x = np.append(rng.uniform(0.1, 0.7, grid.n_splined), 7.0)
    m = len(grid.constraint_names)
    point = programme.linearise(x)
    f, g = programme.values(x)
    assert point.objective == pytest.approx(f, rel=1e-12)
    np.testing.assert_allclose(point.g, g, rtol=1e-11, atol=1e-11)
    jacobian = point.jacobian()
    step, y, weight = rng.normal(size=grid.n_variables), rng.normal(size=m), rng.uniform(size=m)
    np.testing.assert_allclose(point.times(step), jacobian @ step, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(point.transposed(y), jacobian.T @ y, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(point.equality, jacobian[programme.equal], atol=1e-10)
    hessian = point.condensed(0.7, y, np.zeros(m))
    expected = hessian + (jacobian.T * weight) @ jacobian
    matrix = point.condensed(0.7, y, weight)
    np.testing.assert_allclose(matrix, expected, rtol=1e-9, atol=1e-8 * np.abs(expected).max())


def test_derivatives_against_finite_differences(
    sagittal: NodeLibrary, parameters: LiftParameters
) -> None:
    grid = GRIDS[0]
    programme = sagittal_nlp(
        sagittal_assembler(sagittal, grid), grid, parameters.pack(), bounds(grid, 7.0)
    )
    rng = np.random.default_rng(8)
    x = np.append(rng.uniform(0.1, 0.7, grid.n_splined), 7.0)
    y, direction = rng.normal(size=len(grid.constraint_names)), rng.normal(size=grid.n_variables)
    h = 1e-6
    (f1, g1), (f0, g0) = (programme.values(x + sign * h * direction) for sign in (1, -1))
    point = programme.linearise(x)
    assert point.gradient @ direction == pytest.approx((f1 - f0) / (2 * h), rel=1e-6)
    scale = np.abs(g1).max()
    np.testing.assert_allclose(point.times(direction), (g1 - g0) / (2 * h), atol=1e-6 * scale)
    second = point.condensed(1.0, y, np.zeros_like(y)) @ direction

    def slope(at: np.ndarray) -> np.ndarray:
        there = programme.linearise(at)
        return there.gradient + there.transposed(y)

    change = (slope(x + h * direction) - slope(x - h * direction)) / (2 * h)
    np.testing.assert_allclose(second, change, atol=1e-6 * np.abs(change).max())


@needs_compiler
def test_library_in_the_cache_loads_without_casadi(sagittal: NodeLibrary) -> None:
    code = (
        'import sys\n'
        'from lift_predictor.core.models.sagittal.assembly import sagittal_library\n'
        'print(sagittal_library().backend)\n'
        "print([name for name in ('casadi', 'scipy', 'numba') if name in sys.modules])\n"
    )
    assert sagittal.compiled is not None
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.splitlines() == [cache.FROM_CACHE, '[]']


@needs_compiler
def test_hash_of_a_library_depends_on_processor_flags_and_sources(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    compiler = cache.find_compiler() or ''
    source = Path(__file__)
    first = library.library_hash([source], compiler)
    assert library.library_hash([source], compiler) == first
    assert library.library_hash([Path(library.__file__)], compiler) != first
    monkeypatch.setattr(cache, 'processor_features', lambda: 'another processor')
    assert library.library_hash([source], compiler) != first
    monkeypatch.undo()
    monkeypatch.setattr(library, 'FLAGS', ('-O0',))
    assert library.library_hash([source], compiler) != first


def test_no_compiler_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    slow = loaded(monkeypatch, tmp_path, False)
    assert slow.compiled is None
    assert slow.backend == "functions run in CasADi's virtual machine: no C compiler was found"
