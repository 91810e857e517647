# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns in one text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifting_messages.exceptions import NameListError
from lifting_messages.names import join, split

NAME = st.text(min_size=1, max_size=9).filter(lambda name: '\n' not in name)


@given(st.lists(NAME, max_size=6))
def test_names_come_back(names):
    assert split(join(names)) == tuple(names)


@pytest.mark.parametrize('name', ['', 'RASI\nLASI', '\n'])
def test_names_that_would_come_back_as_others_are_refused(name):
    with pytest.raises(NameListError) as caught:
        join(['C7', name])
    assert caught.value.name == name
