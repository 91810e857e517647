# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Finding a Python with OpenSim and running the script, and the errors of both."""

import sys
from pathlib import Path

import numpy as np
import pytest

from human_model.opensim_storage import Storage, read_storage, write_storage
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.opensim_bridge import process, script, setup_files
from muscle_analyzer.core.opensim_bridge.process import (
    VARIABLE,
    OpenSimPython,
    find_opensim,
    run_opensim,
)


@pytest.fixture
def program(tmp_path):
    """Return a function that makes a stand-in for a Python out of a shell script."""

    def made(*lines):
        path = tmp_path / 'python'
        path.write_text('\n'.join(['#!/bin/sh', *lines]) + '\n', encoding='utf-8')
        path.chmod(0o755)
        return path

    return made


def test_without_opensim_the_message_says_how_to_get_it(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, 'prefix', str(tmp_path / '.venv'))
    with pytest.raises(OpenSimError, match=r'OpenSim is not installed\. `make opensim`') as caught:
        find_opensim(environment={})
    assert VARIABLE in str(caught.value)
    assert '--opensim-python' in str(caught.value)


def test_a_python_that_is_not_there_is_named(tmp_path):
    missing = tmp_path / 'python3.99'
    with pytest.raises(OpenSimError, match=r'python3\.99: no such Python'):
        find_opensim(missing)
    with pytest.raises(OpenSimError, match=r'python3\.99: no such Python'):
        find_opensim(environment={VARIABLE: str(missing)})


def test_a_python_without_opensim_is_refused():
    """The one that runs the tests: OpenSim and CasADi cannot be in one process."""
    with pytest.raises(OpenSimError, match=r"does not have OpenSim: .*No module named 'opensim'"):
        find_opensim(Path(sys.executable))


def test_the_one_given_comes_first_then_the_variable_then_the_environment(
    monkeypatch, tmp_path, program
):
    given = program('echo 4.6-given')
    found = find_opensim(given, {VARIABLE: str(tmp_path / 'other')})
    assert found == OpenSimPython(given, '4.6-given')
    assert find_opensim(environment={VARIABLE: str(given)}).path == given
    place = tmp_path / process.ENVIRONMENT / 'bin'
    place.mkdir(parents=True)
    given.rename(place / 'python')
    monkeypatch.setattr(sys, 'prefix', str(tmp_path / '.venv'))
    assert find_opensim(environment={}).path == place / 'python'


def test_libraries_of_this_process_do_not_reach_opensim(monkeypatch, program):
    monkeypatch.setenv('LD_LIBRARY_PATH', '/of/the/graph')
    monkeypatch.setenv('PYTHONPATH', '/of/the/graph')
    assert find_opensim(program('echo "4.6$LD_LIBRARY_PATH$PYTHONPATH"')).version == '4.6'


def test_instants_are_told_and_everything_is_logged(tmp_path, program):
    python = program('echo "arguments $*"', 'echo "0.100 s solved"', 'echo a warning >&2')
    told = []
    run_opensim(OpenSimPython(python, '4.6'), tmp_path, np.array([0.1]), told.append)
    assert told == ['0.100 s solved']
    log = (tmp_path / 'opensim.log').read_text(encoding='utf-8')
    assert 'a warning' in log
    assert log.splitlines()[0].endswith(f'script.py {tmp_path} --at 0.10000000000000001')


def test_a_failure_carries_the_end_of_the_log(tmp_path, program):
    python = program('echo the model has no such body', 'exit 3')
    with pytest.raises(OpenSimError, match=r'exit code 3; .*opensim\.log ends with\nthe model'):
        run_opensim(OpenSimPython(python, '4.6'), tmp_path, np.array([0.1]), print)


def test_a_run_that_hangs_is_ended(tmp_path, program, monkeypatch):
    monkeypatch.setattr(process, '_START_TIME', 0.2)
    monkeypatch.setattr(process, '_INSTANT_TIME', 0.0)
    python = program('exec sleep 60')
    with pytest.raises(OpenSimError, match=r'took more than 0 s; see .*opensim\.log'):
        run_opensim(OpenSimPython(python, '4.6'), tmp_path, np.array([0.1]), print)


def test_the_script_knows_the_files_by_the_names_that_the_exporter_gives():
    """It runs where this project is not installed, so it has its own copy of the names."""
    for name, other in (
        ('INVERSE_DYNAMICS', 'INVERSE_DYNAMICS'),
        ('STATIC_OPTIMIZATION', 'STATIC_OPTIMIZATION'),
        ('JOINT_REACTION', 'JOINT_REACTION'),
        ('MODEL', 'MODEL'),
        ('COORDINATES', 'COORDINATES'),
        ('RESULTS', 'RESULTS'),
        ('ANSWER', 'SCRIPT_RESULT'),
        ('FORCES', 'FORCES_RESULT'),
        ('ACTIVATIONS', 'ACTIVATIONS_RESULT'),
        ('REACTIONS', 'REACTIONS_RESULT'),
    ):
        assert getattr(script, name) == getattr(setup_files, other)


def test_rows_of_instants_become_one_table(tmp_path):
    """One row alone gets a second one: OpenSim interpolates between rows."""
    parts = []
    for k in range(2):
        path = tmp_path / f'{k}.sto'
        table = Storage('Forces', ('a', 'b'), np.array([0.1 * k]), np.array([[1.0 + k, 2.0]]))
        write_storage(path, table)
        parts.append(path)
    whole = tmp_path / 'whole.sto'
    script.joined(parts, whole)
    found = read_storage(whole)
    np.testing.assert_array_equal(found.values, [[1.0, 2.0], [2.0, 2.0]])
    np.testing.assert_allclose(found.time, [0.0, 0.1])
    script.joined(parts[1:], whole)
    found = read_storage(whole)
    np.testing.assert_array_equal(found.values, [[2.0, 2.0], [2.0, 2.0]])
    assert found.time[1] - found.time[0] == pytest.approx(1e-6, rel=1e-3)
