# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Markers of a mocap4r2 driver arrive as markers of the station."""

import time

import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
driver = pytest.importorskip('mocap4r2_msgs.msg', reason='mocap4r2_msgs is not built')

from lifting_interfaces.msg import Markers  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.qos import qos_profile_sensor_data  # noqa: E402

from lifting_node import qos  # noqa: E402
from motion_tracker.mocap4r2_adapter import Mocap4r2Adapter  # noqa: E402

PATIENCE = 20.0


def frame():
    message = driver.Markers(frame_number=4)
    message.header.frame_id = 'map'
    message.header.stamp.sec, message.header.stamp.nanosec = 7, 250_000_000
    for index, name in enumerate(['C7', '']):
        marker = driver.Marker(marker_index=index, marker_name=name)
        marker.translation.x, marker.translation.z = 0.5 * index, 1.25
        message.markers.append(marker)
    return message


@pytest.mark.parametrize('profile', [qos_profile_sensor_data, 10], ids=['best effort', 'reliable'])
def test_markers_of_a_driver(monkeypatch, profile):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    rclpy.init(args=['--ros-args', '-r', '__ns:=/test_mocap4r2'])
    adapter, client = Mocap4r2Adapter(), rclpy.create_node('client', namespace='test_mocap4r2')
    executor = SingleThreadedExecutor()
    executor.add_node(adapter)
    executor.add_node(client)
    received = []
    try:
        client.create_subscription(Markers, 'markers', received.append, qos.FRAMES)
        publisher = client.create_publisher(driver.Markers, 'mocap4r2_markers', profile)
        deadline = time.monotonic() + PATIENCE
        while not received and time.monotonic() < deadline:
            publisher.publish(frame())
            executor.spin_once(timeout_sec=0.05)
    finally:
        executor.shutdown()
        client.destroy_node()
        adapter.destroy_node()
        rclpy.shutdown()
    assert received, f'nothing came within {PATIENCE:g} s'
    message = received[0]
    assert (message.header.frame_id, message.header.stamp.sec, message.frame_number) == (
        'world', 7, 4,
    )  # fmt: skip
    assert message.names.split('\n') == ['C7', '1']
    assert list(message.positions) == [0.0, 0.0, 1.25, 0.5, 0.0, 1.25]
