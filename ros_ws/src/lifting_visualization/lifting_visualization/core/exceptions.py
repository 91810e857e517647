# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the package."""

from __future__ import annotations

from human_model.exceptions import LiftingError


class LiftingVisualizationError(LiftingError, ValueError):
    """Base of what can be wrong with the input of the package."""


class PictureError(LiftingVisualizationError):
    """Data that cannot be drawn; the message names the data and the reason."""
