# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the front door; those of the packages behind it pass through unchanged."""

from __future__ import annotations

from pathlib import Path

from human_model.exceptions import LiftingError
from human_model.report import SolveReport


class FrontDoorError(LiftingError):
    """Base of the exceptions of this package."""


class IncompleteRecordingError(FrontDoorError):
    """A recording lacks a topic that is needed.

    Attributes
    ----------
    path : Path
    topic : str
    """

    def __init__(self, path: Path, topic: str) -> None:
        super().__init__(f'{path}: no message on topic {topic!r}')
        self.path = path
        self.topic = topic


class IncompleteLiftError(FrontDoorError):
    """A lift lacks something that the computation needs.

    Attributes
    ----------
    lift_id, missing : str
    """

    def __init__(self, lift_id: str, missing: str) -> None:
        super().__init__(f'lift {lift_id!r}: {missing} is needed')
        self.lift_id = lift_id
        self.missing = missing


class NoSolutionError(FrontDoorError):
    """A prediction without a solution was used as a lift.

    Attributes
    ----------
    lift_id : str
    report : SolveReport
        Status and reason.
    """

    def __init__(self, lift_id: str, report: SolveReport) -> None:
        super().__init__(f'lift {lift_id!r}: {report.status.name}: {report.message}')
        self.lift_id = lift_id
        self.report = report
