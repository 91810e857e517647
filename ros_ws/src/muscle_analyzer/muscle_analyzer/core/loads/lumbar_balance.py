# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which lumbar moments the muscles balance, and what holds the abdominal body.

In the lifting full-body model five lumbar levels and a mass-less abdominal body follow the L5-S1
joint through linear couplers (lumbar rhythm).  OpenSim's static optimisation balances the coupled
coordinate: one equation for all levels.  The moments at a single level may then be left to the
couplers, for which no tissue stands, and obliques that pull on the abdominal body become back
extensors through its coupler.

`levels` balances each level by itself, about its three axes, and each equation has a reserve
(`data/level_reserves.csv`).  Single-level equilibrium at L5-S1 alone violates the equilibrium of
the other levels (Gagnon et al. 2011, doi 10.1016/j.jbiomech.2011.03.002).  The rhythm stays the
kinematic model: the motion is that of the coupled model, only the balance has more equations.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from human_model.typing import Array, IntArray
from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.loads.joint_loads import ABDOMEN, L5
from muscle_analyzer.core.multibody.model import MultibodyModel, compile_model
from muscle_analyzer.core.osim.model import Coupler, OsimModel

#: Bodies whose joints are the lumbar levels above L5-S1.
UPPER_LEVELS = ('lumbar4', 'lumbar3', 'lumbar2', 'lumbar1', 'torso')
#: Unknown coordinates of the root, which no muscle balances.
ROOT_COORDINATES = 'pelvis_'


class LumbarBalance(StrEnum):
    """Lumbar moments that muscles balance: those of the coupled coordinates, or of each level."""

    COUPLED = 'coupled'
    LEVELS = 'levels'


class AbdomenSupport(StrEnum):
    """What carries the muscles' pull on the abdominal body: the sacrum, or the lumbar rhythm.

    `RHYTHM` is OpenSim's form.  With `LEVELS` the sacrum carries it in any case.
    """

    SACRUM = 'sacrum'
    RHYTHM = 'rhythm'


def lumbar_balance(name: str) -> LumbarBalance:
    """Return the option of that name.

    Raises
    ------
    OptionError
        If it is not known.
    """
    try:
        return LumbarBalance(name)
    except ValueError:
        known = ', '.join(LumbarBalance)
        raise OptionError(f'lumbar_balance {name!r} is not known; options: {known}') from None


def abdomen_support(name: str) -> AbdomenSupport:
    """Return the option of that name.

    Raises
    ------
    OptionError
        If it is not known.
    """
    try:
        return AbdomenSupport(name)
    except ValueError:
        known = ', '.join(AbdomenSupport)
        raise OptionError(f'abdomen {name!r} is not known; options: {known}') from None


@dataclass(frozen=True, eq=False)
class BalancedModel:
    """The model whose coordinates are balanced, and its motion from that of the coupled model.

    Attributes
    ----------
    model : MultibodyModel
        The given model, with some coupled coordinates independent.
    source : ndarray of int, shape (n_x,)
        Coordinate of the given model that each of its coordinates follows.
    gain, offset : ndarray, shape (n_x,)
        Its value is the gain times the value of that coordinate, plus the offset.
    balanced : ndarray of int, shape (n_c,)
        Coordinates whose torques muscles and reserves balance.
    lumbar : tuple of str
        Those of them that belong to the lumbar joints.
    """

    model: MultibodyModel
    source: IntArray
    gain: Array
    offset: Array
    balanced: IntArray
    lumbar: tuple[str, ...]


def balanced_model(
    model: MultibodyModel, balance: LumbarBalance, abdomen: AbdomenSupport
) -> BalancedModel:
    """Return the model whose coordinates are balanced.

    Parameters
    ----------
    model
        The coupled model.
    balance, abdomen
        The options.

    Raises
    ------
    OptionError
        If a coupler to be released is not linear.
    """
    levels = balance is LumbarBalance.LEVELS
    held = abdomen is AbdomenSupport.SACRUM or levels
    abdominal = _coordinates(model.source, (ABDOMEN,)) if held else ()
    upper = _coordinates(model.source, UPPER_LEVELS) if levels else ()
    released = {c.dependent: c for c in model.source.couplers if c.dependent in upper + abdominal}
    free = model
    if released:
        kept = tuple(c for c in model.source.couplers if c.dependent not in released)
        free = compile_model(replace(model.source, couplers=kept))
    source, gain, offset = [], [], []
    for name in free.coordinate_names:
        coupler = released.get(name)
        source.append(model.coordinate_index(coupler.independent if coupler else name))
        slope, constant = _line(coupler) if coupler else (1.0, 0.0)
        gain.append(slope)
        offset.append(constant)
    balanced = [
        k
        for k, name in enumerate(free.coordinate_names)
        if not name.startswith(ROOT_COORDINATES) and name not in abdominal
    ]
    first = _coordinates(model.source, (L5,))
    lumbar = tuple(free.coordinate_names[k] for k in balanced)
    return BalancedModel(
        free,
        np.array(source, np.int64),
        np.array(gain),
        np.array(offset),
        np.array(balanced, np.int64),
        tuple(name for name in lumbar if name in first + upper),
    )


def _coordinates(model: OsimModel, bodies: tuple[str, ...]) -> tuple[str, ...]:
    """Return the coordinates of the joints that carry some bodies."""
    return tuple(
        c.name for joint in model.joints if joint.child.body in bodies for c in joint.coordinates
    )


def _line(coupler: Coupler) -> tuple[float, float]:
    """Return slope and constant of a coupler's line."""
    if not coupler.function.is_line():
        raise OptionError(f'coupler {coupler.name}: only a linear one can be released')
    constant, slope, _ = coupler.function.derivatives(0.0)
    return slope, constant
