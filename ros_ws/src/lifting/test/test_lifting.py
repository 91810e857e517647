# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The front door: its six lines give the numbers of the graph."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lifting
from human_model.exceptions import LiftingError

BAGS = Path(__file__).resolve().parents[4] / 'bags'
SUBJECT = lifting.Subject('S1', 'male', 63.5, 1.69, 31.0)
TASK = lifting.PlanTask('shelf', 12.0, (0.24, 0.30, 0.13), (0.40, 0.0, 0.07), (0.55, 0.0, 0.97))


@pytest.fixture(scope='module')
def lift():
    return lifting.track(lifting.load_recording(BAGS / 'symmetric_12kg')).lifts[0]


@pytest.fixture(scope='module')
def load(lift):
    return lifting.analyze(lift)


def test_peaks_are_those_of_the_offline_run(lift, load, offline_peaks):
    best = lifting.analyze(lifting.predict(lift))
    peaks = [load.l5_s1.peak_compression, best.l5_s1.peak_compression]
    assert peaks[0] == offline_peaks['measured']
    # The recorded lift reaches the predictor of the graph with times in whole nanoseconds.
    assert peaks[1] == pytest.approx(offline_peaks['predicted'], rel=1e-6)
    assessment = lifting.assess(load, best)
    assert assessment.avoidable_compression == peaks[0] - peaks[1]
    assert f'{peaks[0]:.0f} N' in assessment.summary


@pytest.fixture(scope='module')
def offline_peaks(tmp_path_factory):
    """Return the peak compressions of `lift run --offline` by source [N]."""
    from lifting_cli.offline import run_offline
    from lifting_report.results_file import read_results

    results = read_results(run_offline(BAGS / 'symmetric_12kg', tmp_path_factory.mktemp('run')))
    blocks = next(iter(results.lifts.values())).blocks
    peaks = {}
    for source in ('measured', 'predicted'):
        message = blocks['spine_load', source]
        peaks[source] = float(message.compression[np.asarray(message.status) == 0].max())
    return peaks


def test_samples_without_solution_are_no_data(load):
    spine = load.l5_s1
    good = spine.status == 0
    assert spine.compression.shape == spine.time.shape == good.shape
    assert spine.peak_compression == spine.compression[good].max()
    assert load.muscles.force.shape == (good.size, len(load.muscles.names))


def test_plot_shows_loads_and_limits(load):
    (axes,) = load.plot().axes
    labels = {line.get_label() for line in axes.lines}
    assert {'compression', 'anterior shear', 'compression, limit 3400 N'} <= labels


def test_plan_without_recording():
    prediction = lifting.predict(TASK, SUBJECT)
    assert prediction.report.ok and prediction.plan is not None
    assert lifting.analyze(prediction).l5_s1.peak_compression > 2000.0


def test_prediction_without_solution_raises_with_its_report():
    impossible = lifting.PlanTask('heavy', 120.0, TASK.box_size, TASK.start, TASK.end)
    prediction = lifting.predict(impossible, SUBJECT)
    with pytest.raises(lifting.NoSolutionError) as caught:
        lifting.analyze(prediction)
    assert caught.value.report is prediction.report and not prediction.report.ok
    assert isinstance(caught.value, LiftingError)


def test_missing_parts_are_named(load):
    with pytest.raises(lifting.IncompleteLiftError, match='subject') as caught:
        lifting.predict(TASK)
    assert caught.value.lift_id == 'shelf'
    motion = lifting.analyze(load.lift.motion[:1], load.lift.subject)
    with pytest.raises(lifting.IncompleteLiftError, match='a lift'):
        lifting.assess(motion)


def test_recording_without_person_is_refused(tmp_path):
    from lifting_recordings.exceptions import BagError

    with pytest.raises(BagError):
        lifting.load_recording(tmp_path / 'nothing')


def test_equation_alone():
    task = lifting.LiftingTask(
        horizontal=25,
        vertical=75,
        distance=25,
        asymmetry=0,
        lifts_per_minute=0.2,
        duration_hours=1,
        coupling=lifting.Coupling.GOOD,
    )
    assert lifting.lifting_equation(task, load=23.0).lifting_index == pytest.approx(1.0)


def test_every_exported_name_exists():
    assert all(getattr(lifting, name) is not None for name in lifting.__all__)
    with pytest.raises(AttributeError, match='nothing'):
        getattr(lifting, 'nothing')  # noqa: B009


def test_import_loads_nothing_heavy():
    code = (
        'import sys, lifting; print([m for m in ("numpy", "numba", "rclpy") if m in sys.modules])'
    )
    answer = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True
    )
    assert answer.stdout.strip() == '[]'


def test_the_front_door_needs_no_ros(tmp_path):
    """With rclpy and the built messages forbidden, the first steps still work."""
    code = (
        'import sys\n'
        'for name in ("rclpy", "lifting_interfaces", "std_msgs", "geometry_msgs"):\n'
        '    sys.modules[name] = None\n'
        'import lifting\n'
        'lift = lifting.track(lifting.load_recording(sys.argv[1])).lifts[0]\n'
        'best = lifting.predict(lift)\n'
        'load = lifting.analyze(lift)\n'
        'print(lifting.assess(load, lifting.analyze(best)).summary)\n'
    )
    answer = subprocess.run(
        [sys.executable, '-c', code, str(BAGS / 'symmetric_12kg')],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
    )
    assert answer.returncode == 0, answer.stderr
    assert answer.stdout.startswith('Peak L5-S1 compression 4497 N')


def test_the_example_runs_and_draws(tmp_path):
    example = BAGS.parent / 'examples' / 'first_steps.py'
    answer = subprocess.run(
        [sys.executable, example, BAGS / 'symmetric_12kg', tmp_path],
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.returncode == 0, answer.stderr
    assert 'recorded: peak compression 4497 N' in answer.stdout
    assert 'largest mass for the same task' in answer.stdout
    assert {path.name for path in tmp_path.iterdir()} == {'recorded.png', 'optimal.png'}
