# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reading: whole bags of both storages, bags cut off anywhere, and files that are no bags."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from lifting_messages import typestore
from lifting_recordings.bag_writer import START_TIME_NS, BagWriter, in_order, quality
from lifting_recordings.exceptions import UnreadableBagError
from lifting_recordings.importer import plate_stream
from lifting_recordings.reader import BagReader
from lifting_recordings.recording import Plate

N = 12000


def write(path: Path, *, compress: bool) -> None:
    rng = np.random.default_rng(1)
    time = np.arange(N) / 1000.0
    with BagWriter(path, compress=compress) as writer:
        streams = [
            plate_stream(
                writer,
                START_TIME_NS,
                side,
                Plate(side, time, rng.normal(size=(N, 3)), rng.normal(size=(N, 3))),
            )
            for side in ('right', 'left')
        ]
        for stamp, topic, message in in_order(*streams):
            writer.write(topic, stamp, message)


@pytest.fixture(scope='module', params=[True, False], ids=['zstd', 'plain'])
def whole(request, tmp_path_factory):
    path = tmp_path_factory.mktemp('whole') / 'bag'
    write(path, compress=request.param)
    return path


def cut(whole: Path, tmp_path: Path, size: int) -> Path:
    path = tmp_path / 'bag'
    shutil.copytree(whole, path)
    data = (whole / 'bag.mcap').read_bytes()
    (path / 'bag.mcap').write_bytes(data[:size])
    return path


def test_whole_bag(whole):
    with BagReader(whole) as bag:
        assert bag.loss is None
        stamps = [stamp for _, stamp, _ in bag.messages()]
        assert bag.start_ns == START_TIME_NS
        assert bag.end_ns == START_TIME_NS + (N - 1) * 1_000_000
    assert len(stamps) == 2 * N
    assert stamps == sorted(stamps)


@pytest.mark.parametrize('share', [0.99, 0.7, 0.4])
def test_cut_off_bag_gives_a_true_prefix_and_counts_what_is_lost(whole, tmp_path, share):
    size = int((whole / 'bag.mcap').stat().st_size * share)
    with BagReader(whole) as bag:
        complete = list(bag.raw_messages())
    with BagReader(cut(whole, tmp_path, size)) as bag:
        part = list(bag.raw_messages())
        loss = bag.loss
    assert part == complete[: len(part)]
    # No more than one chunk of 1 MiB (over 100 bytes a message) may be lost to the cut.
    assert len(part) > share * len(complete) - 2**20 / 100
    assert loss is not None
    assert loss.messages_lost == len(complete) - len(part)
    lost_seconds = (complete[-1][1] - part[-1][1]) * 1e-9
    assert loss.seconds_lost == pytest.approx(lost_seconds, abs=1e-9)
    assert 'lost' in str(loss)


def test_cut_off_file_without_metadata_says_that_the_loss_is_a_lower_bound(whole, tmp_path):
    size = int((whole / 'bag.mcap').stat().st_size * 0.5)
    path = cut(whole, tmp_path, size)
    with BagReader(path / 'bag.mcap') as bag:
        assert bag.loss is not None
        assert bag.loss.messages_lost is None
        assert 'at least' in str(bag.loss)
        assert sum(topic.count for topic in bag.topics.values()) == len(list(bag.raw_messages()))


def test_only_the_index_missing_loses_no_message(whole, tmp_path):
    size = (whole / 'bag.mcap').stat().st_size - 20
    with BagReader(cut(whole, tmp_path, size)) as bag:
        assert bag.loss is not None
        assert bag.loss.messages_lost == 0
        assert len(list(bag.messages())) == 2 * N


def test_damaged_chunk_ends_the_reading_there(tmp_path):
    write(tmp_path / 'bag', compress=True)
    file = tmp_path / 'bag' / 'bag.mcap'
    data = file.read_bytes()
    frame = b'\x28\xb5\x2f\xfd'
    second = data.index(frame, data.index(frame) + 1)
    file.write_bytes(data[:second] + b'\0\0\0\0' + data[second + 4 : -20])
    with BagReader(tmp_path / 'bag') as bag:
        assert bag.loss is not None
        assert bag.loss.bytes_lost > 2**20
        assert 0 < len(list(bag.messages())) < 2 * N


@pytest.mark.parametrize(
    ('content', 'message'),
    [(b'', r'is empty \(0 bytes\)'), (b'#!/bin/sh\n' * 9, 'is not an MCAP file')],
)
def test_empty_and_foreign_files(tmp_path, content, message):
    path = tmp_path / 'a.mcap'
    path.write_bytes(content)
    with pytest.raises(UnreadableBagError, match=message), BagReader(path):
        pass


def test_things_that_are_no_bag(tmp_path):
    (tmp_path / 'a.txt').write_text('x')
    (tmp_path / 'b.db3').write_text('this is no database, but long enough to be looked at')
    for path, message in (
        (tmp_path / 'no', 'does not exist'),
        (tmp_path / 'a.txt', 'neither a bag folder'),
        (tmp_path / 'b.db3', 'cannot be read'),
    ):
        with pytest.raises(UnreadableBagError, match=message), BagReader(path):
            pass
    (tmp_path / 'empty').mkdir()
    with pytest.raises(UnreadableBagError, match='is no bag'), BagReader(tmp_path / 'empty'):
        pass


def test_damaged_metadata_is_named(whole, tmp_path):
    path = tmp_path / 'bag'
    shutil.copytree(whole, path)
    (path / 'metadata.yaml').write_text('rosbag2_bagfile_information: {version: 9}\n')
    with pytest.raises(UnreadableBagError, match=r'metadata\.yaml: damaged'), BagReader(path):
        pass


def test_bag_without_messages(tmp_path):
    with BagWriter(tmp_path / 'bag') as writer:
        writer.topic('markers', 'lifting_interfaces/msg/Markers')
    with pytest.raises(UnreadableBagError, match='holds no messages'), BagReader(tmp_path / 'bag'):
        pass


def test_sqlite_bag(tmp_path):
    store = typestore()
    path = tmp_path / 'bag'
    with Writer(path, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection(
            '/number',
            'std_msgs/msg/Float64',
            typestore=store,
            offered_qos_profiles=[quality(transient_local=False)],
        )
        for i in range(5):
            message = store.types['std_msgs/msg/Float64'](data=float(i))
            data = store.serialize_cdr(message, 'std_msgs/msg/Float64')
            writer.write(connection, 10 + i, data)
    with BagReader(path) as bag:
        assert [m.data for _, _, m in bag.messages(['/number'])] == [0.0, 1.0, 2.0, 3.0, 4.0]
        assert [s for _, s, _ in bag.messages(start_ns=13)] == [13, 14]


def test_bag_stands_alone(whole):
    """The types come out of the file: the definition of ours is complete there."""
    with BagReader(whole) as bag:
        store = bag.types
        assert 'geometry_msgs/msg/WrenchStamped' in store.fielddefs
        assert 'lifting_interfaces/msg/Task' not in store.fielddefs
