# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Elements of OpenSim's XML documents, with numbers in full precision."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np

from muscle_analyzer.core.osim.model import GROUND
from muscle_analyzer.core.osim.xml import OLDEST_VERSION


def document(content: Element) -> ElementTree:
    """Return a document of format 4 round an element."""
    root = Element('OpenSimDocument', Version=str(OLDEST_VERSION))
    root.append(content)
    return ElementTree(root)


def write_document(path: Path, content: Element) -> None:
    """Write an element as a document of format 4."""
    tree = document(content)
    indent(tree, '  ')
    tree.write(path, encoding='UTF-8', xml_declaration=True)


def named(tag: str, name: str) -> Element:
    """Return an element with a name."""
    return Element(tag, name=name)


def add_text(parent: Element, tag: str, text: str) -> None:
    """Append a child that holds text."""
    SubElement(parent, tag).text = text


def add_flag(parent: Element, tag: str, value: bool) -> None:
    """Append a child that holds true or false."""
    add_text(parent, tag, 'true' if value else 'false')


def add_numbers(parent: Element, tag: str, values: Iterable[float] | float) -> None:
    """Append a child that holds one number or several."""
    flat = np.atleast_1d(np.asarray(values, np.float64))
    add_text(parent, tag, ' '.join(f'{value:.17g}' for value in flat))


def add_set(parent: Element, tag: str, elements: Iterable[Element]) -> None:
    """Append one of OpenSim's sets: a child with `objects`."""
    SubElement(SubElement(parent, tag, name=tag.lower()), 'objects').extend(elements)


def body_path(body: str) -> str:
    """Return the path of a body, or of the ground, in a written model."""
    return f'/{GROUND}' if body == GROUND else f'/bodyset/{body}'
