# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node that republishes the markers of a mocap4r2 driver as the markers of a station.

Run it in the namespace of the station.  The driver's topic is `mocap4r2_markers` (remap it); its
positions must be in metres in the laboratory frame: x forward, y left, z up, origin on the floor.
"""

from __future__ import annotations

import importlib
from typing import Any

from lifting_interfaces.msg import Markers
from rclpy.node import Node

from lifting_messages import LiftingMessagesError, encode
from lifting_messages.conversions import LABORATORY
from lifting_messages.current_form import current_form
from lifting_node import qos
from lifting_node.run import run_node

SOURCE = 'mocap4r2_msgs/msg/Markers'


class Mocap4r2Adapter(Node):
    """Markers of mocap4r2 in, markers of the graph out."""

    def __init__(self) -> None:
        # No dependency of this package: only users of such a driver have it.
        driver = importlib.import_module('mocap4r2_msgs.msg')
        super().__init__('mocap4r2_adapter')
        self._markers = self.create_publisher(Markers, 'markers', qos.FRAMES)
        self.create_subscription(driver.Markers, 'mocap4r2_markers', self._on_markers, qos.DRIVER)

    def _on_markers(self, message: Any) -> None:
        try:
            markers = current_form(message, SOURCE)
        except LiftingMessagesError as error:
            self.get_logger().error(f'mocap4r2_markers: {error}', throttle_duration_sec=10.0)
            return
        markers.header.frame_id = LABORATORY
        self._markers.publish(encode(markers))


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    try:
        run_node(Mocap4r2Adapter, args)
    except ModuleNotFoundError as error:
        raise SystemExit(
            f'mocap4r2_adapter: {error.name} is not installed; source the workspace of your driver'
        ) from error


if __name__ == '__main__':
    main()
