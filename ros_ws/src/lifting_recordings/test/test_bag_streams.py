# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Input topics as arrays: order, gaps, and messages that are left out with a reason."""

import numpy as np
import pytest

from lifting_recordings.bag_writer import START_TIME_NS, BagWriter
from lifting_recordings.exceptions import UnreadableBagError
from lifting_recordings.streams import load_streams

MS = 1_000_000


def write(path, marker_stamps, wrench_stamps, *, prefix='', bad=None):
    """Write two markers per frame (the second unseen in frame 1) and one plate."""
    with BagWriter(path) as writer:
        writer.topic(f'{prefix}markers', 'lifting_interfaces/msg/Markers')
        topic = f'{prefix}force_plates/left/wrench'
        writer.topic(topic, 'geometry_msgs/msg/WrenchStamped')
        for i, stamp in enumerate(marker_stamps):
            places = np.array([[i, 0.0, 1.0], [i, 1.0, np.nan if i == 1 else 2.0]])
            message = writer.markers(START_TIME_NS + stamp * MS, i, ('a', 'b'), places)
            writer.write(f'{prefix}markers', START_TIME_NS + i * 10 * MS, message)
        for i, stamp in enumerate(wrench_stamps):
            force = np.array([0.0, 0.0, np.nan if i == bad else 100.0 + i])
            message = writer.wrench(START_TIME_NS + stamp * MS, force, 2.0 * force)
            writer.write(topic, START_TIME_NS + i * MS, message)


def test_arrays(tmp_path):
    write(tmp_path / 'bag', [0, 10, 20], [0, 1, 2, 3])
    found = load_streams(tmp_path / 'bag')
    assert found.marker_names == ('a', 'b')
    np.testing.assert_allclose(found.marker_time, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(found.markers[:, 0, 0], [0.0, 1.0, 2.0])
    assert np.all(np.isnan(found.markers[1, 1]))
    np.testing.assert_allclose(found.plates['left'].force[:, 2], [100.0, 101.0, 102.0, 103.0])
    np.testing.assert_allclose(found.plates['left'].moment[3], [0.0, 0.0, 206.0])
    assert 'right' not in found.plates
    assert found.box_time.size == 0
    assert found.subject is None
    assert found.problems == ()
    assert found.loss is None


def test_stamps_that_do_not_increase_are_left_out_and_said(tmp_path):
    write(tmp_path / 'bag', [0, 20, 10, 30], [0, 1, 1, 2])
    found = load_streams(tmp_path / 'bag')
    np.testing.assert_allclose(found.marker_time, [0.0, 0.02, 0.03])
    np.testing.assert_array_equal(found.marker_frame, [0, 1, 3])
    np.testing.assert_allclose(found.plates['left'].force[:, 2], [100.0, 101.0, 103.0])
    said = ' '.join(found.problems)
    assert 'markers: 1 messages left out: unsorted stamp, first at 0.010 s' in said
    assert 'force_plates/left/wrench: 1 messages left out: duplicated stamp' in said


def test_forces_that_are_not_finite_are_left_out_and_said(tmp_path):
    write(tmp_path / 'bag', [0], [0, 1, 2], bad=1)
    found = load_streams(tmp_path / 'bag')
    assert found.plates['left'].time.size == 2
    assert 'not finite, first at 0.001 s' in found.problems[0]


def test_namespace(tmp_path):
    write(tmp_path / 'bag', [0, 10], [0], prefix='station_1/')
    found = load_streams(tmp_path / 'bag', 'station_1')
    assert found.marker_time.size == 2
    with pytest.raises(UnreadableBagError, match='topic markers holds no usable message'):
        load_streams(tmp_path / 'bag')
