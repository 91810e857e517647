# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads constraints: couplers of coordinates, and welds that hold already.

A weld that closes a loop of bodies would need forces inside the loop and is not modelled. Knee
models with two contact compartments weld bodies that other welds and locked coordinates join
rigidly already; such a weld changes no motion, and is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from xml.etree.ElementTree import Element

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.frames import FrameResolver
from muscle_analyzer.core.osim.model import GROUND, Coupler, Joint
from muscle_analyzer.core.osim.xml import OsimXml

LeaveOut = Callable[[Element], None]


def read_couplers(
    xml: OsimXml,
    frames: FrameResolver,
    joints: Sequence[Joint],
    left_out: list[str],
    leave_out_or_raise: LeaveOut,
) -> tuple[Coupler, ...]:
    """Read the couplers of a model and go through its other constraints.

    Parameters
    ----------
    xml : OsimXml
    frames : FrameResolver
    joints : sequence of Joint
        The model's.
    left_out : list of str
        Gets the constraints that are switched off or hold anyway.
    leave_out_or_raise : callable
        Called with every constraint that is not modelled.

    Raises
    ------
    OsimFormatError
        If a coupler has no function.
    UnsupportedElementError
        If a coupler's function is of several coordinates.
    """
    couplers = []
    for element in xml.objects('ConstraintSet'):
        if not xml.flag(element, 'isEnforced', True):
            left_out.append(f'{element.tag} {element.get("name")}')
        elif element.tag == 'CoordinateCouplerConstraint':
            couplers.append(_read_coupler(xml, element))
        elif element.tag == 'WeldConstraint' and _holds_already(frames, joints, element):
            left_out.append(f'{element.tag} {element.get("name")}')
        else:
            leave_out_or_raise(element)
    return tuple(couplers)


def _read_coupler(xml: OsimXml, element: Element) -> Coupler:
    independent = xml.text(element, 'independent_coordinate_names').split()
    if len(independent) != 1:
        raise UnsupportedElementError(f'{xml.where(element)}: a function of {independent}')
    holder = element.find('coupled_coordinates_function')
    if holder is None:
        raise OsimFormatError(f'{xml.where(element)} has no <coupled_coordinates_function>')
    # OpenSim's scale_factor multiplies the function.
    scale = float(xml.vector(element, 'scale_factor', [1.0])[0])
    return Coupler(
        name=xml.name(element),
        dependent=xml.text(element, 'dependent_coordinate_name'),
        independent=independent[0],
        function=xml.function(holder).scaled(scale),
    )


def _holds_already(frames: FrameResolver, joints: Sequence[Joint], weld: Element) -> bool:
    """Tell whether no coordinate moves the two bodies of a weld against each other."""
    carrier = {joint.child.body: joint for joint in joints}
    ways = []
    for side in ('socket_frame1', 'socket_frame2'):
        way: dict[str, Joint] = {}
        body = frames.of_socket(weld, side).body
        while body != GROUND and body in carrier and body not in way:
            way[body] = carrier[body]
            body = carrier[body].parent.body
        ways.append(way)
    between = ways[0].keys() ^ ways[1].keys()
    return all(c.locked for body in between for c in carrier[body].coordinates)
