# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the lift predictor."""


class LiftPredictorError(Exception):
    """Base of all errors that bad input to the predictor raises."""


class SplineError(LiftPredictorError):
    """A B-spline was asked for with impossible sizes, or evaluated outside [0, 1]."""


class TaskError(LiftPredictorError):
    """A lift, box or subject does not describe a two-dimensional lifting task; names the field and value."""
