# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packages of the wheel: each Python package of ros_ws/src, and the message definitions.

Everything else is in pyproject.toml.
"""

import tempfile
from pathlib import Path

from setuptools import find_packages, setup

SOURCES = Path('ros_ws', 'src')
#: Package of the wheel that holds the .msg files, which bags are written with.
DEFINITIONS = 'lifting_messages.msg'

folders = {path.parent.name: str(path.parent) for path in SOURCES.glob('*/*/__init__.py')}
packages = [
    name
    for top, folder in sorted(folders.items())
    for name in (top, *(f'{top}.{inner}' for inner in find_packages(folder)))
]
with tempfile.TemporaryDirectory() as build:
    setup(
        packages=[*packages, DEFINITIONS],
        package_dir={**folders, DEFINITIONS: str(SOURCES / 'lifting_interfaces' / 'msg')},
        # A build folder in the checkout would keep modules that have been renamed since.
        options={'build': {'build_base': build}},
    )
