# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle weights in the cost of the static optimisation, and least activations of antagonists."""

from __future__ import annotations

import re
from enum import StrEnum

import numpy as np

from human_model.tables import read_table
from human_model.typing import Array
from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.muscles.curves import MuscleParameters


class MuscleWeighting(StrEnum):
    """What a muscle's activation weighs in the cost (Ackermann and van den Bogert 2010).

    J Biomech 43:1055: every muscle the same, or each its volume.
    """

    EQUAL = 'equal'
    VOLUME = 'volume'


def muscle_weights(muscles: MuscleParameters, weighting: str) -> Array:
    """Return the weights (n_m,) of the muscles; their mean is 1.

    Parameters
    ----------
    muscles
        Their parameters.  A volume is optimal fibre length times physiological cross-section, and
        that is proportional to the maximum isometric force.
    weighting
        One of `MuscleWeighting`.

    Raises
    ------
    OptionError
        If the weighting is not known.
    """
    try:
        kind = MuscleWeighting(weighting)
    except ValueError:
        known = ', '.join(MuscleWeighting)
        raise OptionError(
            f'muscle_weighting {weighting!r} is not known; options: {known}'
        ) from None
    if kind is MuscleWeighting.EQUAL:
        return np.ones_like(muscles.max_isometric_force)
    volume = muscles.max_isometric_force * muscles.optimal_fiber_length
    return np.asarray(volume / volume.mean())


def least_activations(muscle_names: tuple[str, ...], abdominal: float) -> Array:
    """Return the least activations (n_m,) of the muscles.

    Static optimisation never lets an antagonist work more than it must.  People brace: a least
    activation of the abdominal muscles (`data/abdominal_muscles.csv`), for example one measured by
    electromyography, shows what that costs the spine.

    Parameters
    ----------
    muscle_names
        Names in the model.
    abdominal
        Of the abdominal muscles, 0 to 1.

    Raises
    ------
    OptionError
        If the activation is not in [0, 1), or not 0 for a model without abdominal muscles.
    """
    if not 0.0 <= abdominal < 1.0:
        raise OptionError(f'abdominal_activation {abdominal} must be in [0, 1)')
    rows = read_table('muscle_analyzer', 'abdominal_muscles.csv', 'pattern')
    pattern = re.compile('|'.join(row['pattern'] for row in rows))
    of_group = np.array([pattern.search(name) is not None for name in muscle_names])
    if abdominal > 0.0 and not of_group.any():
        raise OptionError(f'abdominal_activation {abdominal}: the model has no abdominal muscle')
    return np.where(of_group, abdominal, 0.0)
