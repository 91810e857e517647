# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift predict`: what it prints and writes, and how it refuses."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifting_cli.cli import main
from lifting_recordings.reader import BagReader

EXAMPLES = Path(__file__).resolve().parents[4] / 'examples'


def changed(tmp_path: Path, old: str, new: str) -> Path:
    text = (EXAMPLES / 'shelf_12kg.yaml').read_text(encoding='utf-8')
    assert old in text
    path = tmp_path / 'changed.yaml'
    path.write_text(text.replace(old, new), encoding='utf-8')
    return path


def test_example_is_planned_printed_and_written(tmp_path: Path, capsys) -> None:
    assert main(['predict', str(EXAMPLES / 'stoop_8kg.yaml'), '--output', str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    for words in (
        'stoop_8kg: OK',
        'box      8.00 kg',
        'hip_flexion',
        'limits touched',
        'ground reaction',
        'box path',
        'L5-S1 compression up to',
        '3400 N',
    ):
        assert words in printed
    plan = json.loads((tmp_path / 'plan.json').read_text(encoding='utf-8'))
    assert plan['report']['status'] == 0
    assert plan['summary']['technique_index'] >= 90.0
    assert plan['runs'][0]['converged']
    assert max(plan['verification'].values()) < 1.0
    with BagReader(tmp_path / 'results.mcap') as bag:
        found = {name.split('/', 2)[2]: message for name, _, message in bag.messages(bag.topics)}
    assert set(found) == {
        'subject', 'task', 'predicted_lift', 'predicted_lift/joint_trajectory',
        'muscle_analysis', 'spine_load', 'joint_torques',
    }  # fmt: skip
    load = found['spine_load']
    assert np.asarray(load.compression)[np.asarray(load.status) == 0].max() == pytest.approx(
        plan['l5_s1']['compression']
    )
    assert found['predicted_lift'].subject == found['subject'].pseudonym == 'woman_160'
    page = (tmp_path / 'report.html').read_text(encoding='utf-8')
    assert f'report   {tmp_path / "report.html"}' in printed
    for words in (
        'Planned lift: stoop_8kg',
        'feasible',
        'Peak L5-S1 compression',
        'Hip (flexion',
        'dynamic strength',
        'Ground reaction',
        'NOT A RECORDED LIFT',
        'woman_160',
    ):
        assert words in page
    assert page.count('<svg') == 7
    assert 'not feasible' not in page
    assert 'not available' not in page
    assert not re.search(r'(src|href)\s*=\s*["\']http', page), 'the page needs nothing else'


def test_place_out_of_reach_ends_with_the_reason_and_no_numbers(tmp_path: Path, capsys) -> None:
    path = changed(tmp_path, 'end: [0.55, 0.0, 0.9635]', 'end: [0.55, 0.0, 2.6]')
    assert main(['predict', str(path), '--output', str(tmp_path / 'out')]) == 1
    assert 'PREDICTOR_UNREACHABLE' in capsys.readouterr().out
    plan = json.loads((tmp_path / 'out' / 'plan.json').read_text(encoding='utf-8'))
    assert 'task.end' in plan['report']['message']
    assert plan['summary'] is None
    assert not (tmp_path / 'out' / 'results.mcap').exists()


def test_bad_field_is_named_with_its_file(tmp_path: Path, capsys) -> None:
    path = changed(tmp_path, 'stature: 1.69', 'stature: 169')
    assert main(['predict', str(path), '--output', str(tmp_path / 'out')]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f'lift predict: {path}: subject.stature: 169')
    assert not (tmp_path / 'out').exists()


def test_command_line_loads_no_heavy_library() -> None:
    code = (
        'import sys, lifting_cli.cli\n'
        'heavy = {"casadi", "distributed", "numba", "pyarrow", "rich", "scipy"}\n'
        'print(sorted(heavy & set(sys.modules)))'
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.strip() == '[]'


def test_page_of_what_cannot_be_done_draws_the_nearest_lift(tmp_path: Path) -> None:
    path = changed(tmp_path, 'box_mass: 12.0', 'box_mass: 45.0')
    assert main(['predict', str(path), '--output', str(tmp_path / 'out')]) == 1
    page = (tmp_path / 'out' / 'report.html').read_text(encoding='utf-8')
    assert 'not feasible' in page
    assert re.search(r'The nearest lift that can be done: [0-9.]+ kg instead of 45.00 kg', page)
    assert page.count('<svg') == 5
    assert 'muscles are analysed only where the task can be done' in page


def test_page_can_be_left_out(tmp_path: Path) -> None:
    path = changed(tmp_path, 'end: [0.55, 0.0, 0.9635]', 'end: [0.55, 0.0, 2.6]')
    assert main(['predict', str(path), '--output', str(tmp_path / 'out'), '--no-report']) == 1
    assert (tmp_path / 'out' / 'plan.json').exists()
    assert not (tmp_path / 'out' / 'report.html').exists()
