# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of lifting for colcon and pip."""

from setuptools import find_packages, setup

package_name = 'lifting'

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
    description='Track, predict, analyze and assess lifts in a few lines of Python, without ROS.',
    license='Apache-2.0',
)
