# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the injury monitor; each names the field and the value that was refused."""

from __future__ import annotations

from human_model.exceptions import LiftingError


class InjuryMonitorError(LiftingError):
    """Base of every exception of this package."""


class InvalidInputError(InjuryMonitorError, ValueError):
    """A value from outside cannot be used.

    Parameters
    ----------
    field : str
        Name of the field.
    value : object
        Value that was given.
    reason : str
        Requirement on the field.
    """

    def __init__(self, field: str, value: object, reason: str) -> None:
        super().__init__(f'{field} = {value!r}: {reason}')
        self.field = field
        self.value = value


class UnknownAlarmError(InjuryMonitorError, KeyError):
    """An operator named an alarm this station does not have."""

    def __str__(self) -> str:
        """Return the message without the quotes that KeyError puts round it."""
        return str(self.args[0])


class AlarmCommandError(InjuryMonitorError):
    """An operator's command does not apply to the state the alarm is in."""


class ShelveDurationError(InvalidInputError):
    """A shelving time is not positive or is longer than allowed."""


class OperatorError(InvalidInputError):
    """A command does not name the role or terminal of the operator."""


class JournalError(InjuryMonitorError):
    """The alarm journal cannot be read or written.

    Attributes
    ----------
    path : Path or str
        File.
    problem : str
        What is wrong.
    """

    def __init__(self, path: object, problem: str) -> None:
        super().__init__(f'{path}: {problem}')
        self.path = path
        self.problem = problem


class JournalInUseError(JournalError):
    """Another process writes to the journal."""

    def __init__(self, path: object) -> None:
        super().__init__(path, 'another process writes to this journal')
