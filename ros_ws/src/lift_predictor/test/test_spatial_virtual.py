# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled programme in space against CasADi's virtual machine, at random points."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from lift_predictor.core.models.spatial.assembly import (
    spatial_assembler,
    spatial_groups,
    spatial_library,
)
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.kernels import kernel_functions
from lift_predictor.core.models.spatial.postures import guess
from lift_predictor.core.models.spatial.starts import through
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.solvers import cache
from lift_predictor.core.solvers.layout import Group

pytestmark = pytest.mark.skipif(
    cache.find_compiler() is None, reason='no C compiler on this machine'
)
GRIDS = (SpatialGrid(7, 25), SpatialGrid(6, 13))
"""The nodes of a batch are on one piece of the splines, and on several."""
CLOSE = {'rtol': 1e-9}


class Virtual:
    """A node function in the virtual machine, with derivatives that CasADi makes by itself."""

    def __init__(self, function) -> None:
        zs, p = ca.vertcat(function.z, function.s), function.p
        out = ca.vertcat(ca.SX(function.cost), function.g)
        step, y = ca.SX.sym('step', zs.numel()), ca.SX.sym('y', out.numel())
        weight = ca.SX.sym('weight', out.numel())
        slope = ca.gradient(ca.dot(y, out), zs)
        moved = ca.jtimes(out, zs, step)
        curved = ca.jtimes(slope, zs, step) + ca.jtimes(out, zs, weight * moved, True)
        self.value = ca.Function('value', [zs, p], [out])
        self.times = ca.Function('times', [zs, p, step], [moved])
        self.transposed = ca.Function('transposed', [zs, p, y], [slope])
        self.curved = ca.Function('curved', [zs, p, y, weight, step], [curved])


class Reference:
    """The programme, assembled from the virtual machine by dense matrices."""

    def __init__(
        self, functions: dict[str, Virtual], groups: list[Group], n: int, p: np.ndarray
    ) -> None:
        self.groups, self.p, self.n = groups, p, n
        self.virtual = [functions[group.function] for group in groups]
        unit = np.eye(n)
        self.maps = [
            np.stack([group.inputs(column) for column in unit], axis=2) for group in groups
        ]

    def per_node(self, name: str, x: np.ndarray, *more: list[np.ndarray]) -> list[np.ndarray]:
        """Values of one of the functions at all nodes of each group."""
        results = []
        for k, (group, virtual) in enumerate(zip(self.groups, self.virtual, strict=True)):
            z = group.inputs(x)
            function = getattr(virtual, name).map(group.n_points)
            parameters = np.tile(self.p, (group.n_points, 1)).T
            extra = (np.asarray(arguments[k]).T for arguments in more)
            results.append(np.asarray(function(z.T, parameters, *extra)).T)
        return results

    def split(self, rows: np.ndarray, first: float) -> list[np.ndarray]:
        """Numbers of the rows by node, those of the cost in front."""
        parts, at = [], 0
        for group in self.groups:
            count = group.n_points * group.n_g
            cost = first * group.cost_weight[:, None]
            parts.append(np.hstack((cost, rows[at : at + count].reshape(group.n_points, -1))))
            at += count
        return parts

    def gathered(self, nodes: list[np.ndarray]) -> np.ndarray:
        """Sum of vectors by node inputs, by variables."""
        return sum(
            np.einsum('ki,kin->n', values, maps)
            for values, maps in zip(nodes, self.maps, strict=True)
        )


@pytest.fixture(scope='module')
def functions() -> dict[str, Virtual]:
    return {f.name: Virtual(f) for f in kernel_functions() if f.name in ('node', 'angle', 'hand')}


@pytest.fixture(scope='module', params=GRIDS, ids=str)
def case(request: pytest.FixtureRequest, placed, functions: dict[str, Virtual]):
    grid = request.param
    task: SpatialTask = placed(grid, 7.0)
    p = task.parameters.pack()
    assembler = spatial_assembler(spatial_library(), grid)
    assembler.set_parameters(p)
    reference = Reference(functions, spatial_groups(grid), grid.n_variables, p)
    rng = np.random.default_rng(4)
    ends = guess(task, 0), None, guess(task, 1)
    control = through(task, grid, ends, 'guess', 7.0).control.ravel()
    x = np.append(control, (7.0, task.duration)) + 0.1 * rng.normal(size=grid.n_variables)
    return assembler, reference, x, rng


def test_values_and_first_derivatives(case) -> None:
    assembler, reference, x, rng = case
    values = reference.per_node('value', x)
    rows = np.concatenate([part[:, 1:].ravel() for part in values])
    objective = sum(
        group.cost_weight @ part[:, 0]
        for group, part in zip(reference.groups, values, strict=True)
    )
    got, got_rows = assembler.values(x)
    assert got == pytest.approx(objective, rel=1e-11)
    np.testing.assert_allclose(got_rows, rows, rtol=1e-9, atol=1e-11)
    first, first_rows, gradient = assembler.first(x)
    assert first == pytest.approx(objective, rel=1e-11)
    np.testing.assert_allclose(first_rows, rows, rtol=1e-9, atol=1e-11)
    nothing = np.zeros(assembler.m)
    slope = reference.per_node('transposed', x, reference.split(nothing, 1.0))
    expected = reference.gathered(slope)
    np.testing.assert_allclose(gradient, expected, **CLOSE, atol=1e-9 * np.abs(expected).max())
    y, step = rng.normal(size=assembler.m), rng.normal(size=assembler.n)
    turned = reference.gathered(reference.per_node('transposed', x, reference.split(y, 0.0)))
    got = assembler.transposed(y)
    np.testing.assert_allclose(got, turned, **CLOSE, atol=1e-9 * np.abs(turned).max())
    steps = [group.inputs(step) for group in reference.groups]
    moved = reference.per_node('times', x, steps)
    expected = np.concatenate([part[:, 1:].ravel() for part in moved])
    got = assembler.times(step)
    np.testing.assert_allclose(got, expected, **CLOSE, atol=1e-9 * np.abs(expected).max())
    wanted = np.array([0, 5, assembler.m - 1], dtype=np.int32)
    np.testing.assert_allclose(
        assembler.dense_rows(wanted) @ step, expected[wanted], rtol=1e-8, atol=1e-9
    )


def test_condensed_matrix(case) -> None:
    assembler, reference, x, rng = case
    assembler.first(x)
    y, weight = 0.1 * rng.normal(size=assembler.m), rng.uniform(size=assembler.m)
    matrix = assembler.condensed(0.7, y, weight)
    np.testing.assert_array_equal(matrix, matrix.T)
    multipliers, weights = reference.split(y, 0.7), reference.split(weight, 0.0)
    for column in rng.choice(assembler.n, 12, replace=False).tolist() + [assembler.n - 1]:
        unit = np.zeros(assembler.n)
        unit[column] = 1.0
        steps = [group.inputs(unit) for group in reference.groups]
        expected = reference.gathered(reference.per_node('curved', x, multipliers, weights, steps))
        size = 1e-10 * np.abs(matrix).max()
        np.testing.assert_allclose(matrix[:, column], expected, rtol=1e-8, atol=size)
