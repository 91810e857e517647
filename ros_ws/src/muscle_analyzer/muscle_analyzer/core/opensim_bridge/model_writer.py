# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a model as an `.osim` file, so that OpenSim computes with the very same model.

Everything that `osim.reader` reads is written: bodies, joints with their functions, couplers,
wrap objects, muscles, markers. What it leaves out (contact, actuators) is not in the file.
Offset frames are merged into the joints' two frames, path points and surfaces are in their body's
own frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from muscle_analyzer.core.exceptions import ModelWriteError
from muscle_analyzer.core.opensim_bridge.meshes import Mesh, add_meshes
from muscle_analyzer.core.opensim_bridge.muscle_writer import muscle_element, wrap_object_element
from muscle_analyzer.core.opensim_bridge.xml_functions import function_element, xyz_angles
from muscle_analyzer.core.opensim_bridge.xml_tree import (
    add_flag,
    add_numbers,
    add_set,
    add_text,
    body_path,
    named,
    write_document,
)
from muscle_analyzer.core.osim.model import (
    GROUND,
    Body,
    Coordinate,
    Coupler,
    Frame,
    Joint,
    Marker,
    OsimModel,
    TransformAxis,
)

_WELD = 'WeldJoint'
#: Two axes of a joint's rotations are one if the sine between them is smaller; OpenSim refuses
#: such a joint.
_COLLINEAR = 1e-3


def write_osim(path: Path, model: OsimModel, meshes: Sequence[Mesh] = ()) -> None:
    """Write a model.

    Parameters
    ----------
    path : Path
    model : OsimModel
    meshes : sequence of Mesh
        For the eye.

    Raises
    ------
    ModelWriteError
        If a function or a joint cannot be written.
    """
    root = named('Model', model.name or 'model')
    root.append(_ground(model))
    add_numbers(root, 'gravity', model.gravity)
    add_text(root, 'length_units', 'meters')
    add_text(root, 'force_units', 'N')
    add_set(root, 'BodySet', [_body(model, body, meshes) for body in model.bodies])
    add_set(root, 'JointSet', [_joint(joint) for joint in model.joints])
    add_set(root, 'ConstraintSet', [_coupler(coupler) for coupler in model.couplers])
    joint_of = {c.name: joint.name for joint in model.joints for c in joint.coordinates}
    add_set(root, 'ForceSet', [muscle_element(muscle, joint_of) for muscle in model.muscles])
    add_set(root, 'MarkerSet', [_marker(marker) for marker in model.markers])
    write_document(path, root)


def _ground(model: OsimModel) -> Element:
    element = named('Ground', GROUND)
    _add_wraps(element, model, GROUND)
    return element


def _add_wraps(element: Element, model: OsimModel, body: str) -> None:
    wraps = [wrap for wrap in model.wrap_objects if wrap.frame.body == body]
    add_set(element, 'WrapObjectSet', [wrap_object_element(wrap) for wrap in wraps])


def _body(model: OsimModel, body: Body, meshes: Sequence[Mesh]) -> Element:
    element = named('Body', body.name)
    add_meshes(element, tuple(mesh for mesh in meshes if mesh.frame.body == body.name))
    _add_wraps(element, model, body.name)
    add_numbers(element, 'mass', body.mass)
    add_numbers(element, 'mass_center', body.mass_center)
    i = body.inertia
    add_numbers(element, 'inertia', [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]])
    return element


def _joint(joint: Joint) -> Element:
    """Write a joint; all but the weld as `CustomJoint`, of which every type is a case."""
    element = named(_WELD if not joint.coordinates else 'CustomJoint', joint.name)
    add_text(element, 'socket_parent_frame', f'{joint.parent.body}_parent_offset')
    add_text(element, 'socket_child_frame', f'{joint.child.body}_child_offset')
    coordinates = SubElement(element, 'coordinates')
    coordinates.extend(_coordinate(coordinate) for coordinate in joint.coordinates)
    frames = SubElement(element, 'frames')
    frames.append(_offset(f'{joint.parent.body}_parent_offset', joint.parent))
    frames.append(_offset(f'{joint.child.body}_child_offset', joint.child))
    moving = (*joint.rotations, *joint.translations)
    if joint.coordinates:
        transform = SubElement(element, 'SpatialTransform')
        for number, axis in enumerate(_spread(joint), 1):
            transform.append(_axis(f'rotation{number}', axis))
        for number, axis in enumerate(joint.translations, 1):
            transform.append(_axis(f'translation{number}', axis))
    elif any(axis.function.derivatives(0.0)[0] for axis in moving):
        raise ModelWriteError(f'joint {joint.name!r}: a fixed joint with a turn or shift in it')
    return element


def _spread(joint: Joint) -> list[TransformAxis]:
    """Return the rotations with the axes of those that never turn moved off the others'."""
    used = list(joint.rotations)
    for k, axis in enumerate(used):
        if not axis.function.is_constant() or axis.function.derivatives(0.0)[0] != 0.0:
            continue
        others = [other.axis for i, other in enumerate(used) if i != k]
        free = max(
            np.eye(3),
            key=lambda e: min(float(np.linalg.norm(np.cross(e, other))) for other in others),
        )
        used[k] = TransformAxis(free, None, axis.function)
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if np.linalg.norm(np.cross(used[i].axis, used[j].axis)) < _COLLINEAR:
            raise ModelWriteError(f'joint {joint.name!r}: two of its rotations have one axis')
    return used


def _axis(name: str, axis: TransformAxis) -> Element:
    element = named('TransformAxis', name)
    add_text(element, 'coordinates', axis.coordinate or '')
    add_numbers(element, 'axis', axis.axis)
    element.append(function_element(axis.function, 'function'))
    return element


def _coordinate(coordinate: Coordinate) -> Element:
    element = named('Coordinate', coordinate.name)
    add_numbers(element, 'default_value', coordinate.default_value)
    if np.all(np.isfinite(coordinate.range)):
        add_numbers(element, 'range', coordinate.range)
    add_flag(element, 'clamped', coordinate.clamped)
    add_flag(element, 'locked', coordinate.locked)
    return element


def _offset(name: str, frame: Frame) -> Element:
    element = named('PhysicalOffsetFrame', name)
    add_text(element, 'socket_parent', body_path(frame.body))
    add_numbers(element, 'translation', frame.translation)
    add_numbers(element, 'orientation', xyz_angles(frame.rotation))
    return element


def _coupler(coupler: Coupler) -> Element:
    element = named('CoordinateCouplerConstraint', coupler.name)
    add_flag(element, 'isEnforced', True)
    holder = SubElement(element, 'coupled_coordinates_function')
    holder.append(function_element(coupler.function))
    add_text(element, 'independent_coordinate_names', coupler.independent)
    add_text(element, 'dependent_coordinate_name', coupler.dependent)
    add_numbers(element, 'scale_factor', 1.0)
    return element


def _marker(marker: Marker) -> Element:
    element = named('Marker', marker.name)
    add_text(element, 'socket_parent_frame', body_path(marker.body))
    add_numbers(element, 'location', marker.location)
    return element
