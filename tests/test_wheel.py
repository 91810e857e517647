# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The wheel in an empty environment, without ROS and without the checkout."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SIX_LINES = """
import lifting
lift = lifting.track(lifting.load_recording('symmetric_12kg')).lifts[0]
best = lifting.predict(lift)
load = lifting.analyze(lift)
print(lifting.assess(load, lifting.analyze(best)).summary)
load.plot()
"""


def run(folder: Path, *command: str | Path, status: int = 0) -> str:
    """Run a command in a folder without what this checkout offers; return its output."""
    environment = {key: value for key, value in os.environ.items() if key != 'PYTHONPATH'}
    answer = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.returncode == status, answer.stdout + answer.stderr
    return answer.stdout + answer.stderr


@pytest.fixture(scope='module')
def place(tmp_path_factory):
    """Return an empty folder with one recording, one task and an environment in `venv`."""
    folder = tmp_path_factory.mktemp('empty')
    sources = tmp_path_factory.mktemp('sources') / 'lift_monitor'
    names = subprocess.run(
        ['git', 'ls-files', '-z', '--cached', '--others', '--exclude-standard'],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    for name in filter(None, names.stdout.split('\0')):
        if (ROOT / name).is_file() and not name.startswith(('bags/', 'docs/')):
            (sources / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, sources / name)
    run(folder, sys.executable, '-m', 'venv', 'venv')
    pip = (folder / 'venv' / 'bin' / 'python', '-m', 'pip')
    constraints = ROOT / 'requirements' / 'runtime.txt'
    run(folder, *pip, 'install', '--quiet', '--constraint', constraints, sources)
    shutil.rmtree(sources)
    shutil.copytree(ROOT / 'bags' / 'symmetric_12kg', folder / 'symmetric_12kg')
    shutil.copy(ROOT / 'examples' / 'shelf_12kg.yaml', folder)
    return folder


def lift(place: Path, *arguments: str, status: int = 0) -> str:
    """Run the installed `lift`."""
    return run(place, place / 'venv' / 'bin' / 'lift', *arguments, status=status)


def test_the_model_is_fetched_by_the_command_that_the_message_names(place, monkeypatch):
    monkeypatch.setenv('LIFT_CACHE', str(place / 'cache'))
    missing = lift(place, 'run', 'symmetric_12kg', '--offline', status=1)
    assert missing.strip().endswith('run: lift model')
    path = Path(lift(place, 'model').splitlines()[-1])
    assert path.parent.parent == place / 'cache' and path.stat().st_size > 1e6


def test_six_lines(place):
    lift(place, 'model')
    summary = run(place, place / 'venv' / 'bin' / 'python', '-c', SIX_LINES)
    assert 'Peak L5-S1 compression 4497 N' in summary and '309 N of it were avoidable' in summary


def test_commands(place):
    lift(place, 'model')
    assert 'measured: peak L5-S1 compression 4497 N' in lift(
        place, 'run', 'symmetric_12kg', '--offline', '--output', 'run'
    )
    assert (place / 'run' / 'report.html').stat().st_size > 1e5
    lift(place, 'report', 'run/results.mcap', '--output', 'again.html')
    lift(place, 'predict', 'shelf_12kg.yaml', '--output', 'plan')
    assert (place / 'plan' / 'report.html').exists()
    itself = lift(place, 'compare', 'run/results.mcap', 'run/results.mcap', status=1)
    assert 'compared with itself' in itself
    lift(place, 'urdf', 'shelf_12kg.yaml', '-o', 'person.urdf')
    assert '<robot' in (place / 'person.urdf').read_text()
    assert 'usage' in lift(place, 'import', '--help')
    assert 'needs ROS 2' in lift(place, 'run', 'symmetric_12kg', status=1)
