# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The peaks printed in docs/validation.md are those that the recordings give."""

import importlib.util
import re
import sys
from pathlib import Path

import pytest

from human_model.tables import read_file
from lifting_report.results_file import read_results

DOCS = Path(__file__).resolve().parents[1] / 'docs'
NUMBER = re.compile(r'(?<![\w.])−?\d+(?:\.\d+)?')
#: Peaks are printed in whole newtons; another machine rounds the solver's last digits otherwise.
RELATIVE, ABSOLUTE = 0.005, 1.0


@pytest.fixture(scope='module')
def module():
    """Return docs/peaks_table.py."""
    spec = importlib.util.spec_from_file_location('peaks_table', DOCS / 'peaks_table.py')
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = loaded
    spec.loader.exec_module(loaded)
    return loaded


@pytest.fixture(scope='module')
def ours(module, offline, bags):
    """Return our peaks of all tasks."""
    return module.our_peaks({name: read_results(offline(bags / name)) for name in module.TASKS})


def numbers(text):
    """Return all numbers of a text."""
    return [float(found.replace('−', '-')) for found in NUMBER.findall(text)]


@pytest.mark.parametrize('name', ['peaks', 'reasons'])
def test_printed_tables_are_those_of_the_recordings(module, ours, name):
    page = module.PAGE.read_text(encoding='utf-8')
    begin, end = module.BEGIN.format(name), module.END.format(name)
    stored = page.partition(begin)[2].partition(end)[0]
    made = module.parts(ours)[name]
    assert numbers(stored) == pytest.approx(numbers(made), rel=RELATIVE, abs=ABSOLUTE), (
        'run python -m docs.peaks_table')  # fmt: skip
    words = [NUMBER.sub('', text).split() for text in (stored, made)]
    assert words[0] == words[1]


def test_every_published_number_has_its_source(module):
    rows = read_file(module.STUDIES, module.COLUMNS, sourced=True)
    assert len({row['study'] for row in rows} - {'dissertation'}) == 6
    assert all(row['source'].startswith('Zaman (2022), ') for row in rows)


def test_a_page_without_the_marks_is_refused(module):
    with pytest.raises(ValueError, match='marks'):
        module.with_parts('no marks here', {'peaks': 'text'})
