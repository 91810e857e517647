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

import csv
import math
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.exceptions import InputArrayError, OptionError

Array = NDArray[np.float64]

#: OpenSim's body axes (forward, up, right) as columns forward, left, up.
FORWARD_LEFT_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


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
    compression, anterior_shear, lateral_shear : float
        N, signs as in the module's header.
    compression_per_degree, shear_per_degree : float
        Change of compression and anterior shear per degree that the disc normal is leant further
        forward, N/deg.
    """

    force: Array
    moment: Array
    compression: float
    anterior_shear: float
    lateral_shear: float
    compression_per_degree: float
    shear_per_degree: float


@cache
def disc_parameters(option: DiscOption) -> dict[str, float]:
    """Return an option's numbers by parameter name."""
    text = files('muscle_analyzer').joinpath('data/disc_frames.csv').read_text(encoding='utf-8')
    rows = csv.DictReader(text.splitlines())
    return {row['parameter']: float(row['value']) for row in rows if row['option'] == option}


def disc_option(name: str) -> DiscOption:
    """Return the option of that name, or raise OptionError naming the known ones."""
    try:
        return DiscOption(name)
    except ValueError:
        known = ', '.join(DiscOption)
        raise OptionError(f'disc frame {name!r} is not known; options: {known}') from None


def sacral_angle(trunk_flexion: float, knee_angle: float) -> float:
    """Return the sacral end plate's angle to the horizontal by Chaffin, Andersson and Martin, deg.

    Parameters
    ----------
    trunk_flexion : float
        T, of the trunk from the vertical, forwards positive, deg.
    knee_angle : float
        K, included knee angle, 180 with a straight leg, deg.
    """
    p = disc_parameters(DiscOption.CHAFFIN)
    t, k = trunk_flexion, knee_angle
    beta = (
        p['beta_0']
        + p['beta_T'] * t
        + p['beta_K'] * k
        + p['beta_TK'] * t * k
        + p['beta_TT'] * t * t
        + p['beta_KK'] * k * k
    )
    return p['constant'] + beta


def disc_rotation(
    option: DiscOption, vertebra: Array, trunk: Array, knee_flexion: float
) -> Array:
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
    if option is DiscOption.CHAFFIN:
        # In the sagittal plane of the vertebra: its axis to the left, made level.
        left = -vertebra[:, 2] + vertebra[1, 2] * np.array([0.0, 1.0, 0.0])
        left /= np.linalg.norm(left)
        up = np.array([0.0, 1.0, 0.0])
        forward = np.cross(left, up)
        lean = math.degrees(math.atan2(float(trunk[:, 1] @ forward), float(trunk[1, 1])))
        tilt = math.radians(sacral_angle(lean, 180.0 - math.degrees(knee_flexion)))
        upright = np.column_stack([forward, left, up])
    else:
        tilt = math.radians(disc_parameters(option)['forward_tilt'])
        upright = vertebra @ FORWARD_LEFT_UP
    return leant_forward(upright, tilt)


def leant_forward(frame: Array, angle: float) -> Array:
    """Return a frame (3, 3), columns forward, left, up, leant forward about its left axis, rad."""
    c, s = math.cos(angle), math.sin(angle)
    leant: Array = frame @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return leant


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
    force = rotation.T @ reaction[3:]
    degree = math.pi / 180.0
    return DiscLoad(
        force=force,
        moment=rotation.T @ reaction[:3],
        compression=float(force[2]),
        anterior_shear=float(-force[0]),
        lateral_shear=float(force[1]),
        # Leaning the normal forward turns it towards x, and x towards -z.
        compression_per_degree=float(force[0]) * degree,
        shear_per_degree=float(force[2]) * degree,
    )
