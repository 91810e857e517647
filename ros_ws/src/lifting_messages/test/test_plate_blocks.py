# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plate samples in blocks are the same samples."""

import numpy as np
import pytest

from lifting_messages import MessageError, decode, encode, make
from lifting_messages.plate_blocks import (
    BLOCK,
    SAMPLE,
    block_samples,
    in_blocks,
    is_plate,
    wrench_block,
)

START = 1_763_000_000_999_000_000
PLATE, FRAMES = '/force_plates/right/wrench', '/markers'


def sample(stamp, value):
    """Return a sample whose numbers are all different."""
    message = make(SAMPLE)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
    for k, axis in enumerate('xyz'):
        setattr(message.wrench.force, axis, value + 0.1 * k)
        setattr(message.wrench.torque, axis, value - 0.1 * k)
    return message


def test_stamps_and_numbers_have_the_bits_of_single_samples():
    """A block that crosses a full second."""
    stamps = [START + 400_123 * k for k in range(9)]
    block = wrench_block([sample(stamp, k / 3) for k, stamp in enumerate(stamps)])
    times, rows = block_samples(decode(encode(block), BLOCK))
    assert times == [stamp // 10**9 + stamp % 10**9 / 1e9 for stamp in stamps]
    assert rows.tolist() == [
        [k / 3 + 0.1 * i for i in range(3)] + [k / 3 - 0.1 * i for i in range(3)] for k in range(9)
    ]


def test_a_block_of_wrong_size_is_refused_with_its_sizes():
    block = wrench_block([sample(START, 1.0)])
    block.force = block.force[:2]
    with pytest.raises(MessageError, match='1 offsets, 2 forces, 3 moments'):
        block_samples(block)


@pytest.mark.parametrize('shift', [0, 1, 300_000])
@pytest.mark.parametrize('frame_first', [False, True])
def test_a_block_ends_at_or_after_a_frame(shift, frame_first):
    """No sample is lost, none waits for the next frame, and the order of stamps is kept."""
    plate = [(START + 10**6 * k, PLATE, encode(sample(START + 10**6 * k, k))) for k in range(100)]
    frames = [(START + 10**7 * k + shift, FRAMES, b'frame') for k in range(10)]
    both = sorted(
        [*plate, *frames], key=lambda entry: (entry[0], (entry[1] == PLATE) == frame_first)
    )
    out = list(in_blocks(((topic, at, data) for at, topic, data in both), {PLATE}, {FRAMES}))
    assert [at for _, at, _ in out] == sorted(at for _, at, _ in out)
    blocks = [
        (at, block_samples(decode(data, BLOCK))) for topic, at, data in out if topic == PLATE
    ]
    assert [row[0] for _, (_, rows) in blocks for row in rows] == list(map(float, range(100)))
    ends = np.array([at for at, _ in blocks[:-1]])
    for at, _, _ in frames[:-1]:
        after = ends[ends >= at].min()
        assert after - at < 10**6
    assert len(blocks) <= len(frames) + 1


def test_without_frames_no_sample_waits_long():
    plate = [(PLATE, START + 10**6 * k, encode(sample(START + 10**6 * k, k))) for k in range(95)]
    out = list(in_blocks(plate, {PLATE}, ()))
    assert [len(block_samples(decode(data, BLOCK))[0]) for _, _, data in out] == [21] * 4 + [11]


def test_single_samples_of_plates_are_known_by_topic_and_type():
    assert is_plate('/station/force_plates/left/wrench', SAMPLE)
    assert not is_plate('/ground_reaction/wrench', SAMPLE)
    assert not is_plate('/force_plates/left/wrench', BLOCK)
