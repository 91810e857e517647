# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the graph as Python objects, without ROS."""

from lifting_messages.exceptions import LiftingMessagesError, MessageError, MessageTypeError
from lifting_messages.message_types import Message, decode, encode, make, message_type, typestore

__all__ = [
    'LiftingMessagesError',
    'Message',
    'MessageError',
    'MessageTypeError',
    'decode',
    'encode',
    'make',
    'message_type',
    'typestore',
]
