# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the lift predictor."""

from human_model.exceptions import LiftingError


class LiftPredictorError(LiftingError):
    """Base of all errors that bad input to the predictor raises."""


class SplineError(LiftPredictorError):
    """A B-spline was asked for with impossible sizes, or evaluated outside [0, 1]."""


class TaskError(LiftPredictorError):
    """The input does not describe a sagittal lifting task; names field and value."""


class AsymmetricLiftError(TaskError):
    """The recorded lift turns or leans to a side, which the sagittal model cannot follow."""


class UnreachableError(LiftPredictorError):
    """The hands cannot be brought where the task wants them."""


class PlanError(TaskError):
    """A task to plan is described wrongly; names (file,) field and value."""


class CancelledError(LiftPredictorError):
    """Somebody asked for the work to end before it was done."""


class PercentileError(LiftPredictorError):
    """No plausible strength explains a maximum lift, or a prediction on the way failed."""


class StudyError(LiftPredictorError):
    """A study's folder or scheduler cannot be used; names it."""
