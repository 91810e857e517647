# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What an `.osim` file says, as plain data: bodies, joints, couplers, muscles, markers.

Everything is in OpenSim's own axes (x forward, y up, z right), SI units and radians. Positions of
path points, wrap objects and markers are already in the axes of the body that carries them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

from human_model.typing import Array
from muscle_analyzer.core.exceptions import UnknownNameError
from muscle_analyzer.core.osim.functions import PiecewisePolynomial

GROUND = 'ground'


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame fixed to a body: rotation (3, 3) body <- frame and translation (3,) in the body."""

    body: str
    rotation: Array
    translation: Array


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body.

    Attributes
    ----------
    mass : float
        In kg.
    mass_center : (3,) array
        In m, in the body's axes.
    inertia : (3, 3) array
        About the mass centre, in the body's axes, in kg m^2.
    """

    name: str
    mass: float
    mass_center: Array
    inertia: Array


@dataclass(frozen=True)
class Coordinate:
    """A joint coordinate; range in rad or m, `locked` means that it stays at its default value."""

    name: str
    default_value: float
    range: tuple[float, float]
    clamped: bool
    locked: bool


@dataclass(frozen=True, eq=False)
class TransformAxis:
    """One of a joint's three rotations or three translations.

    Attributes
    ----------
    axis : (3,) array
        Unit vector in the joint's frame as turned by the rotations before this one; translations
        are along axes of the joint's frame on the parent.
    coordinate : str or None
        The coordinate that moves it; None if the function is constant.
    function : PiecewisePolynomial
        Angle in rad or distance in m as a function of the coordinate.
    """

    axis: Array
    coordinate: str | None
    function: PiecewisePolynomial


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between a frame on the parent and a frame on the child.

    The child's frame is moved by three translations and then three successive rotations, as in
    OpenSim's `CustomJoint`; every other joint type is written as a case of it.
    """

    name: str
    kind: str
    parent: Frame
    child: Frame
    coordinates: tuple[Coordinate, ...]
    rotations: tuple[TransformAxis, TransformAxis, TransformAxis]
    translations: tuple[TransformAxis, TransformAxis, TransformAxis]


@dataclass(frozen=True, eq=False)
class Coupler:
    """A coordinate given as a function of another (`CoordinateCouplerConstraint`)."""

    name: str
    dependent: str
    independent: str
    function: PiecewisePolynomial


@dataclass(frozen=True, eq=False)
class PathPoint:
    """A point of a muscle's path.

    Attributes
    ----------
    kind : str
        'fixed', 'conditional' (there only while `coordinate` is within `range`), or 'moving' (its
        location is three functions of `location_coordinates`).
    location : (3,) array
        In m, in the body's axes; of a moving point where its coordinates are zero.
    """

    name: str
    kind: str
    body: str
    location: Array
    coordinate: str | None = None
    range: tuple[float, float] | None = None
    location_functions: tuple[PiecewisePolynomial, ...] = ()
    location_coordinates: tuple[str, ...] = ()


@dataclass(frozen=True)
class PathWrap:
    """Use of a wrap object by a path; `range` counts path points from 1, -1 is no limit."""

    wrap_object: str
    method: str
    range: tuple[int, int]


@dataclass(frozen=True, eq=False)
class WrapObject:
    """A surface that paths wrap over.

    Attributes
    ----------
    kind : str
        'cylinder' (axis along z), 'sphere', 'ellipsoid' or 'torus' (axis along z).
    frame : Frame
        The surface's frame in its body.
    quadrant : str
        'all', or the half of the surface that may be used: 'x', '-x', 'y', '-y', 'z', '-z'.
    dimensions : tuple of float
        In m: cylinder radius, length; sphere radius; ellipsoid three half axes; torus inner and
        outer radius.
    """

    name: str
    kind: str
    frame: Frame
    active: bool
    quadrant: str
    dimensions: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Muscle:
    """A muscle with its path.

    Attributes
    ----------
    kind : str
        The element's name, e.g. 'DeGrooteFregly2016Muscle'.
    max_isometric_force : float
        In N.
    optimal_fiber_length, tendon_slack_length : float
        In m.
    pennation_angle : float
        At optimal fibre length, in rad.
    properties : mapping
        Every other numerical or true/false property that the file gives, by its name (true is 1);
        'curve/property' for those of a muscle's own curves.
    """

    name: str
    kind: str
    max_isometric_force: float
    optimal_fiber_length: float
    tendon_slack_length: float
    pennation_angle: float
    points: tuple[PathPoint, ...]
    wraps: tuple[PathWrap, ...]
    properties: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Marker:
    """A named point fixed to a body, location (3,) in the body's axes in m."""

    name: str
    body: str
    location: Array


@dataclass(frozen=True, eq=False)
class OsimModel:
    """A whole model.

    Attributes
    ----------
    source : str
        The file it was read from.
    left_out : tuple of str
        Elements of the file that are deliberately not part of the model ('tag name'): contact,
        actuators, controllers, what is switched off, and what the caller let go.
    """

    name: str
    source: str
    gravity: Array
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    couplers: tuple[Coupler, ...]
    muscles: tuple[Muscle, ...]
    wrap_objects: tuple[WrapObject, ...]
    markers: tuple[Marker, ...]
    left_out: tuple[str, ...]

    @property
    def mass(self) -> float:
        """Return the sum of the bodies' masses in kg."""
        return sum(body.mass for body in self.bodies)

    def body(self, name: str) -> Body:
        """Return the body of that name, or raise UnknownNameError."""
        return _by_name(self.bodies, name, 'body', self.source)

    def joint(self, name: str) -> Joint:
        """Return the joint of that name, or raise UnknownNameError."""
        return _by_name(self.joints, name, 'joint', self.source)

    def wrap_object(self, name: str) -> WrapObject:
        """Return the wrap object of that name, or raise UnknownNameError."""
        return _by_name(self.wrap_objects, name, 'wrap object', self.source)


Named = TypeVar('Named', Body, Joint, WrapObject)


def _by_name(items: tuple[Named, ...], name: str, what: str, source: str) -> Named:
    for item in items:
        if item.name == name:
            return item
    raise UnknownNameError(f'{source}: there is no {what} {name!r}')
