# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages in the classes of rclpy, which services and actions need."""

from __future__ import annotations

from typing import Any

from rclpy.serialization import deserialize_message

from lifting_messages import Message, encode


def to_ros(message: Message, ros_class: type) -> Any:
    """Return a message as an object of the class that rosidl generated for its type."""
    return deserialize_message(encode(message), ros_class)
