# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The process environment without what a sourced ROS 2 installation adds to it.

As a script, run a command in that environment: ``clean_environment.py COMMAND [ARGUMENT ...]``.
"""

from __future__ import annotations

import os
import sys

# What /opt/ros/<distro>/setup.bash and colcon's setup files set. A domain id or a discovery
# range is the user's choice of network and stays.
ROS_VARIABLES = (
    'AMENT_CURRENT_PREFIX',
    'AMENT_PREFIX_PATH',
    'CMAKE_PREFIX_PATH',
    'COLCON_PREFIX_PATH',
    'PYTHONHOME',
    'PYTHONPATH',
    'RMW_IMPLEMENTATION',
    'ROS_DISTRO',
    'ROS_PACKAGE_PATH',
    'ROS_PYTHON_VERSION',
    'ROS_VERSION',
    '_ROS_WHEELS_BOOTSTRAP_COMPLETE',
)
SEARCH_PATHS = ('LD_LIBRARY_PATH', 'PATH', 'PKG_CONFIG_PATH')


def clean_environment(environment: dict[str, str] | None = None) -> dict[str, str]:
    """Return a copy of the environment in which only our own ROS wheels are found.

    Parameters
    ----------
    environment : dict of str, optional
        Default: that of this process.

    Returns
    -------
    dict of str
        Without ``ROS_VARIABLES``, and with the entries of the
        search paths that lie in one of the sourced prefixes taken out.
    """
    source = dict(os.environ if environment is None else environment)
    prefixes = [
        prefix.rstrip('/')
        for name in ('AMENT_PREFIX_PATH', 'COLCON_PREFIX_PATH')
        for prefix in source.get(name, '').split(os.pathsep)
        if prefix
    ]
    cleaned = {key: value for key, value in source.items() if key not in ROS_VARIABLES}
    for name in SEARCH_PATHS:
        if name not in cleaned:
            continue
        kept = [
            entry
            for entry in cleaned[name].split(os.pathsep)
            if entry and not any(f'{entry}/'.startswith(f'{prefix}/') for prefix in prefixes)
        ]
        cleaned[name] = os.pathsep.join(kept)
        if not kept:
            del cleaned[name]
    return cleaned


if __name__ == '__main__':
    os.execvpe(sys.argv[1], sys.argv[1:], clean_environment())
