# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Dynamic joint strength: torque limits that depend on angle and speed (thesis 2.14 to 2.19).

    tau_peak = c1 + c2 P(q; c3, c4) + c5 P(v; c6, c7) + c8 P(q; c3, c4) P(v; c6, c7)
    P(x; x0, s) = 4 exp(-(x - x0) / s) / (1 + exp(-(x - x0) / s))^2
    tau = (1 + z_score CV) tau_peak

The thesis cites its coefficients but does not print them. The coefficient sets here are other
published strength data brought into this form; ``data/strength_surfaces.csv`` names the source of
each row and ``data/strength_map.csv`` says which coordinate uses which row, with which sign of
angle and speed. Upper limits act in the coordinate's positive direction; lower ones are negative.
Torques for which nothing is published get the large fixed bound `LARGE`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from human_model.constants import GRAVITY
from human_model.exceptions import StrengthError
from human_model.subject import Subject
from human_model.tables import Row, read_table
from human_model.typing import Array

#: Bound [N m] of one limb's joint torque where no strength is published: no strength but a number
#: that is large against every measured peak (the largest is the trunk's 328.5 N m).
LARGE = 1000.0

_COEFFICIENTS = tuple(f'c{k}' for k in range(1, 9))
#: The coefficients of a constant surface: tau_peak = 1.
_CONSTANT = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0)


def _exp(value: Any) -> Any:
    """Exponential of the argument's own type: a CasADi expression stays one."""
    if isinstance(value, (float, int, np.ndarray, np.generic)):
        return np.exp(value)
    return value.exp()


def peak(x: Any, centre: Any, width: Any) -> Any:
    """Bell of height 1: ``4 e^-u / (1 + e^-u)^2`` with ``u = (x - centre) / width``.

    Written as ``4 / (2 + e^u + e^-u)``, the same function without a quotient of large numbers.
    """
    u = (x - centre) / width
    return 4.0 / (2.0 + _exp(u) + _exp(-u))


def surface(coefficients: Any, q: Any, v: Any) -> Any:
    """Peak torque of equation 2.14 (or 2.17), in the unit of the coefficients.

    Parameters
    ----------
    coefficients
        c1 to c8, numbers or expressions.
    q
        Joint angle [rad]: number, array or CasADi expression.
    v
        Joint speed [rad/s], positive when the muscles shorten.
    """
    angle = peak(q, coefficients[2], coefficients[3])
    speed = peak(v, coefficients[5], coefficients[6])
    return (
        coefficients[0]
        + coefficients[1] * angle
        + coefficients[4] * speed
        + coefficients[7] * angle * speed
    )


def _surfaces() -> tuple[Row, ...]:
    columns = ('set joint direction sex age_low age_high unit scale cv', *_COEFFICIENTS)
    return read_table('human_model', 'strength_surfaces.csv', ' '.join(columns))


def coefficient_sets() -> tuple[str, ...]:
    """Names of the coefficient sets."""
    return tuple(dict.fromkeys(row['set'] for row in _surfaces()))


@dataclass(frozen=True)
class StrengthBound:
    """One limit of one coordinate, ready to be evaluated.

    Attributes
    ----------
    coefficients : tuple of 8 floats
        c1 to c8, without magnitude.
    magnitude : float
        Signed factor [N m]: scale times copies times (1 + z CV), negative for a lower limit.
    angle_factor, speed_factor : float
        From the coordinate's angle and speed to those of the data.
    source : str
    """

    coefficients: tuple[float, ...]
    magnitude: float
    angle_factor: float
    speed_factor: float
    source: str

    def __call__(self, q: Any, v: Any) -> Any:
        """Torque limit [N m] at coordinate value q [rad] and speed v [rad/s]."""
        return self.magnitude * surface(
            self.coefficients, self.angle_factor * q, self.speed_factor * v
        )


class JointStrength:
    """Lower and upper dynamic torque limits of one subject's joints.

    Parameters
    ----------
    skeleton : {'2d_10dof', '3d_40dof'}
        In the sagittal skeleton paired joints have twice the strength of one (thesis 2.1).
    subject : Subject
        Sex and age choose the rows, with interpolation between the age groups; mass and stature
        scale those given in m g h, ``strength_z`` is the z-score.
    coefficient_set : str
        One of `coefficient_sets`.

    Raises
    ------
    StrengthError
        If the set is unknown, a row is missing, or z CV <= -1 leaves no strength.
    """

    def __init__(
        self, skeleton: str, subject: Subject, coefficient_set: str = 'anderson2007_nonneg'
    ) -> None:
        if coefficient_set not in coefficient_sets():
            raise StrengthError(
                f'no coefficient set named {coefficient_set!r}; there are '
                + ', '.join(coefficient_sets())
            )
        self.skeleton = skeleton
        self.coefficient_set = coefficient_set
        bounds: dict[str, dict[str, StrengthBound]] = {}
        columns = 'skeleton coordinate bound joint direction angle_factor speed_factor copies'
        for row in read_table('human_model', 'strength_map.csv', columns):
            if row['skeleton'] == skeleton:
                bounds.setdefault(row['coordinate'], {})[row['bound']] = _bound(
                    row, subject, coefficient_set
                )
        if not bounds:
            raise StrengthError(f'strength_map.csv has no skeleton named {skeleton!r}')
        #: Coordinates with a torque limit: all but those of the free pelvis.
        self.coordinates: tuple[str, ...] = tuple(bounds)
        self._bounds = bounds

    def bound(self, coordinate: str, side: str) -> StrengthBound:
        """Return the 'upper' or 'lower' limit of one coordinate."""
        if coordinate not in self._bounds or side not in ('upper', 'lower'):
            raise StrengthError(f'{self.skeleton}: no {side} strength of {coordinate!r}')
        return self._bounds[coordinate][side]

    def limits(self, coordinate: str, q: Any, v: Any) -> tuple[Any, Any]:
        """Lower and upper limit [N m] (equations 2.18, 2.15) at angle q and speed v.

        Works on numbers, arrays and CasADi expressions.
        """
        return self.bound(coordinate, 'lower')(q, v), self.bound(coordinate, 'upper')(q, v)

    def limit_arrays(
        self, coordinates: tuple[str, ...], q: npt.ArrayLike, v: npt.ArrayLike
    ) -> tuple[Array, Array]:
        """Lower and upper limits (..., n_q) [N m] of all coordinates of a skeleton.

        The free pelvis has no actuator; its columns are -inf and inf.
        """
        angle, speed = np.asarray(q, dtype=np.float64), np.asarray(v, dtype=np.float64)
        lower, upper = np.full(angle.shape, -np.inf), np.full(angle.shape, np.inf)
        for i, name in enumerate(coordinates):
            if name in self._bounds:
                lower[..., i], upper[..., i] = self.limits(name, angle[..., i], speed[..., i])
        return lower, upper


def _bound(row: Row, subject: Subject, coefficient_set: str) -> StrengthBound:
    sign = 1.0 if row['bound'] == 'upper' else -1.0
    copies = row.number('copies')
    factors = row.number('angle_factor'), row.number('speed_factor')
    if row['joint'] == 'none':
        return StrengthBound(_CONSTANT, sign * copies * LARGE, *factors, row['source'])
    found = [
        data
        for data in _surfaces()
        if data['set'] == coefficient_set
        and data['joint'] == row['joint']
        and data['direction'] == row['direction']
        and data['sex'] == subject.sex
    ]
    if not found:
        raise StrengthError(
            f'strength_surfaces.csv, set {coefficient_set}: no row for '
            f'{row["joint"]} {row["direction"]}, {subject.sex}'
        )
    data = _at_age(found, subject.age)
    scale = data['scale']
    if found[0]['unit'] == 'mgh':
        scale *= subject.mass * GRAVITY * subject.stature
    grade = 1.0 + subject.strength_z * data['cv']
    if grade <= 0.0:
        raise StrengthError(
            f'subject.strength_z: {subject.strength_z:g} with CV {data["cv"]:g} '
            f'leaves no {row["joint"]} {row["direction"]} strength'
        )
    return StrengthBound(
        tuple(data[name] for name in _COEFFICIENTS),
        sign * copies * scale * grade,
        *factors,
        found[0]['source'],
    )


def _at_age(groups: Sequence[Row], age: float) -> dict[str, float]:
    """Return scale, CV and coefficients at an age, linear between the middles of age groups."""
    ordered = sorted(groups, key=lambda row: row.number('age_low'))
    middle = [0.5 * sum(row.numbers('age_low', 'age_high')) for row in ordered]
    return {
        name: float(np.interp(age, middle, [row.number(name) for row in ordered]))
        for name in ('scale', 'cv', *_COEFFICIENTS)
    }
