# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Table of a node's parameters, without ROS: `data/parameters.yaml` of a package."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import yaml

from lifting_messages.exceptions import ParameterError

Value = bool | int | float | str


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


def defaults(package: str) -> dict[str, Any]:
    """Return the default values of a package's parameters by name."""
    return {parameter.name: parameter.default for parameter in load_table(package)}
