# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The bones of a model for OpenSim's window: names of mesh files, for seeing only.

The files themselves come with OpenSim. Nothing is computed with them here or there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.opensim_bridge.xml_functions import xyz_angles
from muscle_analyzer.core.opensim_bridge.xml_tree import add_numbers, add_text
from muscle_analyzer.core.osim.frames import FrameResolver
from muscle_analyzer.core.osim.model import GROUND, Frame
from muscle_analyzer.core.osim.xml import OsimXml


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh fixed to a body.

    Attributes
    ----------
    name, file : str
    frame : Frame
        Its frame in the body.
    scale : (3,) array
        Along the frame's axes.
    """

    name: str
    file: str
    frame: Frame
    scale: Array


def read_meshes(path: Path) -> tuple[Mesh, ...]:
    """Read the meshes of a model's bodies and of frames fixed to them.

    Parameters
    ----------
    path : Path
        `.osim` file.

    Raises
    ------
    OsimFormatError
        If the file is damaged.
    """
    xml = OsimXml(path)
    frames = FrameResolver(xml)
    owners: dict[str, Element | None] = {
        f'/bodyset/{xml.name(body)}': body for body in xml.objects('BodySet')
    }
    owners |= {place: offset for place, offset in frames.paths().items() if offset is not None}
    found: list[Mesh] = []
    for place, owner in owners.items():
        frame = frames.in_owner(place)
        if owner is None or frame.body == GROUND:
            continue
        for element in owner.findall('attached_geometry/Mesh'):
            scaled = element.find('scale_factors') is not None
            scale = xml.numbers(element, 'scale_factors', 3) if scaled else np.ones(3)
            found.append(Mesh(f'mesh_{len(found)}', xml.text(element, 'mesh_file'), frame, scale))
    return tuple(found)


def scaled_meshes(meshes: tuple[Mesh, ...], factors: Mapping[str, Array]) -> tuple[Mesh, ...]:
    """Return meshes stretched with their bodies.

    Parameters
    ----------
    meshes : tuple of Mesh
    factors : mapping of str to (3,) array
        Per body, along its axes.
    """
    found = []
    for mesh in meshes:
        factor, frame = factors[mesh.frame.body], mesh.frame
        along = np.linalg.norm(factor[:, None] * frame.rotation, axis=0)
        moved = replace(frame, translation=frame.translation * factor)
        found.append(replace(mesh, frame=moved, scale=mesh.scale * along))
    return tuple(found)


def add_meshes(body: Element, meshes: tuple[Mesh, ...]) -> None:
    """Append meshes to a body's element, each in an offset frame of its own."""
    if not meshes:
        return
    components = SubElement(body, 'components')
    for mesh in meshes:
        offset = SubElement(components, 'PhysicalOffsetFrame', name=f'{mesh.name}_frame')
        geometry = SubElement(offset, 'attached_geometry')
        element = SubElement(geometry, 'Mesh', name=mesh.name)
        add_text(element, 'socket_frame', '..')
        add_numbers(element, 'scale_factors', mesh.scale)
        add_text(element, 'mesh_file', mesh.file)
        add_text(offset, 'socket_parent', '..')
        add_numbers(offset, 'translation', mesh.frame.translation)
        add_numbers(offset, 'orientation', xyz_angles(mesh.frame.rotation))
