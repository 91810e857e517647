# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the nodes and options in Python have the same defaults."""

from inspect import signature

from injury_monitor.core.monitor import InjuryMonitor
from lift_predictor.core.options import PredictorOptions
from lifting_messages.parameters import defaults
from motion_tracker.core.configuration import settings_from
from motion_tracker.core.tracked import TrackerSettings
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.station import options_from


def test_defaults_of_the_tracker() -> None:
    assert settings_from(defaults('motion_tracker')) == TrackerSettings()


def test_defaults_of_the_predictor() -> None:
    assert PredictorOptions(**defaults('lift_predictor')) == PredictorOptions()


def test_defaults_of_the_analyzer() -> None:
    assert options_from(defaults('muscle_analyzer')) == MuscleAnalyzerOptions()


def test_defaults_of_the_monitor() -> None:
    parameters = signature(InjuryMonitor).parameters
    values = defaults('injury_monitor')
    for name in ('max_gap', 'activation_window', 'max_shelve'):
        assert values[name] == parameters[name].default, name


def test_a_changed_value_is_seen() -> None:
    values = {**defaults('motion_tracker'), 'motion_cutoff': 5.0}
    assert settings_from(values) != TrackerSettings()
    values = {**defaults('muscle_analyzer'), 'minimum_activation': 0.02}
    assert options_from(values) != MuscleAnalyzerOptions()
