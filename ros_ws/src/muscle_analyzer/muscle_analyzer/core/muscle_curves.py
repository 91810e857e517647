# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Force-length-velocity properties of a muscle with a rigid tendon.

Curves of De Groote et al. 2016 (Ann Biomed Eng 44:2922) with the coefficients of OpenSim 4's
``DeGrooteFregly2016Muscle``, which lets the active curve pass through (1, 1) and the velocity
curve through (-1, 0) and (0, 1); Millard's and Thelen's muscles have curves of their own
(`millard_curves`, `thelen_curves`).  The tendon has its slack length (``ignore_tendon_compliance``
of the model), the muscle a constant thickness (Zajac 1989, Crit Rev Biomed Eng 17:359).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.millard_curves import MillardCurves
from muscle_analyzer.core.osim_model import Muscle
from muscle_analyzer.core.thelen_curves import ThelenCurves

Array = NDArray[np.float64]

#: Coefficients b1 to b4 of the three Gaussians of the active curve.
ACTIVE = np.array(
    [
        [0.8150671134243542, 1.055033428970575, 0.162384573599574, 0.063303448465465],
        [0.433004984392647, 0.716775413397760, -0.029947116970696, 0.200356847296188],
        [0.1, 1.0, 0.353553390593274, 0.0],
    ]
)
#: Coefficients d1 to d4 of the velocity curve.
VELOCITY = (-0.3211346127989808, -8.149, -0.374, 0.8825327733249912)
#: Exponential shape of the passive curve, and the normalised length of zero passive force.
PASSIVE_SHAPE, PASSIVE_ZERO = 4.0, 0.2
#: Values of the two model properties below where a file does not give them (OpenSim's defaults).
WIDTH_SCALE, PASSIVE_STRAIN = 1.0, 0.6
#: Maximum contraction velocity where a file does not give it [optimal fibre lengths / s].
MAX_VELOCITY = 10.0


def active_force_length(length: Array, width_scale: Array | float = WIDTH_SCALE) -> Array:
    """
    Give the active force-length multiplier.

    Parameters
    ----------
    length
        Fibre length over optimal fibre length.
    width_scale
        Stretches the curve about its peak at 1 (``active_force_width_scale``).
    """
    x = (np.asarray(length) - 1.0) / width_scale + 1.0
    total = np.zeros_like(x)
    for b1, b2, b3, b4 in ACTIVE:
        total += b1 * np.exp(-0.5 * ((x - b2) / (b3 + b4 * x)) ** 2)
    return total


def passive_force_length(length: Array, strain: Array | float = PASSIVE_STRAIN) -> Array:
    """
    Give the passive force multiplier.

    Parameters
    ----------
    length
        Fibre length over optimal fibre length.
    strain
        Fibre strain at which the passive force is the maximum isometric force.
    """
    offset = np.exp(PASSIVE_SHAPE * (PASSIVE_ZERO - 1.0) / strain)
    grown = np.exp(PASSIVE_SHAPE * (np.asarray(length) - 1.0) / strain)
    return np.asarray((grown - offset) / (np.exp(PASSIVE_SHAPE) - offset))


def force_velocity(velocity: Array) -> Array:
    """
    Give the force-velocity multiplier.

    Parameters
    ----------
    velocity
        Fibre velocity over maximum contraction velocity, lengthening positive.
    """
    d1, d2, d3, d4 = VELOCITY
    return np.asarray(d1 * np.arcsinh(d2 * np.asarray(velocity) + d3) + d4)


class Curves(Protocol):
    """
    Multipliers of some of a model's muscles, of which `members` (n,) are the numbers.

    Lengths and velocities (n,) are normalised as those of the functions above.
    """

    @property
    def members(self) -> NDArray[np.int64]:
        """Give the numbers of the muscles that have these curves."""

    def active(self, length: Array, /) -> Array:
        """Give the active force-length multipliers."""

    def passive(self, length: Array, /) -> Array:
        """Give the passive force multipliers."""

    def rate(self, velocity: Array, /) -> Array:
        """Give the force-velocity multipliers."""


class Fibre(NamedTuple):
    """Length [m], velocity [m/s] and pennation angle [rad] of muscle fibres, each (n_m,)."""

    length: Array
    velocity: Array
    pennation: Array


class MuscleState(NamedTuple):
    """
    What a muscle can do along its path at one instant.

    Attributes
    ----------
    active : (n_m,)
        Force along the tendon per unit activation [N].
    passive : (n_m,)
        Force along the tendon without activation [N].
    """

    active: Array
    passive: Array


@dataclass(frozen=True)
class MuscleParameters:
    """
    Parameters of all muscles, each (n_m,); lengths [m], force [N], velocity [1/s].

    `curves` are those of muscles that have not De Groote's.
    """

    max_isometric_force: Array
    optimal_fiber_length: Array
    tendon_slack_length: Array
    pennation_at_optimal: Array
    max_velocity: Array
    width_scale: Array
    passive_strain: Array
    curves: tuple[Curves, ...] = ()

    @classmethod
    def of(cls, muscles: tuple[Muscle, ...]) -> MuscleParameters:
        """Collect the parameters of muscles as read from a model."""

        def property_of(name: str, default: float) -> Array:
            return np.array([muscle.properties.get(name, default) for muscle in muscles])

        return cls(
            max_isometric_force=np.array([m.max_isometric_force for m in muscles]),
            optimal_fiber_length=np.array([m.optimal_fiber_length for m in muscles]),
            tendon_slack_length=np.array([m.tendon_slack_length for m in muscles]),
            pennation_at_optimal=np.array([m.pennation_angle for m in muscles]),
            max_velocity=property_of('max_contraction_velocity', MAX_VELOCITY),
            width_scale=property_of('active_force_width_scale', WIDTH_SCALE),
            passive_strain=property_of('passive_fiber_strain_at_one_norm_force', PASSIVE_STRAIN),
            curves=tuple(
                curves
                for curves in (MillardCurves(muscles), ThelenCurves(muscles))
                if curves.members.size > 0
            ),
        )

    def fibre(self, path_length: Array, path_velocity: Array) -> Fibre:
        """Give the fibres at path lengths [m] and lengthening velocities [m/s], (n_m,) each."""
        along = path_length - self.tendon_slack_length
        thickness = self.optimal_fiber_length * np.sin(self.pennation_at_optimal)
        pennation = np.arctan2(thickness, along)
        return Fibre(np.hypot(along, thickness), path_velocity * np.cos(pennation), pennation)

    def isometric(self) -> MuscleState:
        """Give full strength at every length and velocity (muscle physiology off)."""
        return MuscleState(self.max_isometric_force, np.zeros_like(self.max_isometric_force))

    def state(self, path_length: Array, path_velocity: Array, passive: bool) -> MuscleState:
        """
        Give the strength at path lengths [m] and lengthening velocities [m/s], (n_m,) each.

        Parameters
        ----------
        path_length, path_velocity
            Of each muscle.
        passive
            Whether stretched fibres resist (``ignore_passive_fiber_force`` of a model is the
            opposite).
        """
        fibre = self.fibre(path_length, path_velocity)
        length = fibre.length / self.optimal_fiber_length
        velocity = fibre.velocity / (self.max_velocity * self.optimal_fiber_length)
        along = self.max_isometric_force * np.cos(fibre.pennation)
        by_length = active_force_length(length, self.width_scale)
        rate = force_velocity(velocity)
        stretched = passive_force_length(length, self.passive_strain)
        for curves in self.curves:
            k = curves.members
            by_length[k] = curves.active(length[k])
            rate[k] = curves.rate(velocity[k])
            stretched[k] = curves.passive(length[k])
        # Beyond its maximum shortening velocity a muscle pulls no more; it never pushes.
        return MuscleState(
            active=np.maximum(along, 0.0) * by_length * np.maximum(rate, 0.0),
            passive=np.maximum(along * stretched, 0.0) * float(passive),
        )
