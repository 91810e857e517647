# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Results of one lift that the monitor assesses: spine load, joint torques, activations."""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass

import numpy as np

from human_model.motion import all_finite
from human_model.typing import Array, BoolArray
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import array


def _series(owner: object, time: Array, solved: BoolArray) -> None:
    """Check the clock and the solve flags that every series has."""
    name = type(owner).__name__
    stamps = np.asarray(time, dtype=np.float64)
    n = stamps.size
    if n == 0:
        raise InvalidInputError(f'{name}.time', [], 'must not be empty')
    array(f'{name}.time', stamps, (n,))
    seconds = stamps.tolist()
    if not all(map(math.isfinite, seconds)) or not all(map(operator.lt, seconds, seconds[1:])):
        raise InvalidInputError(f'{name}.time', seconds[:5], 'must be finite and increase')
    flags = np.asarray(solved, dtype=bool)
    if flags.shape != (n,):
        raise InvalidInputError(f'{name}.solved', flags.shape, f'must have the shape {(n,)}')
    object.__setattr__(owner, 'time', stamps)
    object.__setattr__(owner, 'solved', flags)


def _column(
    owner: object,
    field: str,
    shape: tuple[int, ...],
    solved: BoolArray,
    may_be_unknown: bool = False,
) -> None:
    """Check the shape of a field and that solved rows are finite."""
    name = f'{type(owner).__name__}.{field}'
    values = array(name, getattr(owner, field), shape)
    if not (may_be_unknown or all_finite(values) or all_finite(values[solved])):
        raise InvalidInputError(name, 'NaN', 'must be finite in every solved sample')
    object.__setattr__(owner, field, values)


@dataclass(frozen=True)
class TorqueSeries:
    """Joint torques with their dynamic limits over a lift.

    Attributes
    ----------
    time : array (n,)
        [s].
    joints : tuple of n_j names
    torque, lower, upper : arrays (n, n_j)
        [N m]; bounds are NaN where no strength is published for a joint.
    solved : array of bool (n,)
    """

    time: Array
    joints: tuple[str, ...]
    torque: Array
    lower: Array
    upper: Array
    solved: BoolArray

    def __post_init__(self) -> None:
        """Refuse wrong shapes and NaN in solved samples."""
        _series(self, self.time, self.solved)
        for field in ('torque', 'lower', 'upper'):
            _column(
                self,
                field,
                (len(self.time), len(self.joints)),
                self.solved,
                may_be_unknown=field != 'torque',
            )


@dataclass(frozen=True)
class ActivationSeries:
    """Muscle activations over a lift.

    Attributes
    ----------
    time : array (n,)
        [s].
    muscles : tuple of n_m names
    activation : array (n, n_m)
        [0..1].
    solved : array of bool (n,)
    """

    time: Array
    muscles: tuple[str, ...]
    activation: Array
    solved: BoolArray

    def __post_init__(self) -> None:
        """Refuse wrong shapes and NaN in solved samples."""
        _series(self, self.time, self.solved)
        _column(self, 'activation', (len(self.time), len(self.muscles)), self.solved)


@dataclass(frozen=True)
class LiftLoads:
    """Loads of one lift, recorded or predicted.

    Attributes
    ----------
    lift_id : str
    start : float
        Start of the lift on the clock of the series [s].
    time : array (n,)
        Of the spine load [s].
    compression, anterior_shear : arrays (n,)
        L5-S1 [N], positive as in the interface package.
    solved : array of bool (n,)
        Samples of the spine load whose solve report is good.
    torques : TorqueSeries, optional
    activations : ActivationSeries, optional
    """

    lift_id: str
    start: float
    time: Array
    compression: Array
    anterior_shear: Array
    solved: BoolArray
    torques: TorqueSeries | None = None
    activations: ActivationSeries | None = None

    def __post_init__(self) -> None:
        """Refuse wrong shapes and NaN in solved samples."""
        _series(self, self.time, self.solved)
        for field in ('compression', 'anterior_shear'):
            _column(self, field, (len(self.time),), self.solved)

    def left_out(self) -> int:
        """Return how many samples of all series are not solved."""
        series = [self.solved]
        if self.torques is not None:
            series.append(self.torques.solved)
        if self.activations is not None:
            series.append(self.activations.solved)
        return int(sum(np.count_nonzero(~flags) for flags in series))
