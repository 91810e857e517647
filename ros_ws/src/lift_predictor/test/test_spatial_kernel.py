# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Derivatives by sweeps: of a small function against CasADi, of the lift against differences."""

from __future__ import annotations

from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from human_model.subject import Subject
from lift_predictor.core.models.spatial.assembly import spatial_assembler, spatial_library
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.postures import guess
from lift_predictor.core.models.spatial.starts import through
from lift_predictor.core.models.spatial.task import PlacedBox, place_task
from lift_predictor.core.solvers import cache
from lift_predictor.core.solvers.layout import Channel, Group
from lift_predictor.core.solvers.library import load_library
from lift_predictor.core.solvers.node_function import NodeFunction
from lift_predictor.core.solvers.spline_nlp import make_assembler
from lift_predictor.core.solvers.sweeps import SweptFunction

N_Z, POINTS = 4, 11


def small(kind: type[NodeFunction], **more) -> NodeFunction:
    """Return a function in which most inputs couple, and one row depends on one input only."""
    z, s, p = ca.SX.sym('z', N_Z), ca.SX.sym('s', 1), ca.SX.sym('p', 3)
    rows = ca.vertcat(
        ca.sin(z[0]) * z[1] + p[0] * s[0] * z[2],
        ca.exp(0.3 * z[2]) / (2.0 + ca.cos(z[3])),
        z[1] ** 2,
    )
    cost = ca.sumsqr(z) * s[0] + ca.atan2(z[0], 3.0 + z[1] ** 2) * p[1] + ca.sqrt(4.0 + z[3])
    return kind('small', z, s, p, rows, cost, **more)


@pytest.fixture(scope='module')
def assemblers(tmp_path_factory):
    """Return both ways to the derivatives of the same programme."""
    if cache.find_compiler() is None:
        pytest.skip('no C compiler')
    patch = pytest.MonkeyPatch()
    patch.setenv('LIFT_CACHE', str(tmp_path_factory.mktemp('cache')))
    rng = np.random.default_rng(1)
    basis = rng.normal(size=(2, POINTS, 3))
    group = Group('small', (Channel(0, 2, basis),), (6,), 3, rng.uniform(size=POINTS))
    sets = ((0, 2), (1, 3), (4,))
    made = []
    for name, make in (
        ('swept', lambda: [small(SweptFunction, sets=sets)]),
        ('written', lambda: [small(NodeFunction)]),
    ):
        library = load_library(name, [Path(__file__)], make)
        assert library.compiled is not None, library.backend
        made.append(make_assembler(library, [group], 7))
    patch.undo()
    return made


def test_sweeps_give_the_same_as_written_out_derivatives(assemblers) -> None:
    rng = np.random.default_rng(2)
    x, p = 0.5 * rng.normal(size=7), rng.normal(size=3)
    results = []
    for assembler in assemblers:
        assembler.set_parameters(p)
        y, weight = np.sin(np.arange(3 * POINTS)), np.cos(np.arange(3 * POINTS)) ** 2
        f, rows, gradient = assembler.first(x)
        results.append(
            (f, rows, gradient, assembler.transposed(y), assembler.condensed(0.7, y, weight))
        )
        value, same = assembler.values(x)
        assert value == pytest.approx(f, rel=1e-14)
        np.testing.assert_allclose(same, rows, rtol=1e-13, atol=1e-14)
    for swept, written in zip(*results, strict=True):
        np.testing.assert_allclose(swept, written, rtol=1e-12, atol=1e-12)


def test_sets_must_be_a_partition() -> None:
    with pytest.raises(ValueError, match='no partition'):
        small(SweptFunction, sets=((0, 1), (1, 2, 3, 4))).derived()


@pytest.fixture(scope='module')
def lift_programme(subject: Subject):
    """Return assembler, a point of an asymmetric lift, and the number of rows."""
    who, grid = SpatialPerson.of(subject), SpatialGrid(6, 13)
    height = who.ankle_height
    frame = StanceFrame(
        0.0, np.zeros(3), np.array([[0.0, -0.15, height], [0.0, 0.15, height]]),
        np.array([-0.14, 0.14]),
    )  # fmt: skip
    box = PlacedBox(
        (7.0, 7.0),
        (0.24, 0.3, 0.127),
        0.3,
        np.array([[0.42, 0.0, 0.2], [0.3, 0.3, 0.9]]),
        np.array([0.0, 0.7]),
    )
    task = place_task(who, frame, box, (1.3, 1.3), grid)
    assembler = spatial_assembler(spatial_library(), grid)
    assembler.set_parameters(task.parameters.pack())
    ends = guess(task, 0), None, guess(task, 1)
    start = through(task, grid, ends, 'guess', 7.0)
    return assembler, np.append(start.control.ravel(), (7.0, 1.3))


def test_gradient_and_jacobian_of_the_lift_against_differences(lift_programme) -> None:
    assembler, x = lift_programme
    rng = np.random.default_rng(3)
    _, rows, gradient = assembler.first(x)
    multiplier = rng.normal(size=len(rows))
    transposed = assembler.transposed(multiplier)
    for _ in range(5):
        step = rng.normal(size=len(x))
        assembler.first(x)
        slopes = assembler.times(step)
        h = 1e-6
        ahead, behind = assembler.values(x + h * step), assembler.values(x - h * step)
        assert (ahead[0] - behind[0]) / (2 * h) == pytest.approx(gradient @ step, rel=1e-6)
        difference = (ahead[1] - behind[1]) / (2 * h)
        np.testing.assert_allclose(difference, slopes, rtol=1e-5, atol=1e-5)
        assert multiplier @ slopes == pytest.approx(transposed @ step, rel=1e-10)


def test_hessian_of_the_lift_against_differences(lift_programme) -> None:
    """Of the Lagrangian, the box's mass and the duration included."""
    assembler, x = lift_programme
    rng = np.random.default_rng(4)
    multiplier = 0.1 * rng.normal(size=assembler.m)

    def slope(at):
        gradient = assembler.first(at)[2]
        return 0.8 * gradient + assembler.transposed(multiplier)

    assembler.first(x)
    hessian = assembler.condensed(0.8, multiplier, np.zeros(assembler.m))
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-12 * np.abs(hessian).max())
    for _ in range(5):
        step = rng.normal(size=len(x))
        h = 1e-6
        difference = (slope(x + h * step) - slope(x - h * step)) / (2 * h)
        scale = np.abs(hessian @ step).max()
        np.testing.assert_allclose(difference, hessian @ step, atol=2e-7 * scale)


def test_weighted_squares_are_added(lift_programme) -> None:
    assembler, x = lift_programme
    rng = np.random.default_rng(5)
    weight = rng.uniform(size=assembler.m)
    none = np.zeros(assembler.m)
    assembler.first(x)
    both = assembler.condensed(1.0, none, weight) - assembler.condensed(1.0, none, none)
    step = rng.normal(size=len(x))
    assert step @ both @ step == pytest.approx(weight @ assembler.times(step) ** 2, rel=1e-9)
