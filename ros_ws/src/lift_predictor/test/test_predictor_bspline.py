# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Splines against SciPy and their own definition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from lift_predictor.core.bspline import RestToRestSpline, simpson_weights
from lift_predictor.core.exceptions import SplineError
from lift_predictor.core.models.sagittal.grid import SagittalGrid


@given(n_control=st.integers(5, 12), seed=st.integers(0, 2**32 - 1))
def test_basis_and_derivatives_are_those_of_scipy(n_control: int, seed: int) -> None:
    spline = RestToRestSpline(n_control)
    free = np.random.default_rng(seed).normal(size=(spline.n_free, 3))
    control = np.vstack((free[:1], free, free[-1:]))
    knots = np.concatenate(([0.0] * 3, np.linspace(0.0, 1.0, n_control - 2), [1.0] * 3))
    reference = BSpline(knots, control, 3)
    s = np.linspace(0.0, 1.0, 37)
    for order in range(3):
        expected = reference(s) if order == 0 else reference.derivative(order)(s)
        np.testing.assert_allclose(spline.basis(s, order) @ free, expected, atol=1e-9)


@given(n_control=st.integers(5, 12))
def test_starts_and_ends_at_rest_on_its_control_points(n_control: int) -> None:
    spline = RestToRestSpline(n_control)
    ends = np.array([0.0, 1.0])
    np.testing.assert_allclose(spline.basis(ends, 1), 0.0, atol=1e-12)
    np.testing.assert_allclose(spline.basis(ends)[0], np.eye(spline.n_free)[0])
    np.testing.assert_allclose(spline.basis(ends)[1], np.eye(spline.n_free)[-1])


@given(n_control=st.integers(7, 12))
def test_rests_in_acceleration_too(n_control: int) -> None:
    spline = RestToRestSpline(n_control, 'acceleration')
    assert spline.n_free == n_control - 4
    ends = np.array([0.0, 1.0])
    for order in (1, 2):
        np.testing.assert_allclose(spline.basis(ends, order), 0.0, atol=1e-10)
    np.testing.assert_allclose(spline.basis(ends)[0], np.eye(spline.n_free)[0])
    np.testing.assert_allclose(spline.basis(np.linspace(0.0, 1.0, 23)).sum(axis=1), 1.0)
    free = np.random.default_rng(n_control).normal(size=(spline.n_free, 2))
    s = np.linspace(0.0, 1.0, 40)
    np.testing.assert_allclose(spline.fit(s, spline.basis(s) @ free), free, atol=1e-9)
    # The first and last piece are half as long as the others.
    pieces = np.diff(spline.knots[3:-3])
    np.testing.assert_allclose(pieces[[0, -1]], 0.5 * pieces[1:-1].mean())
    np.testing.assert_allclose(pieces[1:-1], pieces[1])


@given(n_control=st.integers(5, 12))
def test_is_a_partition_of_unity(n_control: int) -> None:
    basis = RestToRestSpline(n_control).basis(np.linspace(0.0, 1.0, 23))
    assert basis.min() >= -1e-15
    np.testing.assert_allclose(basis.sum(axis=1), 1.0)


def test_fit_recovers_a_spline() -> None:
    spline = RestToRestSpline(8)
    free = np.random.default_rng(3).normal(size=(spline.n_free, 2))
    s = np.linspace(0.0, 1.0, 40)
    np.testing.assert_allclose(spline.fit(s, spline.basis(s) @ free), free, atol=1e-10)


def test_simpson_integrates_cubics_exactly() -> None:
    s = np.linspace(0.0, 1.0, 9)
    for power in range(4):
        assert simpson_weights(9) @ s**power == pytest.approx(1.0 / (power + 1), rel=1e-13)


@pytest.mark.parametrize('n_control', [-1, 0, 4])
def test_refuses_too_few_control_points(n_control: int) -> None:
    with pytest.raises(SplineError, match=f'n_control = {n_control}'):
        RestToRestSpline(n_control)
    with pytest.raises(SplineError, match='at least 7'):
        RestToRestSpline(6, 'acceleration')
    with pytest.raises(SplineError, match="'jerk': not one of velocity, acceleration"):
        SagittalGrid(7, 25, 'jerk')


@pytest.mark.parametrize('n_nodes', [5, 8, 24, 26])
def test_refuses_too_few_or_unaligned_nodes(n_nodes: int) -> None:
    """Fewer than 2 (m - 3) + 1 nodes let the optimiser cheat; Simpson panels end at knots."""
    with pytest.raises(SplineError, match=f'n_nodes = {n_nodes}'):
        SagittalGrid(7, n_nodes)


def test_refuses_times_outside_the_lift() -> None:
    with pytest.raises(SplineError, match=r'outside \[0, 1\]'):
        RestToRestSpline(5).basis(np.array([0.0, 1.1]))
    with pytest.raises(SplineError, match='outside'):
        RestToRestSpline(5).basis(np.array([np.nan]))
