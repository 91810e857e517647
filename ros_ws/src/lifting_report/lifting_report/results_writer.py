# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write results to an MCAP file as the recorder of a running graph does."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rosbags.interfaces import Connection
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys.store import Typestore

from lifting_messages import typestore
from lifting_recordings.bag_writer import BAG_VERSION, quality

NANOSECONDS = 1_000_000_000


class ResultsWriter:
    """Context manager over a new results file; one of an earlier run is replaced.

    Parameters
    ----------
    path : Path
        The .mcap file.
    station : str
        Namespace of the topics.
    """

    def __init__(self, path: Path, station: str) -> None:
        self._path = path
        self._station = station
        self._folder = path.with_suffix('.writing')
        shutil.rmtree(self._folder, ignore_errors=True)
        self._writer = Writer(self._folder, version=BAG_VERSION, storage_plugin=StoragePlugin.MCAP)
        self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        self._store = typestore()
        self._connections: dict[str, Connection] = {}

    def __enter__(self) -> Self:
        self._writer.open()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._writer.close()
        if kind is None:
            (file,) = self._folder.glob('*.mcap')
            file.replace(self._path)
        shutil.rmtree(self._folder)

    def write(self, topic: str, message: Any) -> None:
        """Write one message under the stamp of its header."""
        self.write_decoded(topic, message, self._store)

    def write_decoded(self, topic: str, message: Any, store: Typestore) -> None:
        """Write one message decoded from a recording."""
        name = message.__msgtype__
        self._write(topic, name, message.header.stamp, store.serialize_cdr(message, name))

    def _write(self, topic: str, message_type: str, stamp: Any, data: Any) -> None:
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(
                f'/{self._station}/{topic}',
                message_type,
                typestore=self._store,
                offered_qos_profiles=[quality(transient_local=topic in ('subject', 'task'))],
            )
        time = stamp.sec * NANOSECONDS + stamp.nanosec
        self._writer.write(self._connections[topic], time, data)
