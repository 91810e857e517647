# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Filter of the line search (Waechter and Biegler 2006, section 2.3)."""

from __future__ import annotations

from lift_predictor.core.solvers.constants import (
    ETA_PHI,
    GAMMA_ALPHA,
    GAMMA_PHI,
    GAMMA_THETA,
    LARGEST_FACTOR,
    ROUNDING,
    S_PHI,
    S_THETA,
    SMALL_FACTOR,
)


class Filter:
    """Pairs (violation theta, barrier objective phi) that no new point may be dominated by.

    Parameters
    ----------
    theta0 : float
        Violation at the start; a point 10^4 times worse is never accepted.
    """

    def __init__(self, theta0: float) -> None:
        self._largest = LARGEST_FACTOR * max(1.0, theta0)
        self._small = SMALL_FACTOR * max(1.0, theta0)
        self._entries: list[tuple[float, float]] = []

    def clear(self) -> None:
        """Forget all pairs: the barrier parameter has changed."""
        self._entries.clear()

    def add(self, theta: float, phi: float) -> None:
        """Enter the neighbourhood of a pair."""
        self._entries.append(((1.0 - GAMMA_THETA) * theta, phi - GAMMA_PHI * theta))

    def accepts(self, theta: float, phi: float) -> bool:
        """Whether no entry dominates a pair."""
        if not theta <= self._largest:
            return False
        return all(theta < t or phi < p for t, p in self._entries)

    def judge(
        self, now: tuple[float, float], trial: tuple[float, float], slope: float, step: float
    ) -> tuple[bool, bool]:
        """Tell whether a trial step is accepted, and whether it must be entered in the filter.

        Parameters
        ----------
        now, trial : (theta, phi)
            Violation and barrier objective before and after the step.
        slope : float
            Directional derivative of phi along the full step.
        step : float
            Step length.
        """
        theta, phi = now
        if not self.accepts(*trial):
            return False, False
        rounding = ROUNDING * max(1.0, abs(phi))
        switching = slope < 0.0 and step * (-slope) ** S_PHI > theta**S_THETA
        armijo = trial[1] <= phi + ETA_PHI * step * slope + rounding
        if theta <= self._small and switching:
            return armijo, False
        better = (
            trial[0] <= (1.0 - GAMMA_THETA) * theta
            or trial[1] <= phi - GAMMA_PHI * theta + rounding
        )
        return better, better and not (switching and armijo)

    def least_step(self, theta: float, slope: float) -> float:
        """Step length below which the restoration takes over (ibid., equation 23)."""
        bound = GAMMA_THETA
        if slope < 0.0:
            bound = min(bound, GAMMA_PHI * theta / -slope)
            if theta <= self._small:
                bound = min(bound, theta**S_THETA / (-slope) ** S_PHI)
        return GAMMA_ALPHA * bound
