# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the motion tracker."""

from human_model.exceptions import LiftingError


class MotionTrackerError(LiftingError, ValueError):
    """Base of every error this package raises on bad input."""


class FilterError(MotionTrackerError):
    """A filter cannot be built, or its input has the wrong shape."""


class ForcePlateError(MotionTrackerError):
    """Geometry or samples of a force plate are not usable."""


class LiftEventError(MotionTrackerError):
    """A parameter or sample of the lift detection is not usable."""


class MarkerSetError(MotionTrackerError):
    """A marker set file is missing, damaged or does not fit the recording."""


class CalibrationError(MotionTrackerError):
    """A static trial does not determine the marker model."""


class InverseKinematicsError(MotionTrackerError):
    """Markers, weights or start posture do not fit the model."""


class HandForceError(MotionTrackerError):
    """A parameter of the hand force estimator is not usable."""


class TrackerError(MotionTrackerError):
    """The tracker was configured or fed in a way it cannot work with."""
