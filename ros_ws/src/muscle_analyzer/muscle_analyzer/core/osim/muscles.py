# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads muscles, their paths and the surfaces that they wrap over from an `.osim` file."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.frames import FrameResolver
from muscle_analyzer.core.osim.model import Frame, Muscle, PathPoint, PathWrap, WrapObject
from muscle_analyzer.core.osim.xml import OsimXml, body_fixed_xyz

_POINT_KINDS = {
    'PathPoint': 'fixed',
    'ConditionalPathPoint': 'conditional',
    'MovingPathPoint': 'moving',
}
_WRAP_KINDS: dict[str, tuple[str, tuple[tuple[str, int], ...]]] = {
    'WrapCylinder': ('cylinder', (('radius', 1), ('length', 1))),
    'WrapSphere': ('sphere', (('radius', 1),)),
    'WrapEllipsoid': ('ellipsoid', (('dimensions', 3),)),
    'WrapTorus': ('torus', (('inner_radius', 1), ('outer_radius', 1))),
}
_OWN_FIELDS = frozenset(
    {
        'max_isometric_force',
        'optimal_fiber_length',
        'tendon_slack_length',
        'pennation_angle_at_optimal',
        'appliesForce',
    }
)


def read_muscle(xml: OsimXml, frames: FrameResolver, element: Element) -> Muscle:
    """Read one muscle element with its path.

    Raises
    ------
    OsimFormatError
        If a parameter is missing or not positive, or the path has fewer than two points.
    UnsupportedElementError
        If the path has points of a type that is not modelled.
    """
    path = element.find('GeometryPath')
    if path is None:
        raise UnsupportedElementError(f'{xml.where(element)}: path is no <GeometryPath>')
    points = tuple(_read_point(xml, frames, p) for p in xml.objects('PathPointSet', path))
    if len(points) < 2:
        raise OsimFormatError(f'{xml.where(element)}: path of {len(points)} point(s)')
    positive = {}
    for tag in ('max_isometric_force', 'optimal_fiber_length', 'tendon_slack_length'):
        positive[tag] = xml.number(element, tag)
        if positive[tag] <= 0.0:
            raise OsimFormatError(f'{xml.where(element)} <{tag}>: {positive[tag]} is not positive')
    return Muscle(
        name=xml.name(element),
        kind=element.tag,
        pennation_angle=float(xml.vector(element, 'pennation_angle_at_optimal', [0.0])[0]),
        points=points,
        wraps=tuple(_read_path_wrap(xml, w) for w in xml.objects('PathWrapSet', path)),
        properties=_read_properties(xml, element),
        **positive,
    )


def _read_properties(xml: OsimXml, element: Element) -> dict[str, float]:
    """Return the simple numerical and true/false children that are not fields of their own.

    Those of a curve (Millard's muscle has some) are named 'curve/property'.
    """
    properties: dict[str, float] = {}
    for child in xml.children(element):
        if child.tag.endswith('Curve'):
            # A muscle's own curve replaces the one of the file's defaults as a whole.
            for name in [name for name in properties if name.startswith(f'{child.tag}/')]:
                del properties[name]
            properties |= {
                f'{child.tag}/{part.tag}': value
                for part in child
                if (value := _simple_value(part)) is not None
            }
        elif child.tag not in _OWN_FIELDS and (value := _simple_value(child)) is not None:
            properties[child.tag] = value
    return properties


def _simple_value(element: Element) -> float | None:
    """Return a number, 1 or 0 for true or false, None for anything else."""
    text = (element.text or '').strip()
    if text in ('true', 'false'):
        return float(text == 'true')
    try:
        return None if len(element) else float(text)
    except ValueError:
        return None  # text properties (descriptions) carry nothing that is computed with


def _read_point(xml: OsimXml, frames: FrameResolver, element: Element) -> PathPoint:
    if element.tag not in _POINT_KINDS:
        raise UnsupportedElementError(f'{xml.where(element)}: this path point is not modelled')
    kind = _POINT_KINDS[element.tag]
    frame = frames.of_socket(element, 'socket_parent_frame')
    name = xml.name(element)
    if kind == 'moving':
        return _read_moving_point(xml, frame, element, name)
    location = frame.translation + frame.rotation @ xml.numbers(element, 'location', 3)
    if kind == 'fixed':
        return PathPoint(name, kind, frame.body, location)
    low, high = xml.numbers(element, 'range', 2)
    coordinate = xml.text(element, 'socket_coordinate').rsplit('/', 1)[-1]
    return PathPoint(name, kind, frame.body, location, coordinate, (float(low), float(high)))


def _read_moving_point(xml: OsimXml, frame: Frame, element: Element, name: str) -> PathPoint:
    if not np.array_equal(frame.rotation, np.eye(3)):
        raise UnsupportedElementError(f'{xml.where(element)}: a moving point in a turned frame')
    functions = []
    coordinates = []
    for axis, offset in zip('xyz', frame.translation, strict=True):
        holder = element.find(f'{axis}_location')
        if holder is None:
            raise OsimFormatError(f'{xml.where(element)} has no <{axis}_location>')
        functions.append(xml.function(holder).shifted(float(offset)))
        socket = xml.text(element, f'socket_{axis}_coordinate')
        coordinates.append(socket.rsplit('/', 1)[-1])
    location = np.array([function.derivatives(0.0)[0] for function in functions])
    return PathPoint(
        name,
        'moving',
        frame.body,
        location,
        location_functions=tuple(functions),
        location_coordinates=tuple(coordinates),
    )


def _read_path_wrap(xml: OsimXml, element: Element) -> PathWrap:
    first, last = xml.vector(element, 'range', (-1.0, -1.0))
    method = xml.text(element, 'method').lower() if xml.has(element, 'method') else 'hybrid'
    return PathWrap(xml.text(element, 'wrap_object'), method, (int(first), int(last)))


def read_wrap_objects(
    xml: OsimXml, frames: FrameResolver, left_out: list[str]
) -> tuple[WrapObject, ...]:
    """Read the wrap objects of every body and offset frame.

    Paths refer to them by name alone; of several with one name, OpenSim and this reader know the
    first, and the others are left out.

    Raises
    ------
    UnsupportedElementError
        If a surface is of a type that is not modelled.
    OsimFormatError
        If a dimension is not positive.
    """
    owners = {'/ground': xml.model.find('Ground')}
    owners |= {f'/bodyset/{xml.name(body)}': body for body in xml.objects('BodySet')}
    owners |= {path: element for path, element in frames.paths().items() if element is not None}
    found: dict[str, WrapObject] = {}
    for path, owner in owners.items():
        for element in xml.objects('WrapObjectSet', owner) if owner is not None else ():
            surface = _read_wrap_object(xml, frames.in_owner(path), element)
            if found.setdefault(surface.name, surface) is not surface:
                left_out.append(f'{element.tag} {surface.name} of {path}')
    return tuple(found.values())


def _read_wrap_object(xml: OsimXml, owner: Frame, element: Element) -> WrapObject:
    if element.tag not in _WRAP_KINDS:
        raise UnsupportedElementError(f'{xml.where(element)}: this wrap object is not modelled')
    kind, fields = _WRAP_KINDS[element.tag]
    dimensions = np.concatenate([xml.numbers(element, tag, count) for tag, count in fields])
    if np.any(dimensions <= 0.0):
        raise OsimFormatError(f'{xml.where(element)}: dimensions {dimensions} are not positive')
    rotation = body_fixed_xyz(xml.vector(element, 'xyz_body_rotation', np.zeros(3)))
    translation = xml.vector(element, 'translation', np.zeros(3))
    if kind == 'torus' and dimensions[1] <= dimensions[0]:
        raise OsimFormatError(f'{xml.where(element)}: inner and outer radius {dimensions}')
    quadrant = xml.text(element, 'quadrant') if xml.has(element, 'quadrant') else 'all'
    return WrapObject(
        name=xml.name(element),
        kind=kind,
        frame=Frame(
            owner.body, owner.rotation @ rotation, owner.translation + owner.rotation @ translation
        ),
        active=xml.flag(element, 'active', True),
        quadrant=quadrant.lower().removeprefix('+'),
        dimensions=tuple(float(value) for value in dimensions),
    )
