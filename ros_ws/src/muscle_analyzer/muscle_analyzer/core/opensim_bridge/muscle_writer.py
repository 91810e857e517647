# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscles, their paths and the surfaces that they wrap over as elements of an `.osim` file."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

from muscle_analyzer.core.opensim_bridge.xml_functions import function_element, xyz_angles
from muscle_analyzer.core.opensim_bridge.xml_tree import (
    add_flag,
    add_numbers,
    add_set,
    add_text,
    body_path,
    named,
)
from muscle_analyzer.core.osim.model import Muscle, PathPoint, PathWrap, WrapObject

#: Element and dimension tags of the surfaces.
_WRAPS: dict[str, tuple[str, tuple[str, ...]]] = {
    'cylinder': ('WrapCylinder', ('radius', 'length')),
    'sphere': ('WrapSphere', ('radius',)),
    'torus': ('WrapTorus', ('inner_radius', 'outer_radius')),
    'ellipsoid': ('WrapEllipsoid', ('dimensions',)),
}
_POINTS = {
    'fixed': 'PathPoint',
    'conditional': 'ConditionalPathPoint',
    'moving': 'MovingPathPoint',
}
#: OpenSim's names of properties of muscles that are true or false begin so.
_FLAG = 'ignore_'


def muscle_element(muscle: Muscle, joint_of: Mapping[str, str]) -> Element:
    """Return a muscle.

    Parameters
    ----------
    muscle : Muscle
    joint_of : mapping of str to str
        Name of the joint of each coordinate.
    """
    element = named(muscle.kind, muscle.name)
    add_flag(element, 'appliesForce', True)
    path = SubElement(element, 'GeometryPath', name='geometrypath')
    add_set(path, 'PathPointSet', [_point(point, joint_of) for point in muscle.points])
    add_set(path, 'PathWrapSet', [_path_wrap(wrap, k) for k, wrap in enumerate(muscle.wraps)])
    add_numbers(element, 'max_isometric_force', muscle.max_isometric_force)
    add_numbers(element, 'optimal_fiber_length', muscle.optimal_fiber_length)
    add_numbers(element, 'tendon_slack_length', muscle.tendon_slack_length)
    add_numbers(element, 'pennation_angle_at_optimal', muscle.pennation_angle)
    curves: dict[str, Element] = {}
    for name, value in muscle.properties.items():
        curve, _, part = name.rpartition('/')
        if curve and curve not in curves:
            curves[curve] = SubElement(element, curve, name=f'{muscle.name}_{curve}')
        if name.startswith(_FLAG):
            add_flag(element, name, bool(value))
        else:
            add_numbers(curves.get(curve, element), part, value)
    return element


def _point(point: PathPoint, joint_of: Mapping[str, str]) -> Element:
    element = named(_POINTS[point.kind], point.name)
    add_text(element, 'socket_parent_frame', body_path(point.body))
    if point.kind == 'moving':
        for axis, function, coordinate in zip(
            'xyz', point.location_functions, point.location_coordinates, strict=True
        ):
            add_text(element, f'socket_{axis}_coordinate', _coordinate_path(coordinate, joint_of))
            SubElement(element, f'{axis}_location').append(function_element(function))
        return element
    add_numbers(element, 'location', point.location)
    if point.kind == 'conditional':
        assert point.coordinate is not None
        assert point.range is not None
        add_text(element, 'socket_coordinate', _coordinate_path(point.coordinate, joint_of))
        add_numbers(element, 'range', point.range)
    return element


def _coordinate_path(coordinate: str, joint_of: Mapping[str, str]) -> str:
    return f'/jointset/{joint_of[coordinate]}/{coordinate}'


def _path_wrap(wrap: PathWrap, number: int) -> Element:
    element = named('PathWrap', f'pathwrap_{number}')
    add_text(element, 'wrap_object', wrap.wrap_object)
    add_text(element, 'method', wrap.method)
    add_text(element, 'range', ' '.join(str(index) for index in wrap.range))
    return element


def wrap_object_element(wrap: WrapObject) -> Element:
    """Return a surface, in the frame of its body."""
    tag, dimensions = _WRAPS[wrap.kind]
    element = named(tag, wrap.name)
    add_flag(element, 'active', wrap.active)
    add_numbers(element, 'xyz_body_rotation', xyz_angles(wrap.frame.rotation))
    add_numbers(element, 'translation', wrap.frame.translation)
    add_text(element, 'quadrant', wrap.quadrant)
    if len(dimensions) == 1:
        add_numbers(element, dimensions[0], wrap.dimensions)
    else:
        for name, value in zip(dimensions, wrap.dimensions, strict=True):
            add_numbers(element, name, value)
    return element
