# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write the graph's input topics to an MCAP bag that can be read alone.

The definitions of all messages go into the file, the offered quality of service into its
metadata: `subject` and `task` transient local, the streams reliable and keep all.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from heapq import merge
from pathlib import Path
from types import TracebackType
from typing import Any, Literal

import numpy as np
from rosbags.interfaces import (
    Connection,
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.rosbag2.errors import WriterError

from human_model.typing import Array
from lifting_messages import typestore
from lifting_messages.names import join
from lifting_recordings.exceptions import BagError

WORLD = 'world'
# A recording carries no date: its stamps count from here [ns], so that no stamp is zero, which
# ROS takes for "no time".
START_TIME_NS = 1_000_000_000_000_000_000
BAG_VERSION: Literal[9] = 9

_NO_LIMIT = QosTime(9223372036, 854775807)


def quality(*, transient_local: bool) -> Qos:
    """Return the offered quality of service of a stream or of a latched topic."""
    return Qos(
        history=QosHistory.KEEP_LAST if transient_local else QosHistory.KEEP_ALL,
        depth=1 if transient_local else 0,
        reliability=QosReliability.RELIABLE,
        durability=QosDurability.TRANSIENT_LOCAL if transient_local else QosDurability.VOLATILE,
        deadline=_NO_LIMIT,
        lifespan=_NO_LIMIT,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_NO_LIMIT,
        avoid_ros_namespace_conventions=False,
    )


class BagWriter:
    """Context manager that writes messages of our types to a new MCAP bag.

    Parameters
    ----------
    path : Path
        Folder to create (a rosbag2 bag).
    compress : bool
        Compress the chunks inside the file with zstd.

    Raises
    ------
    BagError
        The folder exists.
    """

    def __init__(self, path: str | Path, *, compress: bool = True) -> None:
        self.path = Path(path)
        self.types = typestore()
        try:
            self._writer = Writer(
                self.path, version=BAG_VERSION, storage_plugin=StoragePlugin.MCAP
            )
        except WriterError as error:
            raise BagError(str(error)) from error
        if compress:
            self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        self._connections: dict[str, tuple[Connection, str]] = {}
        self._stack = ExitStack()

    def __enter__(self) -> BagWriter:
        """Create the folder."""
        self._stack.enter_context(self._writer)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Write index and metadata, or leave an unfinished bag after an error."""
        self._stack.__exit__(kind, error, trace)

    def topic(self, name: str, msgtype: str, *, transient_local: bool = False) -> None:
        """Announce a topic by its relative name; the bag holds it in the root namespace."""
        connection = self._writer.add_connection(
            f'/{name}',
            msgtype,
            typestore=self.types,
            offered_qos_profiles=[quality(transient_local=transient_local)],
        )
        self._connections[name] = (connection, msgtype)

    def write(self, topic: str, stamp_ns: int, message: object) -> None:
        """Serialise and write one message."""
        connection, msgtype = self._connections[topic]
        self._writer.write(connection, stamp_ns, self.types.serialize_cdr(message, msgtype))

    def make(self, msgtype: str, **fields: Any) -> Any:
        """Return a message of `msgtype`, all fields given by name."""
        return self.types.types[msgtype](**fields)

    def header(self, stamp_ns: int, frame_id: str = WORLD) -> Any:
        """Return a std_msgs/Header."""
        seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
        stamp = self.make('builtin_interfaces/msg/Time', sec=seconds, nanosec=nanoseconds)
        return self.make('std_msgs/msg/Header', stamp=stamp, frame_id=frame_id)

    def point(self, place: Array) -> Any:
        """Return a geometry_msgs/Point."""
        x, y, z = (float(v) for v in place)
        return self.make('geometry_msgs/msg/Point', x=x, y=y, z=z)

    def vector(self, values: Array) -> Any:
        """Return a geometry_msgs/Vector3."""
        x, y, z = (float(v) for v in values)
        return self.make('geometry_msgs/msg/Vector3', x=x, y=y, z=z)

    def markers(self, stamp_ns: int, frame: int, names: tuple[str, ...], places: Array) -> Any:
        """Return a Markers message; a place with NaN is that of a marker that was not seen."""
        unseen = ~np.all(np.isfinite(places), axis=1, keepdims=True)
        return self.make(
            'lifting_interfaces/msg/Markers',
            header=self.header(stamp_ns),
            frame_number=frame,
            names=join(names),
            positions=np.where(unseen, np.nan, places).ravel(),
        )

    def wrench(self, stamp_ns: int, force: Array, moment: Array) -> Any:
        """Return a WrenchStamped at the laboratory origin, in laboratory axes."""
        wrench = self.make(
            'geometry_msgs/msg/Wrench', force=self.vector(force), torque=self.vector(moment)
        )
        return self.make(
            'geometry_msgs/msg/WrenchStamped', header=self.header(stamp_ns), wrench=wrench
        )

    def pose(self, stamp_ns: int, position: Array, quaternion: Array) -> Any:
        """Return a PoseStamped; quaternion x, y, z, w."""
        x, y, z, w = (float(v) for v in quaternion)
        pose = self.make(
            'geometry_msgs/msg/Pose',
            position=self.point(position),
            orientation=self.make('geometry_msgs/msg/Quaternion', x=x, y=y, z=z, w=w),
        )
        return self.make('geometry_msgs/msg/PoseStamped', header=self.header(stamp_ns), pose=pose)


def in_order(*streams: Iterator[tuple[int, str, Any]]) -> Iterator[tuple[int, str, Any]]:
    """Merge (stamp, topic, message) streams by stamp."""
    return merge(*streams, key=lambda entry: entry[0])
