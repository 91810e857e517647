# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reference cycles are found at the turns of the search, early and late ones."""

import gc
import weakref

import pytest

from lifting_node.garbage import SHORT_SEARCHES, TimedSearch


class Ring:
    """An object that only the search can free."""

    def __init__(self):
        self.itself = self


@pytest.fixture
def search():
    search = TimedSearch()
    search.begin()
    yield search
    search.end()
    gc.unfreeze()


def test_nothing_is_searched_between_the_turns(search):
    ring = weakref.ref(Ring())
    kept = [[] for _ in range(100_000)]
    assert ring() is not None
    search.step()
    assert ring() is None
    assert len(kept) == 100_000


def test_a_cycle_that_outlived_short_searches_is_found_by_a_long_one(search):
    held = Ring()
    ring = weakref.ref(held)
    search.step()
    del held
    for _ in range(SHORT_SEARCHES - 2):
        search.step()
    assert ring() is not None
    search.step()
    assert ring() is None


def test_python_searches_again_after_the_end(search):
    assert not gc.isenabled()
    search.end()
    assert gc.isenabled()
