# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Rewrites a model element of OpenSim 3 (file version 30000) in the terms of OpenSim 4.

OpenSim 3 keeps a joint inside the body that it carries, gives offsets as locations and
orientations in two bodies, and refers to bodies and coordinates by name. OpenSim 4 has a set of
joints, offset frames, and sockets. Nothing else that is read here differs.
"""

from __future__ import annotations

from collections.abc import Callable
from xml.etree.ElementTree import Element, SubElement

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError

Where = Callable[[Element], str]

_INERTIA = ('xx', 'yy', 'zz', 'xy', 'xz', 'yz')
#: Names of bodies and coordinates that became sockets, as tag of version 3 and of version 4.
_BODY_SOCKETS = {
    'PathPoint': (('body', 'socket_parent_frame'),),
    'ConditionalPathPoint': (('body', 'socket_parent_frame'),),
    'MovingPathPoint': (('body', 'socket_parent_frame'),),
    'Marker': (('body', 'socket_parent_frame'),),
    'WeldConstraint': (('body_1', 'socket_frame1'), ('body_2', 'socket_frame2')),
}
_COORDINATE_SOCKETS = {
    'ConditionalPathPoint': (('coordinate', 'socket_coordinate'),),
    'MovingPathPoint': tuple((f'{a}_coordinate', f'socket_{a}_coordinate') for a in 'xyz'),
}
_SWITCHES = (('ForceSet', 'appliesForce'), ('ConstraintSet', 'isEnforced'))


def upgrade_model(model: Element, where: Where) -> None:
    """Rewrite a <Model> of version 30000 in place.

    Parameters
    ----------
    model : Element
    where : callable
        Names an element for messages.

    Raises
    ------
    OsimFormatError
        If a body has no joint.
    UnsupportedElementError
        If a joint is reversed.
    """
    bodies = model.find('BodySet/objects')
    if bodies is None:
        raise OsimFormatError(f'{where(model)} has no <BodySet>')
    joints = SubElement(SubElement(model, 'JointSet'), 'objects')
    for body in list(bodies):
        if body.get('name') == 'ground':
            bodies.remove(body)
            body.tag = 'Ground'
            model.append(body)
            continue
        _add(body, 'inertia', ' '.join(body.findtext(f'inertia_{ij}', '0') for ij in _INERTIA))
        joint = body.find('Joint/*')
        if joint is None:
            raise OsimFormatError(f'{where(body)} has no <Joint>')
        _upgrade_joint(joint, body.get('name', ''), where)
        joints.append(joint)
    for element in model.iter():
        for old, new in _BODY_SOCKETS.get(element.tag, ()):
            _add(element, new, _body_path(element.findtext(old)))
        for old, new in _COORDINATE_SOCKETS.get(element.tag, ()):
            _add(element, new, element.findtext(old))
    for set_tag, switch in _SWITCHES:
        for element in model.findall(f'{set_tag}/objects/*'):
            disabled = element.find('isDisabled')
            if disabled is not None:
                element.remove(disabled)
                off = (disabled.text or '').strip().lower() == 'true'
                _add(element, switch, 'false' if off else 'true')


def _upgrade_joint(joint: Element, child: str, where: Where) -> None:
    if joint.findtext('reverse', 'false').strip().lower() == 'true':
        raise UnsupportedElementError(f'{where(joint)} <reverse>: a reversed joint')
    parent = (joint.findtext('parent_body') or '').strip()
    frames = SubElement(joint, 'frames')
    for role, body, location, orientation in (
        ('parent', parent, 'location_in_parent', 'orientation_in_parent'),
        ('child', child, 'location', 'orientation'),
    ):
        name = f'{role}_offset'
        _add(joint, f'socket_{role}_frame', name)
        frame = SubElement(frames, 'PhysicalOffsetFrame', name=name)
        _add(frame, 'socket_parent', _body_path(body))
        _add(frame, 'translation', joint.findtext(location))
        _add(frame, 'orientation', joint.findtext(orientation))
    coordinates = joint.find('CoordinateSet/objects')
    if coordinates is not None:
        SubElement(joint, 'coordinates').extend(coordinates)


def _body_path(name: str | None) -> str | None:
    if name is None:
        return None
    return '/ground' if name.strip() == 'ground' else f'/bodyset/{name.strip()}'


def _add(element: Element, tag: str, text: str | None) -> None:
    """Append a child with text; nothing if there is no text to give it."""
    if text is not None:
        SubElement(element, tag).text = text
