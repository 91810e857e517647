# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of lifting_cli for colcon and pip."""

from setuptools import find_packages, setup

package_name = 'lifting_cli'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'': ['py.typed', 'data/**/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    zip_safe=False,
    maintainer='The lift monitor authors',
    maintainer_email='maintainers@lift-monitor.example',
    description=(
        'The lift command: predict, study, import, play, record, run, report and compare; '
        'the graph as processes or in one process.'
    ),
    license='Apache-2.0',
    entry_points={'console_scripts': ['lift = lifting_cli.cli:main']},
)
