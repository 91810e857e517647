# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of the markers in the first frames."""

import numpy as np
import pytest

from motion_tracker.core.initial_rest import initial_speed

TIME = 1.7e9 + np.arange(11) / 100.0


def frames(velocity, noise=0.0, seed=1):
    """Forty markers with the velocities (40, 3) [m/s], noise [m]."""
    rng = np.random.default_rng(seed)
    start = rng.uniform(-1.0, 1.0, (40, 3))
    return [start + velocity * (t - TIME[0]) + rng.normal(0.0, noise, (40, 3)) for t in TIME]


def test_speed_is_the_root_mean_square_over_the_markers():
    velocity = np.zeros((40, 3))
    velocity[:10, 2] = 0.4
    assert initial_speed(TIME, frames(velocity)) == pytest.approx(0.2, rel=1e-5)


def test_noise_is_not_taken_for_speed():
    still = [initial_speed(TIME, frames(np.zeros((40, 3)), 1e-3, seed)) for seed in range(20)]
    assert np.sqrt(np.mean(np.square(still))) < 0.01
    walking = [initial_speed(TIME, frames(np.full((40, 3), 0.1), 1e-3, s)) for s in range(20)]
    assert np.mean(walking) == pytest.approx(0.1 * np.sqrt(3.0), rel=0.02)


def test_markers_not_seen_throughout_do_not_count():
    seen = frames(np.full((40, 3), 0.1))
    for k in range(39):
        seen[k % 11][k] = np.nan
    assert initial_speed(TIME, seen) == pytest.approx(0.1 * np.sqrt(3.0), rel=1e-5)
    seen[0][39] = np.nan
    assert initial_speed(TIME, seen) == 0.0
