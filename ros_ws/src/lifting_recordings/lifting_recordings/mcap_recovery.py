# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Read an MCAP file that was cut off, as far as it goes.

Record layout: MCAP format specification, mcap.dev/spec, sections "Records" and "Chunk". An
intact file is read by `rosbags`; this scan is for files without footer.
"""

from __future__ import annotations

import struct
import sys
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import lz4.frame
from rosbags.interfaces import Qos
from rosbags.rosbag2.metadata import parse_qos

from lifting_recordings.exceptions import UnreadableBagError

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

MAGIC = b'\x89MCAP0\r\n'
_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F
_HEAD = struct.Struct('<BQ')
_MESSAGE_HEAD = struct.Struct('<HIQQ')
_CHUNK_HEAD = struct.Struct('<QQQI')


@dataclass(frozen=True)
class RecoveredChannel:
    """One topic: name, type, definition text, encoding of the definition, offered QoS."""

    topic: str
    msgtype: str
    definition: str
    encoding: str
    qos: tuple[Qos, ...]


@dataclass
class Recovered:
    """What could be read.

    Attributes
    ----------
    channels : dict
        Channel id to RecoveredChannel.
    messages : list of (int, int, bytes)
        Stamp [ns], channel id, serialised message; in file order.
    bytes_lost : int
        Bytes of records that are cut off or damaged (inside a torn chunk: uncompressed).
    last_announced_ns : int
        Latest stamp that a chunk header announced [ns].
    complete : bool
        The data section came to its regular end.
    """

    channels: dict[int, RecoveredChannel] = field(default_factory=dict)
    messages: list[tuple[int, int, bytes]] = field(default_factory=list)
    bytes_lost: int = 0
    last_announced_ns: int = 0
    complete: bool = False


def has_footer(path: Path) -> bool:
    """Tell whether the file ends with the magic of a finished MCAP file."""
    with path.open('rb') as file:
        file.seek(0, 2)
        if file.tell() < 2 * len(MAGIC):
            return False
        file.seek(-len(MAGIC), 2)
        return file.read() == MAGIC


def recover(path: Path) -> Recovered:
    """Scan the file from its start.

    Raises
    ------
    UnreadableBagError
        Empty file, not an MCAP file, or cut off before the first message.
    """
    data = path.read_bytes()
    if not data:
        raise UnreadableBagError(f'{path}: is empty (0 bytes)')
    if not data.startswith(MAGIC):
        raise UnreadableBagError(
            f'{path}: is not an MCAP file (starts with {data[: len(MAGIC)]!r})'
        )
    found = Recovered()
    schemas: dict[int, tuple[str, str, str]] = {}
    whole = len(MAGIC)
    for code, body, end in _records(data, len(MAGIC)):
        whole = end
        if code == _DATA_END:
            found.complete = True
            break
        if code == _CHUNK:
            if not _read_chunk(found, schemas, body):
                break
        else:
            _read_record(found, schemas, code, body)
    else:
        found.bytes_lost += _read_torn_chunk(found, schemas, data, whole)
    if not found.messages:
        raise UnreadableBagError(
            f'{path}: no message can be read ({len(data)} bytes, cut off before the first)'
        )
    return found


def _records(data: bytes, position: int) -> Iterator[tuple[int, bytes, int]]:
    """Yield (code, body, end) of every whole record."""
    while position + _HEAD.size <= len(data):
        code, size = _HEAD.unpack_from(data, position)
        end = position + _HEAD.size + size
        if end > len(data):
            return
        yield code, data[position + _HEAD.size : end], end
        position = end


def _string(body: bytes, position: int) -> tuple[bytes, int]:
    (size,) = struct.unpack_from('<I', body, position)
    end = position + 4 + size
    return body[position + 4 : end], end


def _read_record(
    found: Recovered, schemas: dict[int, tuple[str, str, str]], code: int, body: bytes
) -> None:
    if code == _MESSAGE:
        channel, _, stamp, _ = _MESSAGE_HEAD.unpack_from(body)
        if channel in found.channels:
            found.messages.append((stamp, channel, body[_MESSAGE_HEAD.size :]))
    elif code == _SCHEMA:
        (key,) = struct.unpack_from('<H', body)
        parts = []
        position = 2
        for _ in range(3):
            part, position = _string(body, position)
            parts.append(part.decode())
        schemas[key] = (parts[0], parts[1], parts[2])
    elif code == _CHANNEL:
        key, schema = struct.unpack_from('<HH', body)
        topic, position = _string(body, 4)
        _, position = _string(body, position)
        metadata, _ = _string(body, position)
        msgtype, encoding, text = schemas.get(schema, ('', '', ''))
        found.channels[key] = RecoveredChannel(
            topic.decode(), msgtype, text, encoding, _quality(metadata)
        )


def _quality(metadata: bytes) -> tuple[Qos, ...]:
    position = 0
    while position < len(metadata):
        key, position = _string(metadata, position)
        value, position = _string(metadata, position)
        if key == b'offered_qos_profiles':
            return tuple(parse_qos(value.decode()))
    return ()


def _decompress(compression: bytes, data: bytes) -> bytes:
    """Decompress, as far as the data go."""
    if compression == b'':
        return data
    if compression == b'zstd':
        return bytes(zstd.ZstdDecompressor().decompress(data))
    if compression == b'lz4':
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data))
    raise UnreadableBagError(f'unknown MCAP compression {compression!r}')


def _read_chunk(found: Recovered, schemas: dict[int, tuple[str, str, str]], body: bytes) -> bool:
    """Read a whole chunk; return False when it is damaged (its bytes are then counted lost)."""
    _, last, size, crc = _CHUNK_HEAD.unpack_from(body)
    found.last_announced_ns = max(found.last_announced_ns, last)
    compression, position = _string(body, _CHUNK_HEAD.size)
    try:
        content = _decompress(compression, body[position + 8 :])
    except (zstd.ZstdError, RuntimeError):
        content = b''
    if len(content) != size or (crc and zlib.crc32(content) != crc):
        found.bytes_lost += size
        return False
    for code, record, _ in _records(content, 0):
        _read_record(found, schemas, code, record)
    return True


def _read_torn_chunk(
    found: Recovered, schemas: dict[int, tuple[str, str, str]], data: bytes, position: int
) -> int:
    """Read what there is of a chunk that runs past the end of the file; return bytes lost."""
    rest = data[position:]
    prefix = _HEAD.size + _CHUNK_HEAD.size
    if len(rest) < prefix + 4 or rest[0] != _CHUNK:
        return len(rest)
    _, last, size, _ = _CHUNK_HEAD.unpack_from(rest, _HEAD.size)
    found.last_announced_ns = max(found.last_announced_ns, last)
    compression, start = _string(rest, prefix)
    try:
        content = _decompress(compression, rest[start + 8 :])
    except (zstd.ZstdError, RuntimeError):
        return int(size)
    whole = 0
    for code, record, end in _records(content, 0):
        whole = end
        _read_record(found, schemas, code, record)
    return int(size) - whole
