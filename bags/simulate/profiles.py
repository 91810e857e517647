# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth profiles in time: quintic pieces with continuous acceleration."""

from __future__ import annotations

import numpy as np

from human_model.typing import Array


def minimum_jerk(time: Array, start: float, end: float) -> Array:
    """Return the minimum-jerk step from 0 to 1 (Flash and Hogan 1985) between two times [s]."""
    s = np.clip((time - start) / (end - start), 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def quintic(
    time: Array, start: float, end: float, first: tuple[float, ...], last: tuple[float, ...]
) -> Array:
    """Return the quintic with given value, velocity and acceleration at both ends.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]; outside of start and end the end values are held.
    start, end : float
        [s].
    first, last : tuple of 3 float
        Value, first and second derivative.
    """
    span = end - start
    s = np.clip((time - start) / span, 0.0, 1.0)
    p0, v0, a0 = first[0], first[1] * span, first[2] * span**2
    p1, v1, a1 = last[0], last[1] * span, last[2] * span**2
    rise = p1 - p0 - v0 - 0.5 * a0
    slope = v1 - v0 - a0
    bend = a1 - a0
    c3 = 10.0 * rise - 4.0 * slope + 0.5 * bend
    c4 = -15.0 * rise + 7.0 * slope - bend
    c5 = 6.0 * rise - 3.0 * slope + 0.5 * bend
    return p0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))


def slow_wander(time: Array, rng: np.random.Generator, amplitude: float) -> Array:
    """Return a smooth aimless movement below half a hertz; root mean square `amplitude`."""
    frequencies = rng.uniform(0.15, 0.45, 3)
    phases = rng.uniform(0.0, 2.0 * np.pi, 3)
    waves = np.sin(2.0 * np.pi * frequencies[:, None] * time + phases[:, None])
    return np.asarray(amplitude * np.sqrt(2.0 / 3.0) * waves.sum(axis=0))
