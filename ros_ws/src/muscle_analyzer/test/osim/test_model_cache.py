# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The cache of models: what comes out is what was read, whatever happens to the entries."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import ModelCacheError, OsimFormatError
from muscle_analyzer.core.osim import model_cache
from muscle_analyzer.core.osim.model_cache import load_model
from muscle_analyzer.core.osim.model_codec import decode, encode
from muscle_analyzer.core.osim.reader import read_osim

BUSHING = '<BushingForce name="disc"><appliesForce>true</appliesForce></BushingForce>'
PACKAGE = Path(model_cache.__file__).parents[2]


def assert_same(one, other):
    (structure, numbers), (expected, values) = encode(one), encode(other)
    assert structure == expected
    np.testing.assert_array_equal(numbers, values)


@pytest.fixture
def unread(monkeypatch):
    """Return a function that makes every further parsing of a file an error."""

    def forbid():
        monkeypatch.setattr(model_cache, 'model_from', None)

    return forbid


def test_second_time_the_model_comes_from_the_cache(write_model, tmp_path, unread):
    path = write_model()
    first = load_model(path, directory=tmp_path / 'cache')
    unread()
    second = load_model(path, directory=tmp_path / 'cache')
    assert_same(second, first)
    assert_same(second, read_osim(path))
    assert [file.suffix for file in (tmp_path / 'cache').iterdir()] == ['.npz']


def test_lifting_model_is_the_same_from_the_cache(lifting_model, tmp_path):
    load_model(lifting_model.source, directory=tmp_path)
    cached = load_model(lifting_model.source, directory=tmp_path)
    assert_same(cached, lifting_model)
    assert cached.muscles[0].points[0].location.flags.c_contiguous


def test_content_counts_and_not_the_name(write_model, tmp_path, unread):
    path = write_model()
    load_model(path, directory=tmp_path / 'cache')
    moved = path.rename(tmp_path / 'renamed.osim')
    unread()
    assert load_model(moved, directory=tmp_path / 'cache').source == str(moved)


def test_changed_content_and_changed_options_are_read_anew(write_model, tmp_path):
    cache = tmp_path / 'cache'
    assert load_model(write_model(), directory=cache).mass == pytest.approx(3.5)
    heavier = write_model(('<mass>2.0</mass>', '<mass>4.0</mass>'))
    assert load_model(heavier, directory=cache).mass == pytest.approx(5.5)
    path = write_model(forces=BUSHING)
    assert 'BushingForce disc' in load_model(path, {'BushingForce'}, cache).left_out
    with pytest.raises(Exception, match='BushingForce'):
        load_model(path, directory=cache)


@pytest.mark.parametrize('damage', [b'', b'PK\x03\x04', b'no archive'])
def test_damaged_entry_is_made_anew(write_model, tmp_path, damage):
    path = write_model()
    expected = load_model(path, directory=tmp_path / 'cache')
    (entry,) = (tmp_path / 'cache').iterdir()
    whole = entry.read_bytes()
    entry.write_bytes(damage)
    assert_same(load_model(path, directory=tmp_path / 'cache'), expected)
    assert entry.read_bytes() == whole


def test_cut_or_foreign_structures_are_refused():
    for structure in ('', '[1, 2]', '{"Body": [1]}', '{"Nothing": []}', '{"@": [0, 4]}'):
        with pytest.raises(ModelCacheError):
            decode(structure, np.zeros(2))


def test_cache_that_cannot_be_written_costs_time_only(write_model, tmp_path):
    blocked = tmp_path / 'file'
    blocked.write_text('not a directory', encoding='utf-8')
    assert load_model(write_model(), directory=blocked / 'cache').mass == pytest.approx(3.5)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(OsimFormatError, match=r'nothing\.osim'):
        load_model(tmp_path / 'nothing.osim', directory=tmp_path)


def test_processes_that_build_one_entry_do_not_meet(write_model, tmp_path):
    path = write_model()
    code = (
        'import sys; from muscle_analyzer.core.osim.model_cache import load_model; '
        'print(load_model(sys.argv[1]).mass)'
    )
    environment = {**os.environ, 'LIFT_CACHE': str(tmp_path), 'PYTHONPATH': str(PACKAGE)}
    runs = [
        subprocess.Popen(
            [sys.executable, '-c', code, str(path)], env=environment, stdout=subprocess.PIPE
        )
        for _ in range(3)
    ]
    assert [float(run.communicate(timeout=120)[0]) for run in runs] == [3.5] * 3
    assert len(list((tmp_path / 'models').iterdir())) == 1
