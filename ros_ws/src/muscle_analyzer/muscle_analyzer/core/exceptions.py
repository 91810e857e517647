# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the muscle analyzer; every message names the file, element or field and the value."""

from human_model.exceptions import LiftingError


class MuscleAnalyzerError(LiftingError):
    """Base of every error that this package raises on purpose."""


class OsimFormatError(MuscleAnalyzerError):
    """A model file is not well-formed, or an element holds a value that cannot be used."""


class UnsupportedElementError(MuscleAnalyzerError):
    """A model file has an element that would change the result and that is not modelled here."""


class ModelCompilationError(MuscleAnalyzerError):
    """A model that was read cannot be turned into a tree of bodies and joints."""


class ModelCacheError(MuscleAnalyzerError):
    """An entry of the model cache is damaged; `load_model` reads the model's file instead."""


class UnknownNameError(MuscleAnalyzerError):
    """A body, joint, coordinate, point or option of this name does not exist."""


class ScalingError(MuscleAnalyzerError):
    """A model cannot be scaled to the given lengths or mass."""


class TransferError(MuscleAnalyzerError):
    """A motion cannot be transferred to the musculoskeletal model."""


class InputArrayError(MuscleAnalyzerError):
    """An array has the wrong shape, or holds values that are not finite."""


class OptionError(MuscleAnalyzerError):
    """An option has a value that cannot be used."""


class ModelFileError(MuscleAnalyzerError):
    """The musculoskeletal model's file is not installed."""


class ModelWriteError(MuscleAnalyzerError):
    """A model holds something that cannot be written as an `.osim` file."""


class OpenSimError(MuscleAnalyzerError):
    """OpenSim is not there, or it could not run on the exported files."""


class EmgError(MuscleAnalyzerError):
    """EMG cannot be processed, or a channel belongs to no muscle; names channel and value."""
