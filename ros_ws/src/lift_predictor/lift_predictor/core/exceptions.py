# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the lift predictor."""

from human_model.exceptions import LiftingError


class LiftPredictorError(LiftingError):
    """Base of all errors that bad input to the predictor raises."""


class SplineError(LiftPredictorError):
    """A B-spline was asked for with impossible sizes, or evaluated outside [0, 1]."""


class TaskError(LiftPredictorError):
    """The input does not describe a lifting task; names field and value."""


class UnreachableError(LiftPredictorError):
    """The hands cannot reach the places of the task."""


class PlanError(TaskError):
    """A task to plan is described wrongly; names (file,) field and value."""


class CancelledError(LiftPredictorError):
    """The work was cancelled before its end."""


class PercentileError(LiftPredictorError):
    """No plausible strength explains a maximum lift, or a prediction on the way failed."""


class StudyError(LiftPredictorError):
    """A study's folder or scheduler cannot be used; names it."""
