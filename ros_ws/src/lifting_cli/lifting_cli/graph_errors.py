# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the running graph."""

from pathlib import Path

from human_model.exceptions import LiftingError


class GraphError(LiftingError, RuntimeError):
    """Base of what can go wrong while the graph runs."""


class NodeDiedError(GraphError):
    """A node process ended by itself.

    Parameters
    ----------
    name : str
        The node.
    exit_code : int
        Exit code of its process; negative: the number of the signal that ended it.
    log : Path
        File of its standard output and error.
    log_end : str
        Last lines of the log.
    """

    def __init__(self, name: str, exit_code: int, log: Path, log_end: str) -> None:
        super().__init__(f'{name} ended with exit code {exit_code}; {log} ends:\n{log_end}')
        self.name = name
        self.exit_code = exit_code
        self.log = log
        self.log_end = log_end


class TransitionError(GraphError):
    """A node refused a lifecycle transition or did not answer; its log says why."""


class SessionError(GraphError):
    """A run could not be completed; says what is missing."""
