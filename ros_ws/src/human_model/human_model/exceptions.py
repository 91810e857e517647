# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the human model, and the root of the exceptions of all packages."""


class LiftingError(Exception):
    """Base of the exceptions of all packages of the project."""


class HumanModelError(LiftingError, ValueError):
    """Base of every error this package raises on bad input."""


class SubjectError(HumanModelError):
    """A field of the subject is missing, of the wrong kind or out of its range.

    Attributes
    ----------
    field : str
        Name with its place, for example ``subject.mass``.
    value : object
        Offending value; None: the field is missing.
    problem : str
    """

    def __init__(self, field: str, value: object, problem: str) -> None:
        super().__init__(field, value, problem)
        self.field, self.value, self.problem = field, value, problem

    def __str__(self) -> str:
        """Return field and problem."""
        return f'{self.field}: {self.problem}'


class MotionError(HumanModelError):
    """The arrays of a motion do not fit together."""


class AnthropometryError(HumanModelError):
    """A length, mass or inertia is missing or not physical."""


class ChainError(HumanModelError):
    """A chain table is inconsistent."""


class StrengthError(HumanModelError):
    """A joint strength is asked for that the tables do not hold."""


class BoxError(HumanModelError):
    """A field of a box is out of its range.

    Parameters
    ----------
    field : str
    value : object
    problem : str
        Requirement on the value.
    """

    def __init__(self, field: str, value: object, problem: str) -> None:
        super().__init__(f'box.{field} = {value}: {problem}')
        self.field = field
        self.value = value


class TableError(HumanModelError):
    """A table cannot be read, or a cell of it has a wrong value.

    Parameters
    ----------
    file : str
    line : int
        From 1; 0: the whole file.
    column : str
        Empty: the whole line.
    value : object
        Content that was refused; None: there is none.
    problem : str
        Requirement on the content.
    """

    def __init__(self, file: str, line: int, column: str, value: object, problem: str) -> None:
        place = f'{file}' + (f', line {line}' if line else '')
        place += f', column {column!r}' if column else ''
        found = '' if value is None else f', found {value!r}'
        super().__init__(f'{place}: {problem}{found}')
        self.file = file
        self.line = line
        self.column = column
        self.value = value


class FieldError(HumanModelError):
    """A field of a file is missing, unknown or has a wrong value."""


class StorageError(HumanModelError):
    """An OpenSim table over time cannot be read or written; names file, line and column.

    Parameters
    ----------
    path : object
        The file, or the table's name.
    problem : str
        What is wrong, with the offending value.
    line : int, optional
        1-based line number.
    column : str, optional
        Label of the column.
    """

    def __init__(
        self, path: object, problem: str, *, line: int | None = None, column: str | None = None
    ) -> None:
        where = f'{path}'
        if line is not None:
            where += f', line {line}'
        if column is not None:
            where += f', column {column!r}'
        super().__init__(f'{where}: {problem}')
        self.path = path
        self.problem = problem
        self.line = line
        self.column = column
