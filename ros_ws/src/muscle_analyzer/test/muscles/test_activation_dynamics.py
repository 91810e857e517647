# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Activation dynamics by hand and there and back."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.muscles.activation_dynamics import (
    ActivationDynamics,
    impossible_fraction,
)


def test_rates_by_hand():
    """From rest to full: 1 / (0.015 * 0.5); from full to nothing: -1 / (0.050 / 2)."""
    dynamics = ActivationDynamics()
    assert dynamics.rate(0.0, 1.0) == pytest.approx(1.0 / 0.0075)
    assert dynamics.rate(1.0, 0.0) == pytest.approx(-40.0)
    assert dynamics.rate(0.3, 0.3) == 0.0


def test_excitation_is_recovered_from_the_activation_it_made():
    dynamics = ActivationDynamics()

    def wish(t):
        return 0.45 + 0.35 * np.sin(2.0 * np.pi * t)

    time = np.linspace(0.0, 2.0, 2001)
    made = solve_ivp(
        lambda t, a: dynamics.rate(a, wish(t)), (0.0, 2.0), [0.45], t_eval=time, rtol=1e-9,
        atol=1e-10,
    )  # fmt: skip
    found = dynamics.excitation(time, made.y.T)[:, 0]
    # The one-sided differences of the first and last sample are of first order.
    assert np.abs(found - wish(time))[2:-2].max() < 2e-3


def test_steady_activation_is_its_own_excitation():
    steady = np.full((10, 3), 0.4)
    found = ActivationDynamics().excitation(np.arange(10.0), steady)
    np.testing.assert_array_equal(found, steady)


def test_jump_of_activation_cannot_be_excited():
    activation = np.zeros((101, 2))
    activation[50:, 0] = 1.0
    found = ActivationDynamics().excitation(np.arange(101) * 0.001, activation)
    assert found[50, 0] > 1.0
    assert impossible_fraction(found)[0] == pytest.approx(2.0 / 101.0)
    assert impossible_fraction(found)[1] == 0.0


def test_bad_courses_are_named():
    dynamics = ActivationDynamics()
    with pytest.raises(InputArrayError, match=r'does not increase at sample 2 \(1\.0 s\)'):
        dynamics.excitation(np.array([0.0, 1.0, 1.0]), np.zeros((3, 1)))
    with pytest.raises(InputArrayError, match='at least 3'):
        dynamics.excitation(np.array([0.0, 1.0]), np.zeros((2, 1)))
    with pytest.raises(InputArrayError, match=r'deactivation_time -1\.0 s'):
        ActivationDynamics(deactivation_time=-1.0)
