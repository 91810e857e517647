# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves and rigid-tendon geometry against values that OpenSim 4.6 computed."""

from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.muscles.curves import (
    MuscleParameters,
    active_force_length,
    fibre,
    force_velocity,
    passive_force_length,
    strength,
)
from muscle_analyzer.core.osim.model import Muscle

REFERENCE = np.load(Path(__file__).parents[1] / 'reference' / 'muscle_curves.npz')


def parameters():
    """Collect muscles of 1000 N with the measures of the reference."""
    measures = (
        REFERENCE[name]
        for name in (
            'optimal_fibre_length', 'tendon_slack_length', 'pennation_at_optimal', 'max_velocity',
        )
    )  # fmt: skip
    return MuscleParameters.of(
        tuple(
            Muscle(
                name, 'DeGrooteFregly2016Muscle', 1000.0, optimal, slack, pennation, (), (),
                {
                    'max_contraction_velocity': fastest,
                    'active_force_width_scale': 1.5,
                    'passive_fiber_strain_at_one_norm_force': 0.7,
                },
            )
            for name, optimal, slack, pennation, fastest in zip(
                REFERENCE['muscles'], *measures, strict=True
            )
        )
    )  # fmt: skip


def each(curve, values, *shape):
    """Return a curve's values (n,)."""
    return np.array([curve(value, *shape) for value in values])


def fibres(chosen):
    """Return lengths, velocities and cosines of the reference's fibres, (n, n_m) each."""
    lengths, velocities = np.atleast_2d(REFERENCE['path_length'], REFERENCE['path_velocity'])
    rows = zip(lengths, velocities, strict=True)
    table = (chosen.tendon_slack_length, chosen.thickness)
    found = [[fibre(*one) for one in zip(*table, *row, strict=True)] for row in rows]
    return np.moveaxis(np.array(found), -1, 0)


def test_curves_equal_opensim():
    length, scale = REFERENCE['normalised_length'], float(REFERENCE['active_force_width_scale'])
    active = each(active_force_length, length, scale)
    assert active == pytest.approx(REFERENCE['active'], abs=1e-12)
    passive = each(passive_force_length, length, float(REFERENCE['passive_strain']))
    assert passive == pytest.approx(REFERENCE['passive'], abs=1e-12)
    speed = each(force_velocity, REFERENCE['normalised_velocity'])
    assert speed == pytest.approx(REFERENCE['velocity'], abs=1e-12)


def test_published_points():
    """Return the points through which the curves must pass (unstretched)."""
    assert active_force_length(1.0) == pytest.approx(1.0, abs=1e-12)
    assert each(force_velocity, (-1.0, 0.0)) == pytest.approx([0.0, 1.0], abs=1e-12)
    assert each(passive_force_length, (0.2, 1.6)) == pytest.approx([0.0, 1.0], abs=1e-12)


def test_fibres_equal_opensim():
    """Compare where OpenSim does not clamp the fibre to its allowed range."""
    shape = REFERENCE['fibre_length'].shape
    length, velocity, cosine = (array.reshape(shape) for array in fibres(parameters()))
    free = REFERENCE['fibre_length'] > 0.21 * REFERENCE['optimal_fibre_length']
    free &= REFERENCE['path_length'] > REFERENCE['tendon_slack_length']
    assert free.sum() > 300
    assert length[free] == pytest.approx(REFERENCE['fibre_length'][free], abs=1e-9)
    assert cosine[free] == pytest.approx(np.cos(REFERENCE['pennation'][free]), abs=1e-9)
    assert velocity[free] == pytest.approx(REFERENCE['fibre_velocity'][free], abs=1e-9)


def test_strength_is_the_product_of_the_curves():
    chosen = parameters()
    path = (REFERENCE['path_length'], REFERENCE['path_velocity'])
    active, passive = strength(chosen, *path, True)
    i = int(np.argmax(REFERENCE['pennation_at_optimal']))
    length, velocity, cosine = fibres(chosen)[:, 0, i]
    length /= chosen.optimal_fiber_length[i]
    speed = velocity / chosen.optimal_fiber_length[i] / 10.0
    by_hand = 1000.0 * cosine
    assert passive[i] == pytest.approx(by_hand * passive_force_length(length, 0.7))
    by_hand *= active_force_length(length, 1.5) * force_velocity(speed)
    assert active[i] == pytest.approx(by_hand)
    assert np.all(active >= 0.0) and np.all(passive >= 0.0)
    assert not strength(chosen, *path, False)[1].any()
