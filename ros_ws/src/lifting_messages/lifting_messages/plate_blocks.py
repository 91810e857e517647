# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force plate samples in blocks: many samples in one message."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lifting_messages.exceptions import MessageError
from lifting_messages.message_types import Message, decode, encode, make

SAMPLE: Final = 'geometry_msgs/msg/WrenchStamped'
BLOCK: Final = 'lifting_interfaces/msg/WrenchBlock'
#: Longest time [ns] that a sample waits for its block to be complete.
LONGEST: Final = 20_000_000
_SECOND: Final = 1_000_000_000


def block_topic(topic: str) -> str:
    """Return the topic of the blocks that stands beside a topic of single samples."""
    return f'{topic}_block'


def is_plate(topic: str, message_type: str) -> bool:
    """Return whether a topic holds single samples of a force plate."""
    parts = topic.strip('/').split('/')
    return message_type == SAMPLE and parts[-3::2] == ['force_plates', 'wrench']


def wrench_block(samples: Sequence[Message]) -> Message:
    """Return the block of `WrenchStamped` messages of one plate, at least one."""
    stamps = [_nanoseconds(sample) for sample in samples]
    wrenches = [sample.wrench for sample in samples]
    return make(
        BLOCK,
        header=samples[0].header,
        offset=np.array(stamps, np.int64) - stamps[0],
        force=np.array([(w.force.x, w.force.y, w.force.z) for w in wrenches]).ravel(),
        moment=np.array([(w.torque.x, w.torque.y, w.torque.z) for w in wrenches]).ravel(),
    )


def block_samples(block: Message) -> tuple[list[float], NDArray[np.float64]]:
    """Return stamps [s], k, and force [N] and moment [N m] of a block, shape (k, 6).

    The stamps have the bits of those of single samples.

    Raises
    ------
    MessageError
        If the arrays do not have the same number of samples.
    """
    k = block.offset.size
    if not k or (block.force.size, block.moment.size) != (3 * k, 3 * k):
        problem = f'{k} offsets, {block.force.size} forces, {block.moment.size} moments'
        raise MessageError(BLOCK, 8 * (k + block.force.size + block.moment.size), problem)
    seconds, nanoseconds = np.divmod(block.offset + _nanoseconds(block), _SECOND)
    rows = np.concatenate([block.force.reshape(k, 3), block.moment.reshape(k, 3)], axis=1)
    return (seconds + nanoseconds / 1e9).tolist(), rows


def in_blocks(
    messages: Iterable[tuple[str, int, bytes]], plates: Collection[str], frames: Collection[str]
) -> Iterator[tuple[str, int, bytes]]:
    """Replace single samples of plates by blocks.

    A block ends with the first sample at or after the stamp of a camera frame, so that no frame
    waits longer for its plate samples than it would for single ones.

    Parameters
    ----------
    messages : iterable of (topic, stamp [ns], serialised message)
        By stamp.
    plates : collection of str
        Topics of single samples.
    frames : collection of str
        Topics of camera frames.

    Yields
    ------
    (topic, stamp [ns], serialised message)
        A block has its plate's topic and the stamp of its last sample.
    """
    waiting: dict[str, list[tuple[int, bytes]]] = {name: [] for name in plates}
    ends: dict[str, int] = {}
    for name, stamp, data in messages:
        if name in waiting:
            samples = waiting[name]
            samples.append((stamp, data))
            if stamp < ends.get(name, samples[0][0] + LONGEST):
                continue
            yield _block(name, samples)
            ends.pop(name, None)
            continue
        if name in frames:
            for plate, samples in waiting.items():
                if samples and samples[-1][0] >= stamp:
                    yield _block(plate, samples)
                else:
                    ends[plate] = stamp
        yield name, stamp, data
    yield from (_block(name, samples) for name, samples in waiting.items() if samples)


def _block(name: str, samples: list[tuple[int, bytes]]) -> tuple[str, int, bytes]:
    """Return the block of the samples, which are taken out of the list."""
    last = samples[-1][0]
    data = encode(wrench_block([decode(sample, SAMPLE) for _, sample in samples]))
    samples.clear()
    return name, last, data


def _nanoseconds(message: Any) -> int:
    stamp = message.header.stamp
    return int(stamp.sec) * _SECOND + int(stamp.nanosec)
