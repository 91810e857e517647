# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Named subjects: the persons of the thesis, with its own link lengths where it prints them."""

from human_model.exceptions import SubjectError
from human_model.subject import Subject
from human_model.tables import Row, length_sum, read_table


def subject_names() -> tuple[str, ...]:
    """Names of the subjects that come with the package."""
    return tuple(_subjects())


def named_subject(name: str) -> Subject:
    """Subject of ``data/subjects.csv``, with the thesis' link lengths if it prints them.

    Raises
    ------
    SubjectError
        If there is no subject of that name.
    """
    rows = _subjects()
    if name not in rows:
        raise SubjectError(
            'subject', name, f'no subject named {name!r}; there are {", ".join(rows)}'
        )
    row = rows[name]
    return Subject(
        pseudonym=name,
        sex=row['sex'],
        mass=row.number('mass'),
        stature=row.number('stature'),
        age=row.number('age'),
        strength_z=row.number('strength_z'),
        lengths=_lengths(name),
    )


def _subjects() -> dict[str, Row]:
    rows = read_table('human_model', 'subjects.csv', 'name sex mass stature age strength_z')
    return {row['name']: row for row in rows}


def _lengths(name: str) -> dict[str, float]:
    table = read_table('human_model', 'thesis_lengths.csv', 'subject length factor link plus')
    rows = [row for row in table if row['subject'] == name]
    if not rows:
        return {}
    printed = read_table('human_model', f'{name}_links.csv', 'link length')
    links = {row['link']: row.number('length') for row in printed}
    return {
        row['length']: row.number('factor') * links[row['link']] + length_sum(row['plus'], links)
        for row in rows
    }
