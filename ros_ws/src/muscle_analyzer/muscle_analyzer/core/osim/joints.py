# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads joints: each as three successive rotations and three translations.

`CustomJoint` is that already; the joints of fixed type are cases of it. The coordinates of
`BallJoint` and `FreeJoint` are angles of successive turns about x, y and z here, and their rates
the rates of these angles; OpenSim takes the components of the angular velocity for their speeds.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.frames import FrameResolver
from muscle_analyzer.core.osim.functions import constant, linear
from muscle_analyzer.core.osim.model import Coordinate, Joint, TransformAxis
from muscle_analyzer.core.osim.xml import OsimXml

# Joint types as (coordinate number, 'r' or 't', axis) in the order in which they act.
_SIMPLE_JOINTS: dict[str, tuple[tuple[int, str, int], ...]] = {
    'WeldJoint': (),
    'PinJoint': ((0, 'r', 2),),
    'SliderJoint': ((0, 't', 0),),
    'UniversalJoint': ((0, 'r', 0), (1, 'r', 1)),
    'BallJoint': ((0, 'r', 0), (1, 'r', 1), (2, 'r', 2)),
    'GimbalJoint': ((0, 'r', 0), (1, 'r', 1), (2, 'r', 2)),
    'PlanarJoint': ((0, 'r', 2), (1, 't', 0), (2, 't', 1)),
    'FreeJoint': (
        (0, 'r', 0), (1, 'r', 1), (2, 'r', 2), (3, 't', 0), (4, 't', 1), (5, 't', 2),
    ),
}  # fmt: skip


def read_joint(xml: OsimXml, frames: FrameResolver, element: Element) -> Joint:
    """Read one joint.

    Raises
    ------
    OsimFormatError
        If coordinates, axes or functions do not fit together.
    UnsupportedElementError
        If the joint is of a type that is not modelled, or a coordinate's motion is prescribed.
    """
    coordinates = tuple(_read_coordinate(xml, child) for child in element.findall('coordinates/*'))
    if element.tag == 'CustomJoint':
        axes = _read_spatial_transform(xml, element, {c.name for c in coordinates})
    elif element.tag in _SIMPLE_JOINTS:
        axes = _simple_axes(xml, element, [c.name for c in coordinates])
    else:
        raise UnsupportedElementError(f'{xml.where(element)}: this joint type is not modelled')
    return Joint(
        name=xml.name(element),
        kind=element.tag,
        parent=frames.of_socket(element, 'socket_parent_frame'),
        child=frames.of_socket(element, 'socket_child_frame'),
        coordinates=coordinates,
        rotations=(axes[0], axes[1], axes[2]),
        translations=(axes[3], axes[4], axes[5]),
    )


def _read_coordinate(xml: OsimXml, element: Element) -> Coordinate:
    if xml.flag(element, 'prescribed', False):
        raise UnsupportedElementError(f'{xml.where(element)} is prescribed')
    has_range = element.find('range') is not None
    low, high = xml.numbers(element, 'range', 2) if has_range else (-np.inf, np.inf)
    if low > high:
        raise OsimFormatError(f'{xml.where(element)} <range>: {low} > {high}')
    return Coordinate(
        name=xml.name(element),
        default_value=float(xml.vector(element, 'default_value', [0.0])[0]),
        range=(float(low), float(high)),
        clamped=xml.flag(element, 'clamped', False),
        locked=xml.flag(element, 'locked', False),
    )


def _simple_axes(xml: OsimXml, element: Element, names: list[str]) -> list[TransformAxis]:
    """Write a joint of fixed type as three rotations and three translations."""
    moves = _SIMPLE_JOINTS[element.tag]
    if len(names) != len(moves):
        raise OsimFormatError(f'{xml.where(element)} has coordinates {names}, want {len(moves)}')
    axes = np.eye(3)
    rotations = [TransformAxis(axes[i], None, constant(0.0)) for i in range(3)]
    translations = list(rotations)
    done = 0
    for number, kind, axis in moves:
        moved = TransformAxis(axes[axis], names[number], linear(1.0, 0.0))
        if kind == 'r':
            rotations[done] = moved
            done += 1
        else:
            translations[axis] = moved
    return rotations + translations


def _read_spatial_transform(xml: OsimXml, joint: Element, names: set[str]) -> list[TransformAxis]:
    transform = joint.find('SpatialTransform')
    if transform is None:
        raise OsimFormatError(f'{xml.where(joint)} has no <SpatialTransform>')
    by_name = {axis.get('name'): axis for axis in transform.findall('TransformAxis')}
    wanted = [f'{kind}{i}' for kind in ('rotation', 'translation') for i in (1, 2, 3)]
    if missing := [name for name in wanted if name not in by_name]:
        raise OsimFormatError(f'{xml.where(joint)} <SpatialTransform> has no {missing[0]}')
    return [_read_axis(xml, joint, by_name[name], names) for name in wanted]


def _read_axis(xml: OsimXml, joint: Element, element: Element, names: set[str]) -> TransformAxis:
    axis = xml.numbers(element, 'axis', 3)
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise OsimFormatError(f'{xml.where(joint)} {element.get("name")}: axis of length 0')
    moved_by = (element.findtext('coordinates') or '').split()
    if len(moved_by) > 1:
        raise UnsupportedElementError(
            f'{xml.where(joint)} {element.get("name")}: a function of {len(moved_by)} coordinates'
        )
    function = xml.function(element)
    if moved_by and moved_by[0] not in names:
        raise OsimFormatError(f'{xml.where(joint)} has no coordinate {moved_by[0]!r}')
    if not moved_by and not function.is_constant():
        raise OsimFormatError(
            f'{xml.where(joint)} {element.get("name")}: function of no coordinate'
        )
    return TransformAxis(axis / length, moved_by[0] if moved_by else None, function)
