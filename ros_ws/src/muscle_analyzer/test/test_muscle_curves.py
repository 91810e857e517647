# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves and rigid-tendon geometry against values that OpenSim 4.6 computed."""

from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.muscle_curves import (
    MuscleParameters,
    active_force_length,
    force_velocity,
    passive_force_length,
)

REFERENCE = np.load(Path(__file__).parent / 'reference' / 'muscle_curves.npz')


def parameters(**changes):
    n = len(REFERENCE['muscles'])
    fields = {
        'max_isometric_force': np.full(n, 1000.0),
        'optimal_fiber_length': REFERENCE['optimal_fibre_length'],
        'tendon_slack_length': REFERENCE['tendon_slack_length'],
        'pennation_at_optimal': REFERENCE['pennation_at_optimal'],
        'max_velocity': REFERENCE['max_velocity'],
        'width_scale': np.full(n, 1.5),
        'passive_strain': np.full(n, 0.7),
    }
    return MuscleParameters(**(fields | changes))


def test_curves_equal_opensim():
    length, scale = REFERENCE['normalised_length'], float(REFERENCE['active_force_width_scale'])
    assert active_force_length(length, scale) == pytest.approx(REFERENCE['active'], abs=1e-12)
    passive = passive_force_length(length, float(REFERENCE['passive_strain']))
    assert passive == pytest.approx(REFERENCE['passive'], abs=1e-12)
    speed = force_velocity(REFERENCE['normalised_velocity'])
    assert speed == pytest.approx(REFERENCE['velocity'], abs=1e-12)


def test_published_points():
    """Give the points through which the curves must pass (unstretched)."""
    assert active_force_length(np.array([1.0])) == pytest.approx([1.0], abs=1e-12)
    assert force_velocity(np.array([-1.0, 0.0])) == pytest.approx([0.0, 1.0], abs=1e-12)
    assert passive_force_length(np.array([0.2, 1.6])) == pytest.approx([0.0, 1.0], abs=1e-12)


def test_fibres_equal_opensim():
    """Compare where OpenSim does not clamp the fibre to its allowed range."""
    fibre = parameters().fibre(REFERENCE['path_length'], REFERENCE['path_velocity'])
    free = REFERENCE['fibre_length'] > 0.21 * REFERENCE['optimal_fibre_length']
    free &= REFERENCE['path_length'] > REFERENCE['tendon_slack_length']
    assert free.sum() > 300
    assert fibre.length[free] == pytest.approx(REFERENCE['fibre_length'][free], abs=1e-9)
    assert fibre.pennation[free] == pytest.approx(REFERENCE['pennation'][free], abs=1e-9)
    assert fibre.velocity[free] == pytest.approx(REFERENCE['fibre_velocity'][free], abs=1e-9)


def test_state_is_the_product_of_the_curves():
    chosen = parameters()
    state = chosen.state(REFERENCE['path_length'], REFERENCE['path_velocity'], passive=True)
    fibre = chosen.fibre(REFERENCE['path_length'], REFERENCE['path_velocity'])
    i = int(np.argmax(chosen.pennation_at_optimal))
    length = fibre.length[i] / chosen.optimal_fiber_length[i]
    speed = fibre.velocity[i] / chosen.optimal_fiber_length[i] / 10.0
    by_hand = 1000.0 * np.cos(fibre.pennation[i])
    assert state.passive[i] == pytest.approx(by_hand * passive_force_length(length, 0.7))
    by_hand *= active_force_length(length, 1.5) * force_velocity(speed)
    assert state.active[i] == pytest.approx(by_hand)
    assert np.all(state.active >= 0.0) and np.all(state.passive >= 0.0)
    slack = chosen.state(REFERENCE['path_length'], REFERENCE['path_velocity'], passive=False)
    assert not slack.passive.any()


def test_physiology_off_is_full_strength():
    state = parameters().isometric()
    assert np.all(state.active == 1000.0)
    assert not state.passive.any()
