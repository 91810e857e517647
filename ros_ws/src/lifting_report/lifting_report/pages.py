# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""HTML pages from the templates in ``templates/``: escaped, complete in one file."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from injury_monitor.core.assessment import Criterion
from injury_monitor.core.lifting_equation import lifting_index_band
from lifting_report.model_limits import MODEL_LIMITS
from lifting_report.report_data import Missing
from muscle_analyzer.core.emg.comparison import EmgMatch
from muscle_analyzer.core.emg.envelopes import GIVEN_MVC

_DASH = '–'
#: Narrow no-break space, which keeps number and unit together.
_SPACE = '\u202f'

LIFT_NAMES = {'measured': 'recorded lift', 'predicted': 'optimal lift'}
SIDES = {'r': 'right', 'l': 'left'}
CRITERIA = {
    'compression_action': 'NIOSH action limit',
    'compression_maximum': 'NIOSH maximum permissible limit',
    'shear_occasional': 'limit up to 100 loads a day',
    'shear_frequent': 'limit above 100 loads a day',
    'torque_index': 'joint torque index',
    'activation_index': 'activation index',
}


@dataclass(frozen=True)
class Card:
    """A peak beside its limit.

    Attributes
    ----------
    title, value, detail, verdict : str
        Title, large number, small text beside it, one line of judgement.
    level : str
        ``good``, ``action``, ``hazard`` or ''.
    rows : tuple of (str, str)
        Name and value below.
    emphasis : str
        Name of the row in bold.
    """

    title: str
    value: str
    verdict: str
    level: str
    rows: tuple[tuple[str, str], ...] = ()
    detail: str = ''
    emphasis: str = ''


@dataclass(frozen=True)
class Drawing:
    """A figure; without `svg` the caption is the reason why it is not available."""

    title: str
    svg: str
    caption: str


def amount(value: float, unit: str = '', digits: int = 0) -> str:
    """Return a number with its unit, a dash for NaN, words for infinity."""
    if math.isnan(value):
        return _DASH
    if math.isinf(value):
        return 'no limit' if value > 0.0 else '−no limit'
    number = f'{value:.{digits}f}'.replace('-', '−')
    if number.strip('−0.') == '':
        number = number.replace('−', '')
    return f'{number}{_SPACE}{unit}' if unit and unit != '1' else number


def short(value: float) -> str:
    """Return a number with three significant digits, a dash for NaN."""
    return _DASH if math.isnan(value) else f'{value:.3g}'.replace('-', '−')


def criterion_name(row: Criterion) -> str:
    """Return the name of a criterion in words."""
    return CRITERIA.get(row.criterion, row.criterion.replace('_', ' '))


def _normalised_by(match: EmgMatch) -> str:
    return 'MVC' if match.normalised_by == GIVEN_MVC else match.normalised_by


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).with_name('templates')),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        amount=amount, short=short, state=lambda name: name.replace('_', ' ').lower()
    )
    environment.tests['missing'] = lambda part: isinstance(part, Missing)
    environment.globals.update(
        band=lifting_index_band,
        criterion=criterion_name,
        lift_names=LIFT_NAMES,
        limits=MODEL_LIMITS,
        normalised_by=_normalised_by,
        sides=SIDES,
    )
    return environment


def render_page(template: str, **values: object) -> str:
    """Return a page as HTML text.

    Parameters
    ----------
    template : str
        File in ``templates/``.
    values
        What the template shows; all text is escaped.
    """
    return _environment().get_template(template).render(**values)


def write_page(path: Path, page: str) -> Path:
    """Write a page; its folder is created if necessary. Return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding='utf-8')
    return path


def drawing(title: str, draw: Callable[[], str], caption: str, missing: str = '') -> Drawing:
    """Return a figure, or the reason why it is missing."""
    return Drawing(title, '', missing) if missing else Drawing(title, draw(), caption)
