# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How strong a person's muscles are: maximum isometric forces by size, sex, age and percentile.

The option `population` makes the model's muscles follow the published strength of the joint that
each of them moves most (`human_model.strength`, the same data that limit the joint torques)::

    F / F_model = (tau / tau_reference) (H_reference / H)
    tau = (1 + z CV) tau_peak(sex, age, mass, stature), largest over the angle, at rest

with stature H, as the moment arms of the scaled model grow with it.  The reference is the person
that the generic model stands for (`data/reference_person.csv`), so that this person keeps the
model's forces.  Trunk and shoulder strength is published for all ages together; what age takes
from it is a second option (`data/strength_ageing.csv`).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from human_model.exceptions import StrengthError
from human_model.strength import JointStrength, StrengthBound, surface
from human_model.subject import Subject
from human_model.tables import Row, read_table
from human_model.typing import Array
from muscle_analyzer.core.exceptions import OptionError, ScalingError
from muscle_analyzer.core.osim.model import OsimModel

#: Angles over which the largest strength is looked for [rad]: beyond any joint's range.
_ANGLES = np.linspace(-np.pi, np.pi, 721)
#: Age of a row of `strength_muscles.csv` whose joint strength already depends on age.
_JOINT = 'joint'


class StrengthScaling(StrEnum):
    """What happens to the maximum isometric forces.

    `none` keeps them, as OpenSim does. `geometric` takes them as cross-sections of similar bodies,
    which grow with mass to the power 2/3. `population` follows published joint strength: sex, age,
    size and percentile.
    """

    NONE = 'none'
    GEOMETRIC = 'geometric'
    POPULATION = 'population'


@dataclass(frozen=True)
class StrengthOptions:
    """How strong the muscles are.

    Attributes
    ----------
    scaling
        What the maximum isometric forces follow.
    ageing
        Only with `population`: what age takes from muscles whose joint strength is published for
        all ages together, a name in `data/strength_ageing.csv`.
    coefficient_set
        Only with `population`: joint strength data (see `human_model.strength`).
    """

    scaling: StrengthScaling = StrengthScaling.NONE
    ageing: str = 'doherty2003'
    coefficient_set: str = 'anderson2007_nonneg'


def force_factors(model: OsimModel, subject: Subject, options: StrengthOptions) -> Array:
    """Return what the maximum isometric force of each muscle (n_m,) is multiplied with.

    Parameters
    ----------
    model
        Generic model.
    subject
        The person.
    options
        What strength follows.

    Raises
    ------
    OptionError
        If the ageing or the coefficient set is not known.
    ScalingError
        If a muscle has no row in `data/strength_muscles.csv`, or no strength is left of one.
    """
    if options.scaling is StrengthScaling.NONE:
        return np.ones(len(model.muscles))
    if options.scaling is StrengthScaling.GEOMETRIC:
        return np.full(len(model.muscles), (subject.mass / model.mass) ** (2.0 / 3.0))
    reference = reference_person()
    age = _ageing(options.ageing, subject.age) / _ageing(options.ageing, reference.age)
    try:
        own = JointStrength('3d_40dof', subject, options.coefficient_set)
        known = JointStrength('3d_40dof', reference, options.coefficient_set)
    except StrengthError as error:
        raise OptionError(f'strength population: {error}') from error
    columns = 'pattern coordinate bound ageing'
    table = read_table('muscle_analyzer', 'strength_muscles.csv', columns)
    rows = [(re.compile(row['pattern']), row) for row in table]
    ratios: dict[str, float] = {}
    for pattern, row in rows:
        joint = row['coordinate'], row['bound']
        ratio = _isometric(own.bound(*joint)) / _isometric(known.bound(*joint))
        aged = 1.0 if row['ageing'] == _JOINT else age
        ratios[pattern.pattern] = ratio * aged * reference.stature / subject.stature
    return np.array([ratios[_pattern(muscle.name, rows)] for muscle in model.muscles])


def reference_person() -> Subject:
    """Return the person whose muscles the generic model has."""
    columns = 'sex mass stature age strength_z'
    (row,) = read_table('muscle_analyzer', 'reference_person.csv', columns)
    mass, stature, age, strength_z = row.numbers('mass', 'stature', 'age', 'strength_z')
    return Subject('reference', row['sex'], mass, stature, age, strength_z)


def ageing_names() -> tuple[str, ...]:
    """Return the names of the known courses of ageing."""
    return tuple(row['name'] for row in _ageing_rows())


def _ageing_rows() -> tuple[Row, ...]:
    return read_table('muscle_analyzer', 'strength_ageing.csv', 'name from_age to_age loss')


def _ageing(name: str, age: float) -> float:
    """Return the strength as a fraction of that in youth."""
    for row in _ageing_rows():
        if row['name'] == name:
            first, last = row.number('from_age'), row.number('to_age')
            return 1.0 - row.number('loss') * float(np.clip((age - first) / (last - first), 0, 1))
    raise OptionError(
        f'strength_ageing {name!r} is not known; options: {", ".join(ageing_names())}'
    )


def _isometric(bound: StrengthBound) -> float:
    """Return the largest strength at rest over the angle [N m]."""
    largest = np.max(surface(bound.coefficients, _ANGLES, 0.0))
    return abs(bound.magnitude) * float(largest)


def _pattern(muscle: str, rows: list[tuple[re.Pattern[str], Row]]) -> str:
    for pattern, _ in rows:
        if pattern.search(muscle):
            return pattern.pattern
    raise ScalingError(
        f'muscle {muscle!r}: no row of strength_muscles.csv says which joint strength it follows; '
        'take strength none or geometric with this model'
    )
