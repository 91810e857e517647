# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Message types without ROS: the Jazzy standard types and lifting_interfaces' own .msg files."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from lifting_recordings.exceptions import MessageTypeError

_PACKAGE = 'lifting_interfaces'


def interface_folder() -> Path:
    """Return the folder of lifting_interfaces' .msg files.

    It is in the wheel, beside this package in a checkout, or in the ament index.

    Raises
    ------
    MessageTypeError
        Found in none of them.
    """
    here = Path(__file__).resolve()
    beside = here.parents[2] / _PACKAGE / 'msg'
    for place in (here.with_name('interfaces'), beside):
        if place.is_dir():
            return place
    try:
        from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
    except ModuleNotFoundError as error:
        raise MessageTypeError(f'{_PACKAGE}: {beside} does not exist, no ament index') from error
    try:
        return Path(get_package_share_directory(_PACKAGE)) / 'msg'
    except PackageNotFoundError as error:
        raise MessageTypeError(f'{_PACKAGE} is not installed and not at {beside}') from error


@cache
def typestore() -> Typestore:
    """Return a store with the Jazzy types and ours."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = {}
    folder = interface_folder()
    files = sorted(folder.glob('*.msg'))
    if not files:
        raise MessageTypeError(f'{folder} holds no .msg files')
    for file in files:
        text = file.read_text(encoding='utf-8')
        types.update(get_types_from_msg(text, f'{_PACKAGE}/msg/{file.stem}'))
    store.register(types)
    return store
