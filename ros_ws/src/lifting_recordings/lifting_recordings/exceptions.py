# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of bag import, reading, playing and recording."""

from human_model.exceptions import LiftingError


class BagError(LiftingError):
    """Base of the exceptions of this package."""


class FileFormatError(BagError):
    """A file does not hold what its format promises.

    Parameters
    ----------
    path : object
        The file.
    problem : str
        What is wrong, with the offending value.
    line : int, optional
        1-based line number.
    field : str, optional
        Column, label or header key.
    """

    def __init__(
        self, path: object, problem: str, *, line: int | None = None, field: str | None = None
    ) -> None:
        where = f'{path}'
        if line is not None:
            where += f', line {line}'
        if field is not None:
            where += f', field {field!r}'
        super().__init__(f'{where}: {problem}')
        self.path = path
        self.line = line
        self.field = field


class ConventionError(BagError):
    """A convention of the recording (units, axes, sides, plates) is ambiguous or contradictory.

    The message names the option that settles it.
    """


class SubjectFileError(BagError):
    """The subject and task file is incomplete or holds an implausible value."""


class UnreadableBagError(BagError):
    """A bag is empty, foreign, or damaged beyond recovery."""


class MessageTypeError(BagError):
    """A message definition is missing."""


class PlaybackError(BagError):
    """A bag cannot be played, e.g. expected subscribers never came."""


class StaticTrialError(BagError):
    """A static trial cannot serve for the calibration of the markers."""
