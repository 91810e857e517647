# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a musculoskeletal model from an `.osim` file of OpenSim 4.x or 3.0 to 3.3.

What the file says is kept; where it says nothing about a place, an angle or a default value,
OpenSim's own default holds, which is zero. What would change a result and is not modelled raises
an error that names the element; what is deliberately not part of the model (contact surfaces,
actuators, controllers) is listed in `OsimModel.left_out`.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.constraints import read_couplers
from muscle_analyzer.core.osim.frames import FrameResolver
from muscle_analyzer.core.osim.joints import read_joint
from muscle_analyzer.core.osim.model import Body, Marker, Muscle, OsimModel
from muscle_analyzer.core.osim.muscles import read_muscle, read_wrap_objects
from muscle_analyzer.core.osim.xml import OsimXml

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
    return model_from(OsimXml(Path(path)), leave_out)


def model_from(xml: OsimXml, leave_out: Collection[str] = ()) -> OsimModel:
    """Make the model of a parsed file; parameters and errors as `read_osim`."""
    frames = FrameResolver(xml)
    left_out: list[str] = []

    def let_go(element: Element) -> None:
        _leave_out_or_raise(xml, element, leave_out, left_out)

    joints = tuple(read_joint(xml, frames, element) for element in xml.objects('JointSet'))
    model = OsimModel(
        name=xml.model.get('name', ''),
        source=str(xml.path),
        gravity=xml.numbers(xml.model, 'gravity', 3),
        bodies=tuple(_read_body(xml, element) for element in xml.objects('BodySet')),
        joints=joints,
        couplers=read_couplers(xml, frames, joints, left_out, let_go),
        muscles=_read_forces(xml, frames, leave_out, left_out),
        wrap_objects=read_wrap_objects(xml, frames, left_out),
        markers=_read_markers(xml, frames),
        left_out=(),
    )
    for set_tag in ('ControllerSet', 'ContactGeometrySet', 'ProbeSet'):
        left_out += [f'{e.tag} {e.get("name")}' for e in xml.objects(set_tag)]
    for element in xml.objects('ComponentSet'):
        let_go(element)
    _check_names(model)
    return replace(model, left_out=tuple(left_out))


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
        mass_center=xml.vector(element, 'mass_center', np.zeros(3)),
        inertia=np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
    )


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
    ):
        if twice := {name for name in names if names.count(name) > 1}:
            raise OsimFormatError(f'{model.source}: {what} {sorted(twice)[0]!r} is there twice')
    for coupler in model.couplers:
        for name in (coupler.dependent, coupler.independent):
            if name not in coordinates:
                raise OsimFormatError(
                    f'{model.source}: coupler {coupler.name!r}: no coordinate {name!r}'
                )
