# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Who may import whom (docs/architecture.md)."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

SOURCES = Path(__file__).resolve().parents[1] / 'ros_ws' / 'src'
MAY_IMPORT = {
    'human_model': set(),
    'lifting_messages': {'human_model'},
    'lifting_node': {'human_model', 'lifting_messages'},
    'motion_tracker': {'human_model', 'lifting_messages', 'lifting_node'},
    'lift_predictor': {'human_model', 'lifting_messages', 'lifting_node'},
    'muscle_analyzer': {'human_model', 'lifting_messages', 'lifting_node'},
    'injury_monitor': {'human_model', 'lifting_messages', 'lifting_node'},
    'lifting_visualization': {'human_model', 'lifting_messages', 'lifting_node'},
    'lifting_recordings': {'human_model', 'lifting_messages', 'motion_tracker', 'muscle_analyzer'},
    'lifting_report': {
        'human_model',
        'lifting_messages',
        'lifting_node',
        'lifting_recordings',
        'lift_predictor',
        'muscle_analyzer',
        'injury_monitor',
    },
}
ROS = {'rclpy', 'lifting_interfaces', 'lifting_node', 'launch', 'launch_ros'}


def imported(path: Path) -> set[str]:
    """Return the top-level modules a file imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            found |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module.split('.')[0])
    return found


@pytest.mark.parametrize('package', MAY_IMPORT)
def test_a_room_imports_only_what_it_may(package: str) -> None:
    files = list((SOURCES / package / package).rglob('*.py'))
    assert files
    own = {*MAY_IMPORT, 'lifting_cli'} - {package}
    for path in files:
        wrong = imported(path) & own - MAY_IMPORT[package]
        assert not wrong, f'{path.relative_to(SOURCES)} imports {sorted(wrong)}'


@pytest.mark.parametrize(
    'folder',
    [
        'human_model/human_model',
        'lifting_messages/lifting_messages',
        'lifting_recordings/lifting_recordings',
        *(f'{p}/{p}/core' for p in MAY_IMPORT if (SOURCES / p / p / 'core').is_dir()),
    ],
)
def test_cores_know_no_ros(folder: str) -> None:
    files = list((SOURCES / folder).rglob('*.py'))
    assert files
    for path in files:
        wrong = {name for name in imported(path) if name in ROS or name.endswith('_msgs')}
        assert not wrong, f'{path.relative_to(SOURCES)} imports {sorted(wrong)}'
