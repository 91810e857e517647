# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Typed access to the elements of an `.osim` file; errors name file, element and value."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element, ParseError, fromstring

import numpy as np
from numpy.typing import ArrayLike

from human_model.typing import Array
from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim import functions
from muscle_analyzer.core.osim.functions import PiecewisePolynomial
from muscle_analyzer.core.osim.upgrade import upgrade_model

#: Versions that files of OpenSim 4 (from this one on) and of OpenSim 3.0 to 3.3 carry.
OLDEST_VERSION, OPENSIM_3 = 40000, 30000


class OsimXml:
    """The parsed file, and the readers of single values in it.

    A value that an element does not give is taken from the file's <defaults> for elements of its
    type, as OpenSim does.

    Parameters
    ----------
    path : Path
        A model file of OpenSim 4.x or 3.0 to 3.3.
    content : bytes, optional
        What the file holds, if it has been read already.

    Raises
    ------
    OsimFormatError
        If the file cannot be read, is not XML, is not a model, or is of another version.
    """

    def __init__(self, path: Path, content: bytes | None = None) -> None:
        self.path = path
        try:
            root = fromstring(path.read_bytes() if content is None else content)
        except (OSError, ParseError) as error:
            raise OsimFormatError(f'{path}: cannot be read as XML: {error}') from error
        model = root.find('Model')
        if root.tag != 'OpenSimDocument' or model is None:
            raise OsimFormatError(f'{path}: <{root.tag}> is no OpenSim model document')
        version = root.get('Version', '')
        number = int(version) if version.isdigit() else 0
        if number < OLDEST_VERSION and number != OPENSIM_3:
            raise OsimFormatError(
                f'{path}: Version={version!r}, a file of OpenSim 4 or of OpenSim 3.0 to 3.3 '
                f'(Version="{OPENSIM_3}") is needed'
            )
        self.model = model
        self._defaults = {element.tag: element for element in model.findall('defaults/*')}
        if number == OPENSIM_3:
            upgrade_model(model, self.where)

    def where(self, element: Element) -> str:
        """Return 'file: <tag name="...">' for messages."""
        name = element.get('name')
        label = f' name="{name}"' if name else ''
        return f'{self.path}: <{element.tag}{label}>'

    def name(self, element: Element) -> str:
        """Return an element's name attribute, which must be there."""
        name = element.get('name')
        if not name:
            raise OsimFormatError(f'{self.where(element)} has no name')
        return name

    def objects(self, set_tag: str, parent: Element | None = None) -> Iterator[Element]:
        """Yield the objects of a set such as BodySet; nothing if the set is missing."""
        found = (self.model if parent is None else parent).find(f'{set_tag}/objects')
        yield from () if found is None else found

    def child(self, element: Element, tag: str) -> Element | None:
        """Return a child element, or that of the file's default for the element's type."""
        found = element.find(tag)
        if found is None and element.tag in self._defaults:
            found = self._defaults[element.tag].find(tag)
        return found

    def children(self, element: Element) -> list[Element]:
        """Return all children, those of the file's default first."""
        return [*self._defaults.get(element.tag, ()), *element]

    def has(self, element: Element, tag: str) -> bool:
        """Tell whether a child element is there and is not empty."""
        found = self.child(element, tag)
        return found is not None and bool((found.text or '').strip())

    def text(self, element: Element, tag: str) -> str:
        """Return the stripped text of a child element, which must be there."""
        child = self.child(element, tag)
        if child is None or child.text is None or not child.text.strip():
            raise OsimFormatError(f'{self.where(element)} has no <{tag}>')
        return child.text.strip()

    def numbers(self, element: Element, tag: str, count: int | None = None) -> Array:
        """Return a child's numbers, `count` of them if given."""
        text = self.text(element, tag)
        try:
            values = np.array([float(part) for part in text.split()])
        except ValueError as error:
            raise OsimFormatError(f'{self.where(element)} <{tag}>: {text!r}') from error
        if (count is not None and values.size != count) or not np.all(np.isfinite(values)):
            raise OsimFormatError(f'{self.where(element)} <{tag}>: {text!r}, want {count} numbers')
        return values

    def vector(self, element: Element, tag: str, otherwise: ArrayLike) -> Array:
        """Return a child's numbers, or others if there is no such child."""
        values = np.asarray(otherwise, dtype=np.float64)
        return self.numbers(element, tag, values.size) if self.has(element, tag) else values

    def number(self, element: Element, tag: str) -> float:
        """Return a child's single number."""
        return float(self.numbers(element, tag, 1)[0])

    def flag(self, element: Element, tag: str, default: bool) -> bool:
        """Return a child's true or false, or the default if there is no such child."""
        if not self.has(element, tag):
            return default
        text = self.text(element, tag).lower()
        if text not in ('true', 'false'):
            raise OsimFormatError(f'{self.where(element)} <{tag}>: {text!r} is not true or false')
        return text == 'true'

    def function(self, holder: Element) -> PiecewisePolynomial:
        """Return the function that an element holds, directly or inside a <function> element.

        Raises
        ------
        UnsupportedElementError
            If the function is of a type that is not modelled.
        """
        inner = holder.find('function')
        candidates = list(inner) if inner is not None else list(holder)
        known = [child for child in candidates if child.tag in _FUNCTIONS]
        if len(known) == 1:
            return self._function(known[0])
        # Objects have capital letters, properties beside them have not.
        strange = [child.tag for child in candidates if child.tag[:1].isupper()]
        if strange:
            raise UnsupportedElementError(f'{self.where(holder)}: function <{strange[0]}>')
        raise OsimFormatError(f'{self.where(holder)} has no function')

    def _function(self, element: Element) -> PiecewisePolynomial:
        try:
            match _FUNCTIONS[element.tag]:
                case 'constant':
                    return functions.constant(self.number(element, 'value'))
                case 'linear':
                    slope, intercept = self.numbers(element, 'coefficients', 2)
                    return functions.linear(float(slope), float(intercept))
                case 'polynomial':
                    # OpenSim writes the coefficient of the highest power first.
                    return functions.polynomial(self.numbers(element, 'coefficients')[::-1])
                case 'piecewise':
                    return functions.piecewise_linear(
                        self.numbers(element, 'x'), self.numbers(element, 'y')
                    )
                case 'spline':
                    return functions.simm_spline(
                        self.numbers(element, 'x'), self.numbers(element, 'y')
                    )
                case 'step':
                    return functions.smooth_step(
                        *(self.number(element, f'transition_{end}_time') for end in _ENDS),
                        *(self.number(element, f'{end}_value') for end in _ENDS),
                    )
                case _:
                    return self.function(element).scaled(self.number(element, 'scale'))
        except OsimFormatError as error:
            if str(self.path) in str(error):
                raise
            raise OsimFormatError(f'{self.where(element)}: {error}') from error


_ENDS = ('start', 'end')
_FUNCTIONS = {
    'Constant': 'constant',
    'LinearFunction': 'linear',
    'PolynomialFunction': 'polynomial',
    'PiecewiseLinearFunction': 'piecewise',
    'SimmSpline': 'spline',
    'NaturalCubicSpline': 'spline',
    'natCubicSpline': 'spline',
    'StepFunction': 'step',
    'MultiplierFunction': 'multiplier',
}


def body_fixed_xyz(angles: Array) -> Array:
    """Return the rotation matrix of three successive turns about x, the new y and the new z."""
    (cx, cy, cz), (sx, sy, sz) = (
        [math.cos(angle) for angle in angles],
        [math.sin(angle) for angle in angles],
    )
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    product: Array = about_x @ about_y @ about_z
    return product
