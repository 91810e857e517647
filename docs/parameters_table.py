# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write docs/parameters.md from the tables that the nodes declare their parameters from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

DOCS = Path(__file__).parent
SOURCES = DOCS.parent / 'ros_ws' / 'src'
HEADER = """<!-- SPDX-FileCopyrightText: 2026 The lift monitor authors -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<!-- Written by docs/parameters_table.py: do not edit. -->
# Parameters of the nodes

Read when a node starts (`ros2 run ... --ros-args -p name:=value`, or `config/<node>.yaml`)
and not changed after that. A value of the wrong type, out of range or not among the choices
ends the node with a message that names it.
"""


def tables() -> dict[str, dict[str, dict[str, Any]]]:
    """Return parameters by node and name."""
    paths = sorted(SOURCES.glob('*/*/data/parameters.yaml'))
    return {path.parts[-3]: yaml.safe_load(path.read_text(encoding='utf-8')) for path in paths}


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if value == '':
        return 'empty'
    return f'{value:g}' if isinstance(value, float) else str(value)


def _allowed(entry: dict[str, Any]) -> str:
    if entry.get('choices'):
        return ', '.join(entry['choices'])
    if 'minimum' in entry:
        return f'{_shown(entry["minimum"])} to {_shown(entry["maximum"])}'
    return 'true, false' if isinstance(entry['default'], bool) else ''


def page() -> str:
    """Return the page."""
    parts = [HEADER]
    for node, table in tables().items():
        parts += [f'## {node}\n', '| name | meaning | unit | default | allowed |']
        parts.append('|---' * 5 + '|')
        parts += [
            f'| `{name}` | {entry["description"]} | {entry["unit"]} | {_shown(entry["default"])} '
            f'| {_allowed(entry)} |'
            for name, entry in table.items()
        ]
        parts.append('')
    return '\n'.join(parts)


if __name__ == '__main__':
    (DOCS / 'parameters.md').write_text(page(), encoding='utf-8')
