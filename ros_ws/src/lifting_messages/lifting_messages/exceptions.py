# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions of this package."""

from __future__ import annotations

from human_model.exceptions import LiftingError


class LiftingMessagesError(LiftingError, ValueError):
    """Base of every error this package raises on bad input."""


class MessageTypeError(LiftingMessagesError):
    """There is no definition of a message type."""


class ParameterError(LiftingMessagesError):
    """A parameter value was refused; the text names node, parameter, value and range."""


class NameListError(LiftingMessagesError):
    """A name that cannot stand in a list of names.

    Attributes
    ----------
    name : str
    """

    def __init__(self, name: str) -> None:
        super().__init__(f'{name!r}: a name in a message is neither empty nor has a line break')
        self.name = name


class MessageValueError(LiftingMessagesError):
    """A field of a message has a value that its definition does not allow.

    Attributes
    ----------
    field : str
        Type and field.
    value : object
    """

    def __init__(self, field: str, value: object, requirement: str) -> None:
        super().__init__(f'{field} = {value!r}: {requirement}')
        self.field = field
        self.value = value


class MessageError(LiftingMessagesError):
    """Bytes that are no message of the type that they should have.

    Attributes
    ----------
    name : str
        Type of the message.
    size : int
        Number of bytes.
    problem : str
        What is wrong.
    """

    def __init__(self, name: str, size: int, problem: str) -> None:
        super().__init__(f'{name}: {size} bytes cannot be decoded: {problem}')
        self.name = name
        self.size = size
        self.problem = problem


class TopicError(LiftingMessagesError):
    """A message of a topic that is no input of a package.

    Attributes
    ----------
    package, topic : str
    """

    def __init__(self, package: str, topic: str) -> None:
        super().__init__(f'{topic}: {package} has no such input')
        self.package = package
        self.topic = topic
