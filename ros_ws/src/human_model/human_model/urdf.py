# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A skeleton as URDF, for RViz, robot_state_publisher, MoveIt, Pinocchio and simulators.

One link per coordinate, so that a joint of three axes is a chain of revolute joints with links
without mass between them; the last link of a chain carries the segment and has its name. The
joints have the coordinates' names, hence take `joint_states` as it is. The first link is the
laboratory (`WORLD`); the three translations and three rotations of the pelvis follow it as
joints. In the neutral posture the axes of every link are parallel to the laboratory's (REP-103).

Limits of angles are those of the skeleton. Limits of effort are static strengths; where nothing
is published, and for the pelvis, on which no muscle acts from the laboratory, see `joint_effort`.
The shapes are for the eye only.
"""

import math
from collections.abc import Mapping
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from human_model.skeleton import Skeleton
from human_model.skeletons import Skeleton3D
from human_model.strength import JointStrength
from human_model.subject import Subject
from human_model.tree import PRISMATIC
from human_model.typing import Array

#: First link: the laboratory's frame.
WORLD = 'world'

#: URDF asks every joint for a limit of speed, and nothing is published for all joints: no limit
#: but a number that no human joint comes near [rad/s or m/s].
NO_SPEED_LIMIT = 1000.0

#: Density with which a segment's mass becomes the radius of its shape: water's [kg/m^3].
DENSITY = 1000.0

#: Angles at which the static strength of a joint is looked up in its range.
_ANGLES = 91

Effort = Mapping[str, float]


def body_names(skeleton: Skeleton) -> tuple[str, ...]:
    """Return the link of each coordinate: the segment it carries, or ``<coordinate>_link``."""
    tree = skeleton.tree
    names = [f'{coordinate}_link' for coordinate in skeleton.coordinates]
    for segment, body, offset in zip(
        skeleton.segments, tree.segment_body, tree.segment_offset, strict=True
    ):
        if not offset.any():
            names[int(body)] = segment
    return tuple(names)


def fixed_segments(skeleton: Skeleton) -> dict[str, tuple[str, Array]]:
    """Return link and place in it (3,) [m] of each segment that has no joint of its own."""
    bodies, tree = body_names(skeleton), skeleton.tree
    return {
        segment: (bodies[int(body)], offset)
        for segment, body, offset in zip(
            skeleton.segments, tree.segment_body, tree.segment_offset, strict=True
        )
        if offset.any()
    }


def joint_effort(skeleton: Skeleton, strength: JointStrength) -> dict[str, float]:
    """Return the largest static strength of each coordinate over its range [N m].

    The larger of both directions, as URDF has one number. 0 for the coordinates of the free
    pelvis; `strength.LARGE` where no strength is published.
    """
    effort = {}
    for coordinate, (lower, upper) in zip(skeleton.coordinates, skeleton.limits, strict=True):
        effort[coordinate] = 0.0
        if coordinate in strength.coordinates:
            sides = strength.limits(coordinate, np.linspace(lower, upper, _ANGLES), 0.0)
            effort[coordinate] = float(max(np.max(np.abs(side)) for side in sides))
    return effort


def person_urdf(subject: Subject) -> str:
    """Write the 3D skeleton of a person, with the strength of the default coefficients."""
    skeleton = Skeleton3D.of(subject)
    effort = joint_effort(skeleton, JointStrength(skeleton.name, subject))
    return urdf(skeleton, subject.pseudonym, effort)


def urdf(skeleton: Skeleton, name: str, effort: Effort | None = None) -> str:
    """Write a skeleton as URDF.

    Parameters
    ----------
    skeleton : Skeleton
    name : str
        Of the robot in the file: the person's pseudonym.
    effort : mapping, optional
        Largest torque [N m] of each coordinate (`joint_effort`); 0 where it names none.

    Returns
    -------
    str
        XML text.
    """
    tree, bodies = skeleton.tree, body_names(skeleton)
    robot = ElementTree.Element('robot', name=name)
    ElementTree.SubElement(robot, 'link', name=WORLD)
    for body in bodies:
        _link(robot, skeleton, body)
    for j, coordinate in enumerate(skeleton.coordinates):
        parent = int(tree.parent[j])
        joint = _joint(
            robot,
            coordinate,
            'prismatic' if tree.kind[j] == PRISMATIC else 'revolute',
            bodies[parent] if parent >= 0 else WORLD,
            bodies[j],
            tree.offset[j],
        )
        ElementTree.SubElement(joint, 'axis', xyz=_text(tree.axis[j]))
        lower, upper = skeleton.limits[j]
        ElementTree.SubElement(
            joint,
            'limit',
            lower=_text(lower),
            upper=_text(upper),
            effort=_text((effort or {}).get(coordinate, 0.0)),
            velocity=_text(NO_SPEED_LIMIT),
        )
    for segment, (body, offset) in fixed_segments(skeleton).items():
        _link(robot, skeleton, segment)
        _joint(robot, f'{segment}_fixed', 'fixed', body, segment, offset)
    ElementTree.indent(robot)
    return "<?xml version='1.0'?>\n" + ElementTree.tostring(robot, encoding='unicode') + '\n'


def _link(robot: ElementTree.Element, skeleton: Skeleton, name: str) -> None:
    link = ElementTree.SubElement(robot, 'link', name=name)
    if name not in skeleton.segments:
        return
    parameters = skeleton.parameters
    i = parameters.index(name)
    inertial = ElementTree.SubElement(link, 'inertial')
    _origin(inertial, parameters.com[i])
    ElementTree.SubElement(inertial, 'mass', value=_text(parameters.mass[i]))
    tensor = parameters.inertia[i]
    ElementTree.SubElement(
        inertial,
        'inertia',
        {f'i{"xyz"[a]}{"xyz"[b]}': _text(tensor[a, b]) for a in range(3) for b in range(a, 3)},
    )
    ends = _ends(skeleton, name)
    total = sum(float(np.linalg.norm(end)) for end in ends)
    for end in ends:
        radius = math.sqrt(float(parameters.mass[i]) / (math.pi * DENSITY * total))
        _cylinder(link, end, radius)


def _ends(skeleton: Skeleton, segment: str) -> list[Array]:
    """Points (3,) [m] of a segment, in its frame, to which lines from its origin are drawn."""
    tree, i = skeleton.tree, skeleton.segments.index(segment)
    body, origin = int(tree.segment_body[i]), tree.segment_offset[i]
    ends = []
    if not origin.any():
        ends += [tree.offset[j] for j in range(len(tree.parent)) if tree.parent[j] == body]
        ends += [offset for link, offset in fixed_segments(skeleton).values() if link == segment]
    ends += list(skeleton.point_local[skeleton.point_segment == i])
    return [
        np.asarray(end)
        for k, end in enumerate(ends)
        if end.any() and not any(np.allclose(end, other) for other in ends[:k])
    ]


def _cylinder(link: ElementTree.Element, end: Array, radius: float) -> None:
    length = float(np.linalg.norm(end))
    tilt, turn = math.acos(end[2] / length), math.atan2(end[1], end[0])
    visual = ElementTree.SubElement(link, 'visual')
    _origin(visual, end / 2, (0.0, tilt, turn))
    geometry = ElementTree.SubElement(visual, 'geometry')
    ElementTree.SubElement(geometry, 'cylinder', radius=_text(radius), length=_text(length))


def _joint(
    robot: ElementTree.Element, name: str, kind: str, parent: str, child: str, place: Array
) -> ElementTree.Element:
    joint = ElementTree.SubElement(robot, 'joint', name=name, type=kind)
    _origin(joint, place)
    ElementTree.SubElement(joint, 'parent', link=parent)
    ElementTree.SubElement(joint, 'child', link=child)
    return joint


def _origin(
    parent: ElementTree.Element, place: Array, angles: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> None:
    ElementTree.SubElement(parent, 'origin', xyz=_text(place), rpy=_text(angles))


def _text(values: npt.ArrayLike) -> str:
    """Numbers with the digits a double has, without the sign of zero."""
    return ' '.join(repr(float(value) + 0.0) for value in np.ravel(np.asarray(values)))
