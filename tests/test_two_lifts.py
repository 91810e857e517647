# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare` on the symmetric and the asymmetric lift of 7 kg."""

import json

import numpy as np
import pytest

from lifting_cli.cli import main
from lifting_report.results_file import read_results

LIFTS = ('symmetric_7kg', 'asymmetric_7kg')


@pytest.fixture(scope='module')
def results(offline, bags):
    """Return the results files of both lifts."""
    return tuple(offline(bags / name) for name in LIFTS)


@pytest.fixture(scope='module')
def compared(results, tmp_path_factory):
    """Return the folder of the comparison: one lift by its file, one by the file's folder."""
    output = tmp_path_factory.mktemp('compared')
    assert main(['compare', str(results[0]), str(results[1].parent), '-o', str(output)]) == 0
    return output


@pytest.mark.parametrize('number', [0, 1])
@pytest.mark.parametrize('source', ['measured', 'predicted'])
def test_peaks_are_those_of_the_messages(compared, results, number, source):
    (entry,) = read_results(results[number]).lifts.values()
    message = entry.blocks['spine_load', source]
    good = np.asarray(message.status) == 0
    told = json.loads((compared / 'comparison.json').read_text())[number]['peak_force'][source]
    for component in ('compression', 'anterior_shear', 'lateral_shear'):
        values = np.asarray(getattr(message, component))[good]
        peak = values[np.argmax(np.abs(values) if component == 'lateral_shear' else values)]
        assert told[component] == pytest.approx(peak)


def test_the_mirrored_lift_loads_the_same_and_the_turned_one_does_not(compared):
    symmetric, asymmetric = json.loads((compared / 'comparison.json').read_text())
    sides = {'symmetric': [], 'asymmetric': []}
    for lift, found in zip((symmetric, asymmetric), sides.values(), strict=True):
        peaks = lift['peak_activation']['predicted']
        found += [
            abs(peaks[name] - peaks[name.replace('left', 'right')])
            for name in peaks if name.endswith('left')
        ]  # fmt: skip
    assert max(sides['symmetric']) < 0.01
    assert max(sides['asymmetric']) > 0.1


def test_page_shows_both_lifts_and_says_that_they_are_simulated(compared):
    page = (compared / 'comparison.html').read_text(encoding='utf-8')
    assert page.count('<svg') == 4
    assert all(name in page for name in LIFTS)
    assert 'SIMULATED RECORDING' in page


def test_a_lift_that_is_not_there_is_named(results, tmp_path, capsys):
    arguments = [str(path) for path in results]
    assert main(['compare', *arguments, '--lifts', '1', '2', '-o', str(tmp_path)]) == 1
    assert 'lift 2 is not there: it has 1' in capsys.readouterr().err


def test_a_lift_is_not_compared_with_itself(results, tmp_path, capsys):
    path = str(results[0])
    assert main(['compare', path, path, '-o', str(tmp_path)]) == 1
    assert 'compared with itself' in capsys.readouterr().err
