# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Activation dynamics: excitations that produce the activations of a lift (equation 4.13).

Static optimisation solves each sample alone.  First-order activation dynamics,
``da/dt = (u - a) / tau(a, u)``, give the excitation u of each activation course.  An excitation
outside 0 to 1 means that the activation rises or falls faster than a muscle can.

The time constant is that of Thelen 2003 (J Biomech Eng 125:70) as in OpenSim's
``Thelen2003Muscle``: ``tau_act (0.5 + 1.5 a)`` while the activation rises, ``tau_deact / (0.5 +
1.5 a)`` while it falls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError

#: Tolerance for rounding of the bounds 0 and 1.
ROUNDING = 1e-9


@dataclass(frozen=True)
class ActivationDynamics:
    """Time constants of a muscle's activation.

    Attributes
    ----------
    activation_time, deactivation_time
        [s]; those of young adults in Thelen 2003.

    Raises
    ------
    InputArrayError
        If a time constant is not positive.
    """

    activation_time: float = 0.015
    deactivation_time: float = 0.050

    def __post_init__(self) -> None:
        """Check the times."""
        for name in ('activation_time', 'deactivation_time'):
            if not getattr(self, name) > 0.0:
                raise InputArrayError(f'{name} {getattr(self, name)} s must be positive')

    def rate(self, activation: ArrayLike, excitation: ArrayLike) -> Array:
        """Return da/dt (equation 4.13) [1/s].

        Parameters
        ----------
        activation, excitation
            a and u, of the same shape.
        """
        a, u = np.asarray(activation, np.float64), np.asarray(excitation, np.float64)
        shape = 0.5 + 1.5 * a
        rising = self.activation_time * shape
        falling = self.deactivation_time / shape
        return np.asarray((u - a) / np.where(u > a, rising, falling))

    def excitation(self, time: Array, activation: Array) -> Array:
        """Return the excitation of an activation course; equation 4.13 solved for u.

        Parameters
        ----------
        time : (n,)
            Increasing [s], n >= 3.
        activation : (n, n_m)
            0 to 1.

        Returns
        -------
        (n, n_m)
            Not clipped: no excitation produces values outside 0 to 1.

        Raises
        ------
        InputArrayError
            If the times do not increase or the shapes do not fit.
        """
        time, activation = np.asarray(time, np.float64), np.asarray(activation, np.float64)
        if time.ndim != 1 or time.size < 3 or activation.shape[:1] != time.shape:
            raise InputArrayError(
                f'time {time.shape} and activation {activation.shape}: (n,) and (n, n_m) with '
                'at least 3 samples are needed'
            )
        if not np.all(np.diff(time) > 0.0):
            k = int(np.argmin(np.diff(time)))
            raise InputArrayError(f'time does not increase at sample {k + 1} ({time[k + 1]} s)')
        slope = np.gradient(activation, time, axis=0)
        shape = 0.5 + 1.5 * activation
        tau = np.where(slope > 0.0, self.activation_time * shape, self.deactivation_time / shape)
        return np.asarray(activation + tau * slope)


def impossible_fraction(excitation: Array) -> Array:
    """Return, per muscle, the fraction of samples whose activation no excitation produces."""
    beyond = (excitation < -ROUNDING) | (excitation > 1.0 + ROUNDING)
    return np.asarray(np.mean(beyond, axis=0))
