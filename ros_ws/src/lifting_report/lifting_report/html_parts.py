# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Small pieces of the page: tables, cards, figures, what is missing, numbers."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

_DASH = '–'


def text(value: object) -> str:
    """Return a value escaped for HTML."""
    return html.escape(str(value))


def amount(value: float, unit: str = '', digits: int = 0) -> str:
    """Return a number with its unit, a dash for NaN, a word for infinity."""
    if math.isnan(value):
        return _DASH
    if math.isinf(value):
        return 'no limit' if value > 0.0 else '−no limit'
    number = f'{value:.{digits}f}'.replace('-', '−')
    if number.strip('−0.') == '':
        number = number.replace('−', '')
    # A narrow no-break space keeps number and unit together.
    return f'{number}&#8239;{text(unit)}' if unit and unit != '1' else number


def absent(what: str, reason: str) -> str:
    """Return the box that stands where something is missing."""
    return (
        f'<p class="absent"><strong>{text(what)}: not available.</strong> '
        f'{text(reason) or "No reason was given."}</p>'
    )


@dataclass(frozen=True)
class Card:
    """A verdict card.

    Attributes
    ----------
    what, value, verdict : str
        HTML of title, large number and one line of judgement.
    level : str
        ``good``, ``action``, ``hazard`` or ''.
    rows : tuple of (str, str)
        HTML of name and value below.
    """

    what: str
    value: str
    verdict: str
    level: str
    rows: tuple[tuple[str, str], ...] = ()

    def render(self) -> str:
        """Return the HTML."""
        rows = ''.join(
            f'<li><span>{name}</span><span>{value}</span></li>' for name, value in self.rows
        )
        return (
            f'<div class="card {self.level}"><div class="what">{self.what}</div>'
            f'<div class="value">{self.value}</div>'
            f'<div class="verdict">{self.verdict}</div>'
            + (f'<ul>{rows}</ul>' if rows else '')
            + '</div>'
        )


def cards(items: Iterable[Card]) -> str:
    """Return a row of cards."""
    return '<div class="cards">' + ''.join(card.render() for card in items) + '</div>'


def figure(title: str, svg: str, caption: str) -> str:
    """Return a figure with title and caption."""
    return f'<figure><h4>{text(title)}</h4>{svg}<figcaption>{caption}</figcaption></figure>'


def table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Sequence[int] = ()) -> str:
    """Return a table.

    Parameters
    ----------
    head : sequence of str
    rows : iterable of sequences of HTML
    numbers : sequence of int
        Columns that hold numbers.
    """

    def cells(tag: str, row: Sequence[str]) -> str:
        return ''.join(
            f'<{tag}{" class=number" if k in numbers else ""}>{cell}</{tag}>'
            for k, cell in enumerate(row)
        )

    body = ''.join(f'<tr>{cells("td", row)}</tr>' for row in rows)
    return (
        f'<div class="scroll"><table><thead><tr>{cells("th", head)}</tr></thead>'
        f'<tbody>{body}</tbody></table></div>'
    )


def pill(label: str, level: str) -> str:
    """Return a short coloured label."""
    return f'<span class="pill {level}">{text(label)}</span>'


def facts(pairs: Iterable[tuple[str, str]]) -> str:
    """Return a grid of names and values (HTML)."""
    return (
        '<dl class="facts">'
        + ''.join(f'<div><dt>{text(name)}</dt><dd>{value}</dd></div>' for name, value in pairs)
        + '</dl>'
    )
