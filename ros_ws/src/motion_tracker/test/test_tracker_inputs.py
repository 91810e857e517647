# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the input streams become samples of the tracker."""

import numpy as np
import pytest

from lifting_messages import decode, encode, make
from lifting_messages.names import join
from lifting_messages.stamps import header
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.inputs import markers_from_msg

NAMES = ('RASI', 'LASI', 'C7')


def frame(names=NAMES, positions=range(9)):
    return make('Markers', header=header(2.5), names=join(names), positions=np.array(positions))


def test_marker_frame():
    stamp, names, positions = markers_from_msg(decode(encode(frame()), 'Markers'))
    assert (stamp, names) == (2.5, NAMES)
    np.testing.assert_array_equal(positions, np.arange(9.0).reshape(3, 3))


def test_frame_without_markers():
    _, names, positions = markers_from_msg(frame((), ()))
    assert (names, positions.shape) == ((), (0, 3))


@pytest.mark.parametrize('count', [0, 8, 10])
def test_frame_whose_numbers_do_not_fit_its_names(count):
    with pytest.raises(TrackerError, match=f'{count} numbers for 3 names'):
        markers_from_msg(frame(positions=range(count)))
