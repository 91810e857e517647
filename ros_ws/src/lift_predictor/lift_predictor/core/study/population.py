# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects of a study: listed, in a file of their own, or a seeded sample of distributions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np

from human_model.exceptions import HumanModelError, TableError
from human_model.subject import Subject, read_subject
from human_model.tables import Row, read_file
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.planning.fields import Fields

MAX_DRAWS: Final = 1000
"""Draws of one person at most before a distribution counts as outside of what is accepted."""

Draw = Callable[[np.random.Generator], Any]


def read_subjects(fields: Fields, folder: Path) -> tuple[Subject, ...]:
    """Read the subjects of a study: exactly one of `list`, `file` and `sample`.

    Parameters
    ----------
    fields : Fields
        Section `subjects`.
    folder : Path
        Where a relative file name begins.

    Raises
    ------
    PlanError
        Naming file, field and value.
    """
    kinds = [key for key in ('list', 'file', 'sample') if key in fields]
    if len(kinds) != 1:
        raise fields.error('list, file, sample', f'exactly one is needed, found {kinds or "none"}')
    if kinds[0] == 'list':
        subjects = tuple(read_subject(entry) for entry in fields.entries('list'))
    elif kinds[0] == 'file':
        subjects = _from_csv(folder / fields.text('file'))
    else:
        subjects = _sample(fields.section('sample'))
    fields.finish()
    names = [subject.pseudonym for subject in subjects]
    for name in names:
        if names.count(name) > 1:
            raise fields.error('pseudonym', f'{name!r} occurs {names.count(name)} times')
    return subjects


def _from_csv(path: Path) -> tuple[Subject, ...]:
    """Read a table with the columns pseudonym, sex, mass, stature, age and maybe strength_z."""
    try:
        return tuple(
            read_subject(Fields(row.file, f'line {row.line}', _values(row)))
            for row in read_file(path, 'pseudonym sex mass stature age')
        )
    except TableError as error:
        raise PlanError(str(error)) from error


def _values(row: Row) -> dict[str, str | float]:
    texts = ('pseudonym', 'sex')
    return {key: row[key] if key in texts else row.number(key) for key in row}


def _sample(fields: Fields) -> tuple[Subject, ...]:
    """Draw subjects; the same seed gives the same ones."""
    count, seed = fields.whole('count'), fields.whole('seed')
    if count < 1:
        raise fields.error('count', f'{count}: at least 1 is needed')
    prefix = fields.text('prefix', 'P')
    by_bmi = 'bmi' in fields
    sex = _draw(fields, 'sex')
    numbers = {
        key: _draw(fields, key)
        for key in ('stature', 'bmi' if by_bmi else 'mass', 'age', 'strength_z')
        if key in fields or key != 'strength_z'
    }
    fields.finish()
    # One stream for each person: more of them do not change the first ones.
    return tuple(
        _person(fields, f'{prefix}{i:04d}', np.random.default_rng([seed, i]), sex, numbers)
        for i in range(count)
    )


def _person(
    fields: Fields, pseudonym: str, rng: np.random.Generator, sex: Draw, numbers: dict[str, Draw]
) -> Subject:
    for _ in range(MAX_DRAWS):
        values: dict[str, Any] = {'pseudonym': pseudonym, 'sex': sex(rng)}
        values |= {key: float(draw(rng)) for key, draw in numbers.items()}
        if 'bmi' in values:
            values['mass'] = values.pop('bmi') * values['stature'] ** 2
        try:
            return Subject.from_dict(values)
        except HumanModelError as error:
            problem = error
    raise fields.error('count', f'{MAX_DRAWS} draws gave no person that is accepted: {problem}')


def _draw(fields: Fields, key: str) -> Draw:
    """Return what draws one value: a constant, or a mapping with the name of a distribution.

    `{uniform: [low, high]}`, `{normal: [mean, sd]}`, `{choice: {value: weight, ...}}`.
    """
    entry = fields.take(key)
    if not isinstance(entry, dict):
        again = Fields(fields.source, fields.name, {key: entry})
        constant = again.text(key) if key == 'sex' else again.number(key)
        return lambda rng: constant
    if len(entry) != 1:
        raise fields.error(key, f'one distribution is needed, found {entry!r}')
    ((name, values),) = entry.items()
    inner = Fields(fields.source, f'{fields.name}.{key}', entry)
    if name == 'uniform':
        low, high = inner.numbers('uniform', 2)
        if low > high:
            raise inner.error('uniform', f'{low:g} is above {high:g}')
        return lambda rng: rng.uniform(low, high)
    if name == 'normal':
        mean, deviation = inner.numbers('normal', 2)
        if deviation < 0.0:
            raise inner.error('normal', f'standard deviation {deviation:g} is negative')
        return lambda rng: rng.normal(mean, deviation)
    if name == 'choice' and isinstance(values, dict) and values:
        shares = inner.section('choice')
        weights = np.array([shares.number(str(option)) for option in values])
        if not (weights.min() >= 0.0 and weights.sum() > 0.0):
            raise inner.error('choice', f'weights {weights.tolist()}')
        options = list(values)
        return lambda rng: options[int(rng.choice(len(options), p=weights / weights.sum()))]
    raise fields.error(key, f'{name!r} is not one of uniform, normal, choice (with weights)')
