# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Clamped cubic B-splines over normalised time (equation 2.12)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import SplineError

DEGREE = 3
MIN_CONTROL_POINTS = 5
REST: Final = {'velocity': 2, 'acceleration': 3}
"""What is zero at both ends, and how many control points are merged there for it."""


@dataclass(frozen=True)
class RestToRestSpline:
    """Cubic B-spline on [0, 1] that starts and ends at rest (equations 2.12 and 4.7).

    Zero slope at both ends of a clamped spline means that the first two control points are equal,
    and the last two: they are merged, so that equation 4.7 holds exactly and `n_control - 2`
    values per joint remain. Zero curvature as well means that the first three are equal, and the
    last three: `n_control - 4` remain. The first and last piece are then half as long as the
    others, so that the lift does not dwell at its ends.

    Parameters
    ----------
    n_control : int
        Number of control points per joint, at least 5 (the dissertation's choice), and 7 for rest
        in acceleration.
    rest : str
        'velocity' (equation 4.7), or 'acceleration': of both.

    Raises
    ------
    SplineError
        Too few control points, or another word for the rest.
    """

    n_control: int
    rest: str = 'velocity'

    def __post_init__(self) -> None:
        if self.rest not in REST:
            raise SplineError(f'rest = {self.rest!r}: not one of {", ".join(REST)}')
        least = MIN_CONTROL_POINTS + 2 * (self._merged - REST['velocity'])
        if self.n_control < least:
            raise SplineError(f'n_control = {self.n_control}: at least {least} are needed')

    @property
    def _merged(self) -> int:
        return REST[self.rest]

    @property
    def n_free(self) -> int:
        """Free values per joint."""
        return self.n_control - 2 * (self._merged - 1)

    @property
    def n_spans(self) -> int:
        """Polynomial pieces."""
        return self.n_control - DEGREE

    @property
    def knots(self) -> Array:
        """Clamped knot vector, shape (n_control + 4,)."""
        inner = np.linspace(0.0, 1.0, self.n_spans + 1)
        if self.rest == 'acceleration':
            whole = np.arange(self.n_spans - 1) + 0.5
            inner = np.concatenate(([0.0], whole, [self.n_spans - 1.0])) / (self.n_spans - 1)
        return np.concatenate((np.zeros(DEGREE), inner, np.ones(DEGREE)))

    def basis(self, s: Array, derivative: int = 0) -> Array:
        """Basis values (or derivatives by s) of the free control values.

        Parameters
        ----------
        s : array, shape (n,)
            Normalised times in [0, 1].
        derivative : int
            0, 1 or 2.

        Returns
        -------
        array, shape (n, n_free)
            Rows sum to 1 for derivative 0, to 0 otherwise.

        Raises
        ------
        SplineError
            A time outside [0, 1].
        """
        s = np.asarray(s, dtype=float)
        if s.size and not (s.min() >= 0.0 and s.max() <= 1.0):
            raise SplineError(f's = {s.min():g} .. {s.max():g}: outside [0, 1]')
        return _basis(self.knots, DEGREE, s, derivative) @ self._merge()

    def sample(self, control: Array, s: Array, duration: float) -> tuple[Array, Array, Array]:
        """Return coordinates (n, n_q) and two derivatives by time at normalised times s (n,).

        `control` are the free control values, shape (n_free, n_q); the duration is in seconds.
        """
        q, dq, ddq = (self.basis(s, derivative) @ control for derivative in range(3))
        return q, dq / duration, ddq / duration**2

    def fit(self, s: Array, values: Array) -> Array:
        """Free control values nearest to samples in the least-squares sense.

        Parameters
        ----------
        s : array, shape (n,)
            Normalised times.
        values : array, shape (n, n_q)
            Samples; the first and last are met exactly if they are at s = 0 and s = 1.

        Returns
        -------
        array, shape (n_free, n_q)
        """
        basis = self.basis(s)
        first, last = values[0], values[-1]
        inner = basis[:, 1:-1]
        rest = values - basis[:, :1] * first - basis[:, -1:] * last
        middle = np.linalg.lstsq(inner, rest, rcond=None)[0]
        return np.vstack((first, middle, last))

    def _merge(self) -> Array:
        merge = np.zeros((self.n_control, self.n_free))
        merged = self._merged
        merge[merged - 1 : self.n_control - merged + 1] = np.eye(self.n_free)
        merge[:merged, 0] = 1.0
        merge[-merged:, -1] = 1.0
        return merge


def _basis(knots: Array, degree: int, s: Array, derivative: int) -> Array:
    """All B-splines of a knot vector at s, or a derivative, by Cox-de Boor's recurrence.

    The recurrence divides 0 by 0 at multiple knots; such terms are 0.
    """
    n = len(knots) - degree - 1
    if degree == 0:
        # The last piece that is not empty holds its right end.
        piece = np.clip(np.searchsorted(knots, s, side='right') - 1, 0, n - 1)
        piece = np.minimum(piece, int(np.flatnonzero(np.diff(knots) > 0.0)[-1]))
        return np.eye(n)[piece]
    lower = _basis(knots, degree - 1, s, max(derivative - 1, 0))
    width = knots[degree:] - knots[: n + 1]
    share = np.divide(1.0, width, out=np.zeros(n + 1), where=width > 0.0)
    if derivative > 0:
        scaled = degree * lower * share
        return scaled[:, :-1] - scaled[:, 1:]
    rising = (s[:, None] - knots[:n]) * share[:-1] * lower[:, :-1]
    falling = (knots[degree + 1 :] - s[:, None]) * share[1:] * lower[:, 1:]
    return np.asarray(rising + falling)


def require_nodes(spline: RestToRestSpline, n_nodes: int) -> None:
    """Refuse a number of time nodes that does not fit a spline: two intervals in each piece.

    Raises
    ------
    SplineError
        `n_nodes` is not m k + 1, where m is 2 (n_control - 3), and 4 (n_control - 4) with rest in
        acceleration.
    """
    spans = spline.n_spans
    least = 4 * (spans - 1) if spline.rest == 'acceleration' else 2 * spans
    if n_nodes < least + 1 or (n_nodes - 1) % least:
        raise SplineError(
            f'n_nodes = {n_nodes}: with n_control = {spline.n_control} and rest in {spline.rest}, '
            f'{least} k + 1 nodes are needed'
        )


def simpson_weights(n_nodes: int) -> Array:
    """Weights of the composite Simpson rule on [0, 1] (n_nodes odd), shape (n_nodes,).

    Raises
    ------
    SplineError
        An even number of nodes, or fewer than 3.
    """
    if n_nodes < 3 or n_nodes % 2 == 0:
        raise SplineError(f'n_nodes = {n_nodes}: an odd number of at least 3 is needed')
    weights = np.ones(n_nodes)
    weights[1:-1:2] = 4.0
    weights[2:-1:2] = 2.0
    return weights / (3.0 * (n_nodes - 1))
