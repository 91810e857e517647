# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Checked reading of YAML mappings: an error names the file, the field and the value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Self, TypeVar

from human_model.exceptions import FieldError, LiftingError

T = TypeVar('T')


class Fields:
    """One mapping of a file.  Fields are taken one by one; a field that is left is an error.

    Parameters
    ----------
    source : str
        The file, for messages.
    name : str
        Place of the mapping in the file; empty: the file itself.
    data : object
        The mapping.

    Raises
    ------
    LiftingError
        Of the class `ERROR`, as do all methods, if a field is missing or has a wrong value.
    """

    ERROR: ClassVar[type[LiftingError]] = FieldError

    def __init__(self, source: str, name: str, data: object) -> None:
        self.source, self.name = source, name
        if not isinstance(data, Mapping):
            raise self.ERROR(f'{source}: {name or "file"}: a mapping is needed, found {data!r}')
        self._data: dict[str, Any] = {str(key): value for key, value in data.items()}

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read the mapping of a YAML file."""
        import yaml

        try:
            data = yaml.safe_load(path.read_text(encoding='utf-8'))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise cls.ERROR(f'{path}: cannot be read: {error}') from error
        return cls(str(path), '', data)

    def error(self, key: str, problem: str) -> LiftingError:
        """Return an error about one field."""
        return self.ERROR(f'{self.source}: {self._path(key)}: {problem}')

    def _path(self, key: str) -> str:
        return f'{self.name}.{key}' if self.name else key

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def names(self) -> list[str]:
        """Return the names of the fields that were not taken yet."""
        return list(self._data)

    def take(self, key: str, *default: Any) -> Any:
        """Take a field of any kind."""
        if key in self._data:
            return self._data.pop(key)
        if default:
            return default[0]
        raise self.error(key, 'is missing')

    def section(self, key: str, *default: Mapping[str, Any]) -> Self:
        """Take a mapping, as fields."""
        return type(self)(self.source, self._path(key), self.take(key, *default))

    def entries(self, key: str) -> list[Self]:
        """Take a list of mappings that is not empty."""
        value = self.take(key)
        if not isinstance(value, list) or not value:
            raise self.error(key, f'a list is needed, found {value!r}')
        return [type(self)(self.source, f'{self._path(key)}[{i}]', v) for i, v in enumerate(value)]

    def mapping(self, key: str) -> dict[str, Any]:
        """Take a mapping, as a dictionary; empty if it is missing."""
        value = self.take(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f'a mapping is needed, found {value!r}')
        return {str(k): v for k, v in value.items()}

    def number(self, key: str, *default: float) -> float:
        """Take a finite number."""
        value = self.take(key, *default)
        if not _is_number(value):
            raise self.error(key, f'a number is needed, found {value!r}')
        if not math.isfinite(value):
            raise self.error(key, f'a finite number is needed, found {value}')
        return float(value)

    def within(self, key: str, limits: tuple[float, float, str], *default: float) -> float:
        """Take a number between two limits, which are given with their unit."""
        value, (low, high, unit) = self.number(key, *default), limits
        if not low <= value <= high:
            raise self.error(key, f'{value:g} {unit} is outside of {low:g} to {high:g} {unit}')
        return value

    def at_least_zero(self, key: str, *default: float) -> float:
        """Take a number that is not negative."""
        value = self.number(key, *default)
        if value < 0.0:
            raise self.error(key, f'{value:g} is negative')
        return value

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
            or not all(map(_is_number, value))
        ):
            raise self.error(key, f'{count} numbers are needed, found {value!r}')
        return tuple(float(v) for v in value)

    def text(self, key: str, *default: str) -> str:
        """Take a text."""
        value = self.take(key, *default)
        if not isinstance(value, str):
            raise self.error(key, f'a text is needed, found {value!r}')
        return value.strip()

    def flag(self, key: str, default: bool) -> bool:
        """Take true or false."""
        value = self.take(key, default)
        if not isinstance(value, bool):
            raise self.error(key, f'true or false is needed, found {value!r}')
        return value

    def choice(self, key: str, choices: Mapping[str, T], *default: T) -> T:
        """Take one of several names; return the value of the name."""
        if default and key not in self:
            return default[0]
        value = self.take(key)
        if value not in choices:
            raise self.error(key, f'{value!r} is not one of {", ".join(choices)}')
        return choices[value]

    def finish(self) -> None:
        """Refuse the fields that were not taken."""
        if self._data:
            raise self.error(next(iter(self._data)), 'is not a known field')


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
