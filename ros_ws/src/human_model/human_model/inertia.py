# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid-body inertia: parallel axes, combination of bodies, physical consistency."""

from collections.abc import Iterable

import numpy as np

from human_model.typing import Array

#: Mass [kg], centre of mass (3,) [m], inertia tensor (3, 3) about it [kg m^2].
Body = tuple[float, Array, Array]


def rotate(inertia: Array, rotation: Array) -> Array:
    """Tensor (3, 3) written in the axes the rotation (3, 3) leads to."""
    return np.asarray(rotation @ inertia @ rotation.T)


def shift(mass: float, arm: Array) -> Array:
    """Tensor (3, 3) a point mass [kg] adds at distance arm (3,) [m] (parallel axes theorem)."""
    return np.asarray(mass * (arm @ arm * np.eye(3) - np.outer(arm, arm)))


def combine(bodies: Iterable[Body]) -> Body:
    """One rigid body of several given in the same frame; a negative mass takes a part away."""
    parts = list(bodies)
    mass = sum(part[0] for part in parts)
    if mass == 0.0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    com = np.sum([part[0] * part[1] for part in parts], axis=0) / mass
    inertia = np.sum([part[2] + shift(part[0], part[1] - com) for part in parts], axis=0)
    return mass, com, inertia


def positive_inertia(inertia: Array) -> bool:
    """Whether a tensor is symmetric, positive, and its principal moments form a triangle."""
    if not np.allclose(inertia, inertia.T, rtol=0, atol=1e-12):
        return False
    principal = np.linalg.eigvalsh(inertia)
    return bool(principal[0] > 0 and principal[0] + principal[1] >= principal[2] * (1 - 1e-9))
