# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Serialised messages are read and written in one place: `lifting_messages.message_types`."""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).parents[1]

#: The codec, and modules that have bytes of other kinds: files, IPOPT's arrays, a cache.
OF_BYTES = {
    'ros_ws/src/lift_predictor/lift_predictor/core/solvers/ipopt.py',
    'ros_ws/src/lifting_messages/lifting_messages/message_types.py',
    'ros_ws/src/lifting_recordings/lifting_recordings/c3d_files.py',
    'ros_ws/src/lifting_recordings/lifting_recordings/mcap_recovery.py',
    'ros_ws/src/muscle_analyzer/muscle_analyzer/core/osim/model_cache.py',
}
#: Names by which Python takes numbers out of bytes or puts them in.
WAYS = {'struct', 'frombuffer', 'from_bytes', 'to_bytes', 'serialize_message', 'cdr'}


def ways(path: Path) -> set[str]:
    """Return the ways of reading or writing bytes that a module uses."""
    used = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import | ast.ImportFrom):
            used |= {alias.name for alias in node.names}
        elif isinstance(node, ast.Attribute):
            used.add(node.attr)
    return used & WAYS


def test_no_other_module_takes_numbers_out_of_bytes() -> None:
    modules = [
        *ROOT.glob('ros_ws/src/*/*/**/*.py'),
        *ROOT.glob('benchmarks/*.py'),
        *ROOT.glob('bags/simulate/*.py'),
    ]
    found = {
        str(path.relative_to(ROOT)): ways(path) for path in modules if 'test' not in path.parts
    }
    assert len(found) > 300
    assert {name for name, used in found.items() if used} <= OF_BYTES


def test_the_codec_is_found_by_the_test_above() -> None:
    """The search sees what it searches for."""
    assert {name for name in OF_BYTES if ways(ROOT / name)} == OF_BYTES
