# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of lifting_node for colcon and pip."""

from glob import glob

from setuptools import find_packages, setup

package_name = 'lifting_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'': ['py.typed', 'data/**/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/config', glob('config/*.yaml')),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    zip_safe=False,
    maintainer='The lift monitor authors',
    maintainer_email='maintainers@lift-monitor.example',
    description=(
        'What the lifecycle nodes of the lift monitor share: parameters, quality of '
        'service and diagnostics.'
    ),
    license='Apache-2.0',
)
