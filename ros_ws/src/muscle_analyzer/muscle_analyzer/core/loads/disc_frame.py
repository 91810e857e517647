# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The frame of the L5-S1 disc, and compression and shear in it with their sensitivity.

The vertebral frames of the musculoskeletal model are not turned by the lordosis, so the disc's
orientation has to come from elsewhere. Options, with numbers and sources in
`data/disc_frames.csv`:

`bruno2015` (default)
    The disc normal leans forward by 21 degrees against the fifth lumbar vertebra's long axis.
`chaffin`
    The sacral end plate's angle to the horizontal from trunk flexion and knee angle. It is made
    for static postures in the sagittal plane.
`vertebral`
    Not turned; what OpenSim's joint reaction analysis gives when asked for the child's frame.

Why `bruno2015`: it belongs to a musculoskeletal model of the same family, follows the spine in
every posture, asymmetric ones included, and in flexed postures it gives nearly the same shear as
`chaffin`. `vertebral` gives backward shear in deep flexion, where the trunk's weight pulls L5
forwards. Ten degrees move some 430 N between compression and shear at 2500 N: hence the
sensitivities.

Signs (force of S1 on L5; x anterior, y left, z along the disc normal towards the head):
compression = +F_z, anterior shear = -F_x (the disc holds L5 back), lateral shear = +F_y.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.tables import read_table
from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError, OptionError

#: OpenSim's body axes (forward, up, right) as columns forward, left, up.
FORWARD_LEFT_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
DEGREE = math.pi / 180.0
#: Parameters of `chaffin` in the order of `DiscSetting.regression`.
_REGRESSION = ('constant', 'beta_0', 'beta_T', 'beta_K', 'beta_TK', 'beta_TT', 'beta_KK')


class DiscOption(StrEnum):
    """Named sources of the disc's orientation."""

    BRUNO2015 = 'bruno2015'
    CHAFFIN = 'chaffin'
    VERTEBRAL = 'vertebral'


DEFAULT_OPTION = DiscOption.BRUNO2015


@dataclass(frozen=True, eq=False)
class DiscLoad:
    """Load of the L5-S1 disc.

    Attributes
    ----------
    force : (3,) array
        Force of S1 on L5 in the disc frame (anterior, left, cranial), N.
    moment : (3,) array
        Moment of S1 on L5 about the joint centre in the disc frame, N m.
    """

    force: Array
    moment: Array

    @property
    def compression(self) -> float:
        """Of the disc, N."""
        return float(self.force[2])

    @property
    def anterior_shear(self) -> float:
        """Positive when L5 is pushed forward on S1, N."""
        return float(-self.force[0])

    @property
    def lateral_shear(self) -> float:
        """Positive to the left, N."""
        return float(self.force[1])

    @property
    def compression_per_degree(self) -> float:
        """Change per degree that the disc normal is leant further forward, N/deg."""
        # Leaning the normal forward turns it towards x, and x towards -z.
        return float(self.force[0]) * DEGREE

    @property
    def shear_per_degree(self) -> float:
        """Change of the anterior shear per degree of the same, N/deg."""
        return float(self.force[2]) * DEGREE


@cache
def disc_parameters(option: DiscOption) -> dict[str, float]:
    """Return an option's numbers by parameter name."""
    rows = read_table('muscle_analyzer', 'disc_frames.csv', 'option parameter value')
    return {row['parameter']: row.number('value') for row in rows if row['option'] == option}


def disc_option(name: str) -> DiscOption:
    """Return the option of that name, or raise OptionError naming the known ones."""
    try:
        return DiscOption(name)
    except ValueError:
        known = ', '.join(DiscOption)
        raise OptionError(f'disc frame {name!r} is not known; options: {known}') from None


class DiscSetting(NamedTuple):
    """An option with its numbers, for the compiled functions.

    Attributes
    ----------
    by_posture : bool
        Whether the disc's orientation is that of `chaffin`.
    tilt : float
        Forward tilt against the vertebra, rad; 0 with `chaffin`.
    regression : (7,) array
        Constant, and coefficients of 1, T, K, T K, T^2 and K^2 of `chaffin`; deg.
    """

    by_posture: bool
    tilt: float
    regression: Array


@cache
def disc_setting(option: DiscOption) -> DiscSetting:
    """Return an option with its numbers."""
    regression = np.array([disc_parameters(DiscOption.CHAFFIN)[name] for name in _REGRESSION])
    if option is DiscOption.CHAFFIN:
        return DiscSetting(True, 0.0, regression)
    return DiscSetting(False, math.radians(disc_parameters(option)['forward_tilt']), regression)


@njit
def sacral_angle(regression: Array, trunk_flexion: float, knee_angle: float) -> float:
    """Return the sacral end plate's angle to the horizontal by Chaffin, Andersson and Martin, deg.

    Parameters
    ----------
    regression : ndarray, shape (7,)
        See `DiscSetting`.
    trunk_flexion : float
        T, of the trunk from the vertical, forwards positive, deg.
    knee_angle : float
        K, included knee angle, 180 with a straight leg, deg.
    """
    t, k = trunk_flexion, knee_angle
    constant, b0, bt, bk, btk, btt, bkk = regression
    beta = b0 + bt * t + bk * k + btk * t * k + btt * t * t + bkk * k * k
    return float(constant + beta)


@njit
def leant_forward(frame: Array, angle: float) -> Array:
    """Return a frame (3, 3), columns forward, left, up, leant forward about its left axis, rad."""
    leant = frame.copy()
    _lean_forward(leant, angle)
    return leant


@kernel
def _lean_forward(frame: Array, angle: float) -> None:
    """Turn a frame into that of `leant_forward`."""
    c, s = np.cos(angle), np.sin(angle)
    for i in range(3):
        forward, up = frame[i, 0], frame[i, 2]
        frame[i, 0] = forward * c - up * s
        frame[i, 2] = forward * s + up * c


@kernel
def turn_disc(
    setting: DiscSetting, vertebra: Array, trunk: Array, knee_flexion: float, rotation: Array
) -> None:
    """Fill the rotation (3, 3) that `disc_rotation` gives."""
    if not setting.by_posture:
        for i in range(3):
            # Forward, left, up out of forward, up, right.
            rotation[i, 0] = vertebra[i, 0]
            rotation[i, 1] = -vertebra[i, 2]
            rotation[i, 2] = vertebra[i, 1]
        _lean_forward(rotation, setting.tilt)
        return
    # In the sagittal plane of the vertebra: its axis to the left, made level.
    x, z = -vertebra[0, 2], -vertebra[2, 2]
    size = np.sqrt(x * x + z * z)
    x, z = x / size, z / size
    rotation[0, 0], rotation[1, 0], rotation[2, 0] = -z, 0.0, x
    rotation[0, 1], rotation[1, 1], rotation[2, 1] = x, 0.0, z
    rotation[0, 2], rotation[1, 2], rotation[2, 2] = 0.0, 1.0, 0.0
    lean = np.degrees(np.arctan2(trunk[2, 1] * x - trunk[0, 1] * z, trunk[1, 1]))
    knee = 180.0 - np.degrees(knee_flexion)
    _lean_forward(rotation, np.radians(sacral_angle(setting.regression, lean, knee)))


def disc_rotation(option: DiscOption, vertebra: Array, trunk: Array, knee_flexion: float) -> Array:
    """Return the rotation (3, 3) ground <- disc, ground in OpenSim's axes.

    Parameters
    ----------
    option : DiscOption
    vertebra : (3, 3) array
        Ground <- fifth lumbar vertebra.
    trunk : (3, 3) array
        Ground <- thorax; only `chaffin` looks at it.
    knee_flexion : float
        Mean of both knees, rad; only `chaffin` looks at it.
    """
    vertebra, trunk = (np.ascontiguousarray(r, np.float64) for r in (vertebra, trunk))
    rotation = np.empty((3, 3))
    turn_disc(disc_setting(option), vertebra, trunk, float(knee_flexion), rotation)
    return rotation


def disc_load(reaction: Array, rotation: Array) -> DiscLoad:
    """Return compression, shear and sensitivities of a reaction.

    Parameters
    ----------
    reaction : (6,) array
        Moment about the joint's centre and force of S1 on L5, ground axes, N m and N.
    rotation : (3, 3) array
        Ground <- disc.

    Raises
    ------
    InputArrayError
        If the reaction is not finite.
    """
    if reaction.shape != (6,) or not np.all(np.isfinite(reaction)):
        raise InputArrayError(f'L5-S1 reaction {reaction} is not six finite numbers')
    return DiscLoad(rotation.T @ reaction[3:], rotation.T @ reaction[:3])
