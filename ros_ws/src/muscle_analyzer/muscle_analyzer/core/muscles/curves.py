# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force-length-velocity properties of a muscle with a rigid tendon, compiled.

Curves of De Groote et al. 2016 (Ann Biomed Eng 44:2922) with the coefficients of OpenSim 4's
``DeGrooteFregly2016Muscle``, which lets the active curve pass through (1, 1) and the velocity
curve through (-1, 0) and (0, 1); Millard's and Thelen's muscles have curves of their own
(`millard_curves`, `thelen_curves`).  The tendon has its slack length (``ignore_tendon_compliance``
of the model), the muscle a constant thickness (Zajac 1989, Crit Rev Biomed Eng 17:359).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.muscles.millard_curves import MillardCurves, curve_value, millard_curves
from muscle_analyzer.core.muscles.thelen_curves import (
    thelen_active,
    thelen_passive,
    thelen_rate,
    thelen_shapes,
)
from muscle_analyzer.core.osim.model import Muscle

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


@njit(error_model='numpy')
def active_force_length(length: float, width_scale: float = WIDTH_SCALE) -> float:
    """Return the active force-length multiplier.

    Parameters
    ----------
    length
        Fibre length over optimal fibre length.
    width_scale
        Stretches the curve about its peak at 1 (``active_force_width_scale``).
    """
    x = (length - 1.0) / width_scale + 1.0
    total = 0.0
    for k in range(ACTIVE.shape[0]):
        off = (x - ACTIVE[k, 1]) / (ACTIVE[k, 2] + ACTIVE[k, 3] * x)
        total += ACTIVE[k, 0] * np.exp(-0.5 * off * off)
    return total


@njit(error_model='numpy')
def passive_force_length(length: float, strain: float = PASSIVE_STRAIN) -> float:
    """Return the passive force multiplier.

    Parameters
    ----------
    length
        Fibre length over optimal fibre length.
    strain
        Fibre strain at which the passive force is the maximum isometric force.
    """
    offset = np.exp(PASSIVE_SHAPE * (PASSIVE_ZERO - 1.0) / strain)
    grown = np.exp(PASSIVE_SHAPE * (length - 1.0) / strain)
    return float((grown - offset) / (np.exp(PASSIVE_SHAPE) - offset))


@njit(error_model='numpy')
def force_velocity(velocity: float) -> float:
    """Return the force-velocity multiplier.

    Parameters
    ----------
    velocity
        Fibre velocity over maximum contraction velocity, lengthening positive.
    """
    d1, d2, d3, d4 = VELOCITY
    x = d2 * velocity + d3
    # The inverse hyperbolic sine; NumPy's takes four times as long when compiled.
    size = np.log(abs(x) + np.sqrt(x * x + 1.0))
    return float(d1 * (size if x > 0.0 else -size) + d4)


class MuscleParameters(NamedTuple):
    """Parameters of all muscles, each (n_m,) unless stated otherwise.

    Attributes
    ----------
    max_isometric_force
        [N].
    optimal_fiber_length, tendon_slack_length
        [m].
    thickness
        Of the muscle, which it keeps: sine of the pennation angle at optimal length times that
        length [m].
    max_velocity
        [optimal fibre lengths / s].
    width_scale, passive_strain
        Of De Groote's curves.
    millard : MillardCurves
        Curves of the muscles that have Millard's.
    thelen : (n_m, 6)
        Shapes of the muscles that have Thelen's, NaN for others.
    """

    max_isometric_force: Array
    optimal_fiber_length: Array
    tendon_slack_length: Array
    thickness: Array
    max_velocity: Array
    width_scale: Array
    passive_strain: Array
    millard: MillardCurves
    thelen: Array

    @classmethod
    def of(cls, muscles: tuple[Muscle, ...]) -> MuscleParameters:
        """Collect the parameters of muscles as read from a model."""

        def property_of(name: str, default: float) -> Array:
            return np.array([muscle.properties.get(name, default) for muscle in muscles])

        optimal = np.array([m.optimal_fiber_length for m in muscles])
        return cls(
            max_isometric_force=np.array([m.max_isometric_force for m in muscles]),
            optimal_fiber_length=optimal,
            tendon_slack_length=np.array([m.tendon_slack_length for m in muscles]),
            thickness=optimal * np.sin([m.pennation_angle for m in muscles]),
            max_velocity=property_of('max_contraction_velocity', MAX_VELOCITY),
            width_scale=property_of('active_force_width_scale', WIDTH_SCALE),
            passive_strain=property_of('passive_fiber_strain_at_one_norm_force', PASSIVE_STRAIN),
            millard=millard_curves(muscles),
            thelen=thelen_shapes(muscles),
        )


@njit(error_model='numpy')
def fibre(
    slack: float, thickness: float, path_length: float, path_velocity: float
) -> tuple[float, float, float]:
    """Return a muscle's fibre: length [m], velocity [m/s], cosine of its pennation angle.

    Parameters
    ----------
    slack, thickness
        Length of the tendon, thickness of the muscle [m].
    path_length, path_velocity
        Of the path [m], [m/s], lengthening positive.
    """
    along = path_length - slack
    length = np.sqrt(along * along + thickness * thickness)
    cosine = along / length if length > 0.0 else 1.0
    return length, path_velocity * cosine, cosine


@njit(error_model='numpy')
def strength(
    muscles: MuscleParameters, path_length: Array, path_velocity: Array, passive: bool
) -> tuple[Array, Array]:
    """Return what muscles can do along their paths at one instant.

    Parameters
    ----------
    muscles
        The muscles.
    path_length, path_velocity
        Of each muscle (n_m,) [m], [m/s], lengthening positive.
    passive
        Whether stretched fibres resist (``ignore_passive_fiber_force`` of a model is the
        opposite).

    Returns
    -------
    active : (n_m,)
        Force along the tendon per unit activation [N].
    passive : (n_m,)
        Force along the tendon without activation [N].
    """
    pull, resistance = np.empty(path_length.size), np.empty(path_length.size)
    fill_strength(muscles, path_length, path_velocity, passive, pull, resistance)
    return pull, resistance


@kernel
def fill_strength(
    muscles: MuscleParameters,
    path_length: Array,
    path_velocity: Array,
    passive: bool,
    pull: Array,
    resistance: Array,
) -> None:
    """Fill what `strength` gives."""
    # Plain arrays: a tuple of them costs more at each call of a function than a curve.
    most, optima, slack = (
        muscles.max_isometric_force, muscles.optimal_fiber_length, muscles.tendon_slack_length,
    )  # fmt: skip
    thickness, fastest = muscles.thickness, muscles.max_velocity
    width, strain, thelen = muscles.width_scale, muscles.passive_strain, muscles.thelen
    number, table = muscles.millard.number, muscles.millard.table
    lower, step, value, slope = table.lower, table.step, table.value, table.slope
    stretched = 0.0
    for i in range(path_length.size):
        length, velocity, cosine = fibre(slack[i], thickness[i], path_length[i], path_velocity[i])
        length /= optima[i]
        velocity /= fastest[i] * optima[i]
        if number[i, 0] >= 0:
            active = curve_value(lower, step, value, slope, number[i, 0], length)
            rate = curve_value(lower, step, value, slope, number[i, 2], velocity)
            if passive:
                stretched = curve_value(lower, step, value, slope, number[i, 1], length)
        elif thelen[i, 0] > 0.0:
            active = thelen_active(thelen[i], length)
            rate = thelen_rate(thelen[i], velocity)
            if passive:
                stretched = thelen_passive(thelen[i], length)
        else:
            active = active_force_length(length, width[i])
            rate = force_velocity(velocity)
            if passive:
                stretched = passive_force_length(length, strain[i])
        along = most[i] * cosine
        # Beyond its maximum shortening velocity a muscle pulls no more; it never pushes.
        pull[i] = max(along, 0.0) * active * max(rate, 0.0)
        resistance[i] = max(along * stretched, 0.0)
