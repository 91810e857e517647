# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Finds the body behind a socket of an `.osim` file, through any number of offset frames."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np

from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.osim.model import GROUND, Frame
from muscle_analyzer.core.osim.xml import OsimXml, body_fixed_xyz


class FrameResolver:
    """Knows every body and `PhysicalOffsetFrame` of a file by its path.

    Parameters
    ----------
    xml : OsimXml
        The file.
    """

    def __init__(self, xml: OsimXml) -> None:
        self._xml = xml
        self._frames: dict[str, Frame] = {}
        self._offsets: dict[str, tuple[Element, str]] = {}
        self._add_body('/' + GROUND, GROUND)
        ground = xml.model.find('Ground')
        if ground is not None:
            self._add_offsets(ground, '/' + GROUND)
        for body in xml.objects('BodySet'):
            path = f'/bodyset/{xml.name(body)}'
            self._add_body(path, xml.name(body))
            self._add_offsets(body, path)
        for set_tag in ('JointSet', 'ConstraintSet'):
            for element in xml.objects(set_tag):
                path = f'/{set_tag.lower()}/{element.get("name")}'
                for offset in element.findall('frames/PhysicalOffsetFrame'):
                    self._offsets[f'{path}/{xml.name(offset)}'] = (offset, path)

    def _add_body(self, path: str, name: str) -> None:
        self._frames[path] = Frame(name, np.eye(3), np.zeros(3))

    def _add_offsets(self, owner: Element, path: str) -> None:
        for offset in owner.findall('components/PhysicalOffsetFrame'):
            name = self._xml.name(offset)
            self._offsets[f'{path}/{name}'] = (offset, path)
            self._add_offsets(offset, f'{path}/{name}')

    def of_socket(self, element: Element, tag: str) -> Frame:
        """Return the frame that an element's socket names.

        Raises
        ------
        OsimFormatError
            If no such frame exists, or frames refer to each other in a circle.
        """
        owners = (('Joint', '/jointset'), ('Constraint', '/constraintset'))
        owner = ''
        for ending, path in owners:
            if element.tag.endswith(ending):
                owner = f'{path}/{element.get("name")}'
        return self._resolve(self._xml.text(element, tag), owner, element, ())

    def in_owner(self, owner_path: str) -> Frame:
        """Return the frame of a body or offset frame by its absolute path."""
        return self._resolve(owner_path, '', self._xml.model, ())

    def paths(self) -> dict[str, Element | None]:
        """Return every frame's path with its offset frame element (None for bodies)."""
        bodies: dict[str, Element | None] = dict.fromkeys(self._frames)
        return bodies | {path: offset for path, (offset, _) in self._offsets.items()}

    def _resolve(self, socket: str, owner: str, asked_by: Element, seen: tuple[str, ...]) -> Frame:
        # Early files of version 4 have relative paths; the names behind the dots are enough.
        name = socket.replace('../', '').strip('/')
        for path in (socket, f'{owner}/{name}', f'/bodyset/{name}', f'/{name}'):
            if path in seen:
                raise OsimFormatError(f'{self._xml.where(asked_by)}: frames in a circle: {seen}')
            if path in self._frames:
                return self._frames[path]
            if path in self._offsets:
                return self._resolve_offset(path, seen)
        raise OsimFormatError(f'{self._xml.where(asked_by)}: there is no frame {socket!r}')

    def _resolve_offset(self, path: str, seen: tuple[str, ...]) -> Frame:
        offset, owner = self._offsets[path]
        socket = self._xml.text(offset, 'socket_parent')
        if socket == '..':
            base = self._resolve(owner, '', offset, (*seen, path))
        else:
            base = self._resolve(socket, owner, offset, (*seen, path))
        rotation = body_fixed_xyz(self._xml.vector(offset, 'orientation', np.zeros(3)))
        translation = self._xml.vector(offset, 'translation', np.zeros(3))
        return Frame(
            base.body, base.rotation @ rotation, base.translation + base.rotation @ translation
        )
