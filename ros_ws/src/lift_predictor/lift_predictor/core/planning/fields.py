# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reading YAML mappings: every access checks and names file, field and value."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lift_predictor.core.exceptions import PlanError


def read_yaml(path: Path) -> Fields:
    """Read the mapping of a YAML file.

    Raises
    ------
    PlanError
        The file cannot be read or is no mapping.
    """
    import yaml

    try:
        data = yaml.safe_load(path.read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise PlanError(f'{path}: cannot be read: {error}') from error
    return Fields(str(path), '', data)


class Fields:
    """One mapping of a file; fields are taken one by one, and what is left over is an error.

    Parameters
    ----------
    source : str
        The file, for messages.
    name : str
        Place of the mapping in it; empty: the file itself.
    data : object
        What should be a mapping.
    """

    def __init__(self, source: str, name: str, data: object) -> None:
        self.source, self.name = source, name
        if not isinstance(data, Mapping):
            raise PlanError(f'{source}: {name or "file"}: a mapping is needed, found {data!r}')
        self._data: dict[str, Any] = {str(key): value for key, value in data.items()}

    def error(self, key: str, problem: str) -> PlanError:
        """Make an error about one field."""
        return PlanError(f'{self.source}: {self._path(key)}: {problem}')

    def _path(self, key: str) -> str:
        return f'{self.name}.{key}' if self.name else key

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def take(self, key: str, *default: Any) -> Any:
        """Take a field of any kind."""
        if key in self._data:
            return self._data.pop(key)
        if default:
            return default[0]
        raise self.error(key, 'is missing')

    def section(self, key: str) -> Fields:
        """Take a mapping."""
        return Fields(self.source, self._path(key), self.take(key))

    def entries(self, key: str) -> list[Fields]:
        """Take a list of mappings that is not empty."""
        value = self.take(key)
        if not isinstance(value, list) or not value:
            raise self.error(key, f'a list is needed, found {value!r}')
        return [Fields(self.source, f'{self._path(key)}[{i}]', v) for i, v in enumerate(value)]

    def number(self, key: str, *default: float) -> float:
        """Take a number."""
        value = self.take(key, *default)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(key, f'a number is needed, found {value!r}')
        return float(value)

    def whole(self, key: str, *default: int) -> int:
        """Take a whole number."""
        value = self.take(key, *default)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.error(key, f'a whole number is needed, found {value!r}')
        return value

    def numbers(self, key: str, count: int, *default: tuple[float, ...]) -> tuple[float, ...]:
        """Take a list of so many numbers."""
        value = self.take(key, *default)
        if (
            not isinstance(value, list | tuple)
            or len(value) != count
            or any(isinstance(v, bool) or not isinstance(v, int | float) for v in value)
        ):
            raise self.error(key, f'{count} numbers are needed, found {value!r}')
        return tuple(float(v) for v in value)

    def text(self, key: str, *default: str) -> str:
        """Take a text."""
        value = self.take(key, *default)
        if not isinstance(value, str):
            raise self.error(key, f'a text is needed, found {value!r}')
        return value.strip()

    def finish(self) -> None:
        """Refuse fields that nobody took."""
        if self._data:
            raise self.error(next(iter(self._data)), 'is not a known field')
