# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node parameters declared from one table; bad values are refused."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from lifting_messages.exceptions import ParameterError
from lifting_messages.parameters import Parameter


def descriptor(parameter: Parameter) -> ParameterDescriptor:
    """Return the descriptor that `ros2 param describe` shows."""
    unit = f' [{parameter.unit}]' if parameter.unit else ''
    result = ParameterDescriptor(
        name=parameter.name, description=parameter.description + unit, read_only=True
    )
    if parameter.choices:
        result.additional_constraints = 'one of: ' + ', '.join(parameter.choices)
    if parameter.minimum is not None and parameter.maximum is not None:
        if isinstance(parameter.default, int) and not isinstance(parameter.default, bool):
            result.integer_range = [
                IntegerRange(from_value=int(parameter.minimum), to_value=int(parameter.maximum))
            ]
        else:
            result.floating_point_range = [
                FloatingPointRange(
                    from_value=float(parameter.minimum), to_value=float(parameter.maximum)
                )
            ]
    return result


def declare(node: Node, table: tuple[Parameter, ...]) -> dict[str, Any]:
    """Declare all parameters of a table on a node and return their values by name.

    Raises
    ------
    ParameterError
        If an override has the wrong type, is out of range or not one of the choices.
    """
    values: dict[str, Any] = {}
    for parameter in table:
        try:
            value = node.declare_parameter(
                parameter.name, parameter.default, descriptor(parameter)
            ).value
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            msg = (
                f'{node.get_name()}: parameter {parameter.name} refused: {error} '
                f'(allowed {parameter.minimum} to {parameter.maximum} {parameter.unit})'
            )
            raise ParameterError(msg) from error
        parameter.check(node.get_name(), value)
        values[parameter.name] = value
    return values
