# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare-opensim`: what it writes, what it prints, and what it refuses."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.opensim_storage import read_storage
from lifting_cli import compare_opensim as module
from lifting_cli.cli import main
from lifting_cli.compare_opensim import CompareOptions, compare_opensim, table
from lifting_cli.graph_errors import SessionError
from lifting_cli.recorded_lifts import recorded_lifts
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.compare import Comparison, Difference, Instant
from muscle_analyzer.core.opensim_bridge.process import find_opensim

BAG = Path(__file__).resolve().parents[4] / 'bags' / 'symmetric_7kg'

RESULT = Comparison(
    (Difference('joint torque', 'N m', 12, 'hip, 0.1 s', 10.0, 10.5, 0.5, 0.1, 0.05, 4.2),),
    (Instant(0.1, (2000.0, 2010.0), (300.0, 301.0), (5.0, 5.5), (3.1, 3.2)),),
    '4.6-test',
    {'static_optimization': [3.0]},
)


@pytest.fixture(scope='module')
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp('exported')
    told = []
    answer = compare_opensim(CompareOptions(BAG, folder, export_only=True), told.append)
    assert answer is None
    return folder, told


def test_export_of_a_recording_needs_no_opensim(exported):
    folder, told = exported
    assert told == [f'lift_001: 8 files for OpenSim in {folder}']
    for name in (files.MODEL, files.LOADS, files.STATIC_OPTIMIZATION, files.RESERVES):
        assert (folder / name).is_file()


def test_the_exported_lift_is_that_of_the_recording(exported):
    """Time from the recording's start; what presses on feet and hands adds up to the weight."""
    folder, _ = exported
    recorded = recorded_lifts(BAG)
    lift = recorded.lift(1).lift
    loads = read_storage(folder / files.LOADS_DATA)
    assert loads.time[0] == pytest.approx(lift.start - recorded.start, abs=0.011)
    assert loads.time[-1] == pytest.approx(lift.end - recorded.start, abs=0.011)
    up = sum(loads.column(f'{name}_vy') for name in (
        'ground_force_right', 'ground_force_left', 'hand_force_right', 'hand_force_left'
    ))  # fmt: skip
    weight = 9.80665 * recorded.subject.mass
    assert up.mean() == pytest.approx(weight, rel=0.05)
    assert loads.column('hand_force_right_vy').min() < -20.0


def test_a_lift_that_is_not_there_is_refused(tmp_path, capsys):
    arguments = ['compare-opensim', str(BAG), '--lift', '2', '--export-only']
    assert main([*arguments, '--out', str(tmp_path)]) == 1
    assert 'lift 2 is not there: the recording has 1' in capsys.readouterr().err


def test_another_criterion_is_said_and_never_passed_over(tmp_path, monkeypatch):
    def stop(bag):
        raise SessionError('far enough')

    monkeypatch.setattr(module, 'recorded_lifts', stop)
    told = []
    options = CompareOptions(BAG, tmp_path, export_only=True, criterion='min_max')
    with pytest.raises(SessionError, match='far enough'):
        compare_opensim(options, told.append)
    assert told[0].startswith('criterion min_max here, sum of squares in OpenSim')
    assert 'Not compared' not in table(RESULT)
    other = replace(RESULT, criterion='min_max', not_compared=('activation', 'muscle force'))
    assert 'Not compared, because the criterion here is min_max' in table(other)
    assert 'activation, muscle force' in table(other)


def test_without_opensim_it_says_so_before_any_work(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(module, 'recorded_lifts', lambda bag: pytest.fail('worked first'))
    missing = str(tmp_path / 'python')
    arguments = ['compare-opensim', str(BAG), '--opensim-python', missing]
    assert main([*arguments, '--out', str(tmp_path)]) == 1
    error = capsys.readouterr().err
    assert 'no such Python' in error
    assert 'make opensim' in error


@pytest.mark.parametrize(
    ('options', 'want'),
    [
        ({}, [1.5, 2.0, 2.5, 3.0, 3.5]),
        ({'at': (1.2, 3.0)}, [1.2, 3.0]),
        ({'every': 1.0}, [2.0, 3.0]),
    ],
)
def test_instants(options, want):
    chosen = module._instants(CompareOptions(BAG, BAG, **options), np.linspace(1.0, 4.0, 301))
    assert chosen == pytest.approx(want)


@pytest.mark.parametrize(
    ('options', 'message'),
    [
        ({'at': (1.0,), 'every': 1.0}, '--at and --every'),
        ({'every': 0.0}, r'--every 0\.0: a positive number'),
        ({'every': float('nan')}, '--every nan'),
    ],
)
def test_instants_that_make_no_sense_are_refused(options, message):
    with pytest.raises(SessionError, match=message):
        module._instants(CompareOptions(BAG, BAG, **options), np.linspace(1.0, 4.0, 301))


def test_an_instant_outside_the_lift_is_refused(tmp_path):
    with pytest.raises(SessionError, match=r'instant 0\.1 s is outside the lift'):
        compare_opensim(CompareOptions(BAG, tmp_path, at=(0.1,), export_only=True), print)


def test_table_has_both_sides():
    text = table(RESULT)
    assert 'Largest differences, OpenSim 4.6-test' in text
    line = next(line for line in text.splitlines() if line.startswith('joint torque'))
    assert line.split() == [
        'joint', 'torque', 'N', 'm', '12', '10', '10.5', '0.5', '4.2', '0.1', 'hip,', '0.1', 's',
    ]  # fmt: skip
    assert '2000.0   2010.0' in text


@pytest.mark.long
def test_a_recording_against_the_real_opensim(tmp_path, capsys):
    """One instant of the lift of 7 kg with the box in the hands."""
    try:
        find_opensim()
    except OpenSimError as error:
        pytest.skip(str(error))
    assert main(['compare-opensim', str(BAG), '--at', '4.7', '--out', str(tmp_path)]) == 0
    assert 'L5-S1 in the disc frame' in capsys.readouterr().out
    found = json.loads((tmp_path / module.REPORT).read_text(encoding='utf-8'))
    (instant,) = found['instants']
    ours, theirs = instant['compression']
    assert ours == pytest.approx(theirs, rel=0.02)
    ours, theirs = instant['cost_equal_torques']
    assert ours <= theirs
