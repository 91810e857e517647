# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the report."""

from __future__ import annotations

from human_model.exceptions import LiftingError


class ReportError(LiftingError):
    """The data given for the report do not fit together.

    Parameters
    ----------
    field : str
        Name of the field.
    value : object
        What was given.
    reason : str
        What it must be.
    """

    def __init__(self, field: str, value: object, reason: str) -> None:
        super().__init__(f'report: {field} = {value!r}: {reason}')
        self.field = field
