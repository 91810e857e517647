# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node parameters declared from one table; bad values are refused."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import yaml
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

Value = bool | int | float | str


class ParameterError(ValueError):
    """A parameter value was refused; says which node, parameter, value and range."""


@dataclass(frozen=True)
class Parameter:
    """One declared parameter.

    Parameters
    ----------
    name, description, unit : str
        Unit is empty for names and switches.
    default : bool, int, float or str
        Its type is the parameter's type.
    minimum, maximum : float, optional
        Range of a number, ends included.
    choices : tuple of str
        Allowed values of a name; empty if any.
    """

    name: str
    description: str
    unit: str
    default: Value
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()

    def descriptor(self) -> ParameterDescriptor:
        """Return the descriptor that `ros2 param describe` shows."""
        unit = f' [{self.unit}]' if self.unit else ''
        descriptor = ParameterDescriptor(
            name=self.name, description=self.description + unit, read_only=True
        )
        if self.choices:
            descriptor.additional_constraints = 'one of: ' + ', '.join(self.choices)
        if self.minimum is not None and self.maximum is not None:
            if isinstance(self.default, int) and not isinstance(self.default, bool):
                descriptor.integer_range = [
                    IntegerRange(from_value=int(self.minimum), to_value=int(self.maximum))
                ]
            else:
                descriptor.floating_point_range = [
                    FloatingPointRange(
                        from_value=float(self.minimum), to_value=float(self.maximum)
                    )
                ]
        return descriptor

    def check(self, node: str, value: Value) -> None:
        """Raise ParameterError if `value` is not one of the choices."""
        if self.choices and value not in self.choices:
            allowed = ', '.join(self.choices)
            msg = f'{node}: parameter {self.name} = {value!r} is not one of {allowed}'
            raise ParameterError(msg)


def load_table(package: str) -> tuple[Parameter, ...]:
    """Read `data/parameters.yaml` of a package.

    Parameters
    ----------
    package : str
        Import name of the package.

    Returns
    -------
    tuple of Parameter

    Raises
    ------
    ParameterError
        If an entry lacks a field or has an unknown one.
    """
    source = files(package).joinpath('data', 'parameters.yaml')
    entries: dict[str, dict[str, Any]] = yaml.safe_load(source.read_text(encoding='utf-8'))
    table = []
    for name, entry in entries.items():
        fields = dict(entry)
        fields['choices'] = tuple(fields.get('choices', ()))
        try:
            table.append(Parameter(name=name, **fields))
        except TypeError as error:
            raise ParameterError(f'{source}: parameter {name}: {error}') from error
    return tuple(table)


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
                parameter.name, parameter.default, parameter.descriptor()
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
