# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a musculoskeletal model from an OpenSim 4.x `.osim` file.

What the file says is kept; what would change a result and is not modelled raises an error that
names the element; what is deliberately not part of the model (contact surfaces, actuators,
controllers) is listed in `OsimModel.left_out`.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.functions import constant, linear
from muscle_analyzer.core.osim_frames import FrameResolver
from muscle_analyzer.core.osim_model import (
    Body,
    Coordinate,
    Coupler,
    Joint,
    Marker,
    Muscle,
    OsimModel,
    TransformAxis,
)
from muscle_analyzer.core.osim_muscles import read_muscle, read_wrap_objects
from muscle_analyzer.core.osim_xml import OsimXml

MUSCLE_TYPES = frozenset(
    {'DeGrooteFregly2016Muscle', 'Millard2012EquilibriumMuscle', 'Thelen2003Muscle'}
)
# Contact is measured by force plates here, and actuators only act when somebody drives them.
LEFT_OUT_FORCES = frozenset(
    {
        'SmoothSphereHalfSpaceForce',
        'HuntCrossleyForce',
        'ElasticFoundationForce',
        'CoordinateActuator',
        'ActivationCoordinateActuator',
        'TorqueActuator',
        'PointActuator',
        'PointToPointActuator',
    }
)

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


def read_osim(path: Path | str, leave_out: Collection[str] = ()) -> OsimModel:
    """Read a model.

    Parameters
    ----------
    path : Path or str
        The `.osim` file.
    leave_out : collection of str
        Tags of forces or constraints that may be left out although they would change the result.

    Raises
    ------
    OsimFormatError
        If the file is damaged or a value in it cannot be used.
    UnsupportedElementError
        If an element would change the result and is not modelled.
    """
    xml = OsimXml(Path(path))
    frames = FrameResolver(xml)
    left_out: list[str] = []
    model = OsimModel(
        name=xml.model.get('name', ''),
        source=str(path),
        gravity=xml.numbers(xml.model, 'gravity', 3),
        bodies=tuple(_read_body(xml, element) for element in xml.objects('BodySet')),
        joints=tuple(_read_joint(xml, frames, element) for element in xml.objects('JointSet')),
        couplers=_read_couplers(xml, leave_out, left_out),
        muscles=_read_forces(xml, frames, leave_out, left_out),
        wrap_objects=read_wrap_objects(xml, frames),
        markers=_read_markers(xml, frames),
        left_out=(),
    )
    for set_tag in ('ControllerSet', 'ContactGeometrySet', 'ProbeSet'):
        left_out += [f'{e.tag} {e.get("name")}' for e in xml.objects(set_tag)]
    for element in xml.objects('ComponentSet'):
        _leave_out_or_raise(xml, element, leave_out, left_out)
    _check_names(model)
    return OsimModel(**{**vars(model), 'left_out': tuple(left_out)})


def _leave_out_or_raise(
    xml: OsimXml, element: Element, leave_out: Collection[str], left_out: list[str]
) -> None:
    if element.tag not in leave_out:
        raise UnsupportedElementError(f'{xml.where(element)} is not modelled')
    left_out.append(f'{element.tag} {element.get("name")}')


def _read_body(xml: OsimXml, element: Element) -> Body:
    mass = xml.number(element, 'mass')
    xx, yy, zz, xy, xz, yz = xml.numbers(element, 'inertia', 6)
    if mass < 0.0:
        raise OsimFormatError(f'{xml.where(element)} <mass>: {mass} is negative')
    return Body(
        name=xml.name(element),
        mass=mass,
        mass_center=xml.numbers(element, 'mass_center', 3),
        inertia=np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
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
        default_value=xml.number(element, 'default_value'),
        range=(float(low), float(high)),
        clamped=xml.flag(element, 'clamped', False),
        locked=xml.flag(element, 'locked', False),
    )


def _read_joint(xml: OsimXml, frames: FrameResolver, element: Element) -> Joint:
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


def _read_couplers(
    xml: OsimXml, leave_out: Collection[str], left_out: list[str]
) -> tuple[Coupler, ...]:
    couplers = []
    for element in xml.objects('ConstraintSet'):
        if not xml.flag(element, 'isEnforced', True):
            left_out.append(f'{element.tag} {element.get("name")}')
            continue
        if element.tag != 'CoordinateCouplerConstraint':
            _leave_out_or_raise(xml, element, leave_out, left_out)
            continue
        independent = xml.text(element, 'independent_coordinate_names').split()
        if len(independent) != 1:
            raise UnsupportedElementError(f'{xml.where(element)}: a function of {independent}')
        holder = element.find('coupled_coordinates_function')
        if holder is None:
            raise OsimFormatError(f'{xml.where(element)} has no <coupled_coordinates_function>')
        # OpenSim's scale_factor multiplies the function.
        has_scale = element.find('scale_factor') is not None
        scale = xml.number(element, 'scale_factor') if has_scale else 1.0
        couplers.append(
            Coupler(
                name=xml.name(element),
                dependent=xml.text(element, 'dependent_coordinate_name'),
                independent=independent[0],
                function=xml.function(holder).scaled(scale),
            )
        )
    return tuple(couplers)


def _read_forces(
    xml: OsimXml, frames: FrameResolver, leave_out: Collection[str], left_out: list[str]
) -> tuple[Muscle, ...]:
    muscles = []
    for element in xml.objects('ForceSet'):
        if not xml.flag(element, 'appliesForce', True) or element.tag in LEFT_OUT_FORCES:
            left_out.append(f'{element.tag} {element.get("name")}')
        elif element.tag in MUSCLE_TYPES:
            muscles.append(read_muscle(xml, frames, element))
        else:
            _leave_out_or_raise(xml, element, leave_out, left_out)
    return tuple(muscles)


def _read_markers(xml: OsimXml, frames: FrameResolver) -> tuple[Marker, ...]:
    markers = []
    for element in xml.objects('MarkerSet'):
        frame = frames.of_socket(element, 'socket_parent_frame')
        location = frame.translation + frame.rotation @ xml.numbers(element, 'location', 3)
        markers.append(Marker(xml.name(element), frame.body, location))
    return tuple(markers)


def _check_names(model: OsimModel) -> None:
    """Raise OsimFormatError for names used twice and for couplers of unknown coordinates."""
    coordinates = [c.name for joint in model.joints for c in joint.coordinates]
    for what, names in (
        ('body', [body.name for body in model.bodies]),
        ('joint', [joint.name for joint in model.joints]),
        ('coordinate', coordinates),
        ('muscle', [muscle.name for muscle in model.muscles]),
        ('wrap object', [wrap.name for wrap in model.wrap_objects]),
    ):
        if twice := {name for name in names if names.count(name) > 1}:
            raise OsimFormatError(f'{model.source}: {what} {sorted(twice)[0]!r} is there twice')
    for coupler in model.couplers:
        for name in (coupler.dependent, coupler.independent):
            if name not in coordinates:
                raise OsimFormatError(
                    f'{model.source}: coupler {coupler.name!r}: no coordinate {name!r}'
                )


