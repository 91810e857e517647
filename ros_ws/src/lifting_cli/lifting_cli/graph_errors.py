# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the running graph."""

from human_model.exceptions import LiftingError


class GraphError(LiftingError, RuntimeError):
    """Base of what can go wrong while the graph runs."""


class NodeDiedError(GraphError):
    """A node process ended by itself; says which, its exit code and the end of its log."""


class TransitionError(GraphError):
    """A node refused a lifecycle transition or did not answer; its log says why."""


class SessionError(GraphError):
    """A run could not be completed; says what is missing."""
