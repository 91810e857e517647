# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of muscle_analyzer for colcon and pip."""

from glob import glob

from setuptools import find_packages, setup

package_name = 'muscle_analyzer'

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
        'Muscle forces by static optimisation and L5-S1 joint reactions of measured and '
        'predicted lifts.'
    ),
    license='Apache-2.0',
    entry_points={
        'console_scripts': ['muscle_analyzer_node = muscle_analyzer.muscle_analyzer_node:main']
    },
)
