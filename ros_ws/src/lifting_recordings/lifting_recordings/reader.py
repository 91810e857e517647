# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Read a bag offline with the definitions it carries: any rosbag2 bag, MCAP or SQLite3.

A cut-off MCAP file is read as far as it goes; `BagReader.loss` says how much is missing.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from sqlite3 import DatabaseError
from types import TracebackType
from typing import Any

import yaml
from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinitionFormat, Qos
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.errors import ReaderError
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from lifting_messages import encode, typestore
from lifting_messages.current_form import current_form, is_current
from lifting_recordings.exceptions import MessageTypeError, UnreadableBagError
from lifting_recordings.mcap_recovery import Recovered, has_footer, recover

_STORAGE = {'.mcap': 'mcap', '.db3': 'sqlite3'}


@dataclass(frozen=True)
class BagTopic:
    """One topic of a bag.

    Attributes
    ----------
    name, msgtype : str
        As stored, e.g. '/markers', 'lifting_interfaces/msg/Markers'.
    definition : str
        Text of the message definition; '' when the bag has none.
    encoding : str
        'ros2msg', 'ros2idl' or ''.
    qos : tuple of Qos
        Offered quality of service; empty when the bag does not say.
    count : int
        Messages.
    """

    name: str
    msgtype: str
    definition: str
    encoding: str
    qos: tuple[Qos, ...]
    count: int


@dataclass(frozen=True)
class BagLoss:
    """How much of a cut-off bag is missing.

    Attributes
    ----------
    bytes_lost : int
        Of records that are cut off or damaged.
    seconds_lost : float
        From the last message read to the end the bag announces [s]; a lower bound when
        `messages_lost` is None.
    messages_lost : int or None
        From the bag's metadata; None when there is none.
    """

    bytes_lost: int
    seconds_lost: float
    messages_lost: int | None

    def __str__(self) -> str:
        """Say it in words."""
        if self.messages_lost is None:
            return (
                f'cut off: {self.bytes_lost} bytes and at least {self.seconds_lost:.3f} s lost '
                '(no metadata that says how long it was)'
            )
        return (
            f'cut off: {self.bytes_lost} bytes, {self.seconds_lost:.3f} s and '
            f'{self.messages_lost} messages lost'
        )


@dataclass(frozen=True)
class _Metadata:
    start_ns: int
    end_ns: int
    count: int


class BagReader:
    """Context manager over a bag folder or a single .mcap or .db3 file.

    Parameters
    ----------
    path : str or Path
        The bag.

    Attributes
    ----------
    topics : dict of str to BagTopic
        By stored name.
    start_ns, end_ns : int
        Stamps of the first and last message [ns].
    loss : BagLoss or None
        None: the bag is whole.
    size : int
        Of its files [bytes].

    Raises
    ------
    UnreadableBagError
        On entry: missing, empty, foreign or damaged beyond recovery.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.topics: dict[str, BagTopic] = {}
        self.start_ns = 0
        self.end_ns = 0
        self.loss: BagLoss | None = None
        self.size = 0
        self._stack = ExitStack()
        self._reader: Reader | None = None
        self._recovered: list[Recovered] = []
        self._store: Typestore | None = None

    def __enter__(self) -> BagReader:
        """Open the bag."""
        files, metadata = self._files()
        self.size = sum(file.stat().st_size for file in files)
        torn = [f for f in files if f.suffix == '.mcap' and not has_footer(f)]
        if torn:
            self._open_torn(files, metadata)
        else:
            self._open_whole(files, metadata)
        if not self.topics or not any(topic.count for topic in self.topics.values()):
            raise UnreadableBagError(f'{self.path}: holds no messages')
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the files."""
        self._stack.close()
        self._reader = None
        self._recovered = []

    def _files(self) -> tuple[list[Path], _Metadata | None]:
        path = self.path
        if not path.exists():
            raise UnreadableBagError(f'{path}: does not exist')
        if path.is_file():
            if path.suffix not in _STORAGE:
                raise UnreadableBagError(f'{path}: is neither a bag folder, .mcap nor .db3')
            files, metadata = [path], None
        elif (path / 'metadata.yaml').is_file():
            files, metadata = self._metadata()
        else:
            files = sorted(f for f in path.iterdir() if f.suffix in _STORAGE)
            metadata = None
            if not files:
                raise UnreadableBagError(f'{path}: is no bag (no metadata.yaml, .mcap or .db3)')
        for file in files:
            if not file.is_file():
                raise UnreadableBagError(f'{file}: is named in metadata.yaml, but missing')
            if file.stat().st_size == 0:
                raise UnreadableBagError(f'{file}: is empty (0 bytes)')
        return files, metadata

    def _metadata(self) -> tuple[list[Path], _Metadata]:
        file = self.path / 'metadata.yaml'
        try:
            data = yaml.safe_load(file.read_text(encoding='utf-8'))['rosbag2_bagfile_information']
            files = [self.path / Path(name).name for name in data['relative_file_paths']]
            start = int(data['starting_time']['nanoseconds_since_epoch'])
            duration = int(data['duration']['nanoseconds'])
            return files, _Metadata(start, start + duration, int(data['message_count']))
        except (yaml.YAMLError, KeyError, TypeError, ValueError, UnicodeDecodeError) as error:
            raise UnreadableBagError(f'{file}: damaged metadata: {error!r}') from error

    def _open_whole(self, files: list[Path], metadata: _Metadata | None) -> None:
        source = self.path if metadata is not None else files[0]
        if metadata is None and len(files) > 1:
            raise UnreadableBagError(
                f'{self.path}: {len(files)} files without metadata.yaml; name one of them'
            )
        try:
            self._reader = self._stack.enter_context(Reader(source))
        except (ReaderError, DatabaseError, OSError, ValueError, TypeError) as error:
            raise UnreadableBagError(f'{source}: cannot be read: {error}') from error
        for connection in self._reader.connections:
            old = self.topics.get(connection.topic)
            self.topics[connection.topic] = _topic(connection, old.count if old else 0)
        self.start_ns = self._reader.start_time
        self.end_ns = self._reader.end_time - 1

    def _open_torn(self, files: list[Path], metadata: _Metadata | None) -> None:
        self._recovered = [recover(file) for file in files]
        stamps = [m[0] for part in self._recovered for m in part.messages]
        self.start_ns, self.end_ns = min(stamps), max(stamps)
        for part in self._recovered:
            counts = dict.fromkeys(part.channels, 0)
            for _, key, _ in part.messages:
                counts[key] += 1
            for key, channel in part.channels.items():
                old = self.topics.get(channel.topic)
                self.topics[channel.topic] = BagTopic(
                    channel.topic,
                    channel.msgtype,
                    channel.definition,
                    channel.encoding,
                    channel.qos,
                    counts[key] + (old.count if old else 0),
                )
        announced = max(part.last_announced_ns for part in self._recovered)
        end = max(announced, metadata.end_ns if metadata else 0)
        self.loss = BagLoss(
            bytes_lost=sum(part.bytes_lost for part in self._recovered),
            seconds_lost=max(0, end - self.end_ns) * 1e-9,
            messages_lost=metadata.count - len(stamps) if metadata else None,
        )

    def raw_messages(
        self, topics: Collection[str] | None = None, start_ns: int | None = None
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield (topic, stamp [ns], serialised message) by stamp.

        Parameters
        ----------
        topics : collection of str, optional
            Stored names; all without it.
        start_ns : int, optional
            First stamp.

        Raises
        ------
        UnreadableBagError
            The bag turns out damaged on the way.
        """
        if self._reader is None:
            yield from self._raw_recovered(topics, start_ns)
            return
        connections = [c for c in self._reader.connections if topics is None or c.topic in topics]
        if not connections:
            return
        try:
            for connection, stamp, data in self._reader.messages(connections, start=start_ns):
                yield connection.topic, stamp, bytes(data)
        except (ReaderError, DatabaseError) as error:
            raise UnreadableBagError(f'{self.path}: damaged: {error}') from error

    def _raw_recovered(
        self, topics: Collection[str] | None, start_ns: int | None
    ) -> Iterator[tuple[str, int, bytes]]:
        found = [
            (stamp, part.channels[channel].topic, data)
            for part in self._recovered
            for stamp, channel, data in part.messages
        ]
        for stamp, topic, data in sorted(found, key=lambda entry: entry[0]):
            if (topics is None or topic in topics) and (start_ns is None or stamp >= start_ns):
                yield topic, stamp, data

    @property
    def types(self) -> Typestore:
        """Message types from the definitions inside the bag (ours where it has none)."""
        if self._store is None:
            self._store = self._load_types()
        return self._store

    def _load_types(self) -> Typestore:
        if not any(topic.definition for topic in self.topics.values()):
            return typestore()
        store = get_typestore(Stores.EMPTY)
        for topic in self.topics.values():
            if topic.encoding == 'ros2msg':
                store.register(get_types_from_msg(topic.definition, topic.msgtype))
            elif topic.encoding == 'ros2idl':
                store.register(get_types_from_idl(topic.definition))
        return store

    def messages(
        self, topics: Collection[str] | None = None, start_ns: int | None = None
    ) -> Iterator[tuple[str, int, Any]]:
        """Yield (topic, stamp [ns], decoded message); arguments as `raw_messages`.

        Messages of earlier definitions come in today's form (`lifting_messages.current_form`).

        Raises
        ------
        MessageTypeError
            The bag has no definition of a topic's type.
        """
        store = self.types
        names = {name: topic.msgtype for name, topic in self.topics.items()}
        for name in topics if topics is not None else names:
            if name in names and names[name] not in store.fielddefs:
                raise MessageTypeError(
                    f'{self.path}: topic {name}: no definition of {names[name]}'
                )
        earlier = {name for name, kind in names.items() if not is_current(kind, store)}
        for topic, stamp, data in self.raw_messages(topics, start_ns):
            message = store.deserialize_cdr(data, names[topic])
            if topic in earlier:
                message = current_form(message, names[topic])
            yield topic, stamp, message

    def current_messages(
        self, topics: Collection[str], start_ns: int | None = None
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield what `raw_messages` yields, in today's form: of the types `current_type` gives."""
        types = {name: self.topics[name].msgtype for name in topics}
        earlier = {name for name, kind in types.items() if not is_current(kind, self.types)}
        for topic, stamp, data in self.raw_messages(topics, start_ns):
            if topic in earlier:
                kind = types[topic]
                message = current_form(self.types.deserialize_cdr(data, kind), kind)
                yield topic, stamp, encode(message)
            else:
                yield topic, stamp, data


def _topic(connection: Connection, more: int) -> BagTopic:
    encoding = {
        MessageDefinitionFormat.MSG: 'ros2msg',
        MessageDefinitionFormat.IDL: 'ros2idl',
    }.get(connection.msgdef.format, '')
    ext = connection.ext
    qos = tuple(ext.offered_qos_profiles) if isinstance(ext, ConnectionExtRosbag2) else ()
    return BagTopic(
        connection.topic,
        connection.msgtype,
        connection.msgdef.data,
        encoding,
        qos,
        connection.msgcount + more,
    )
