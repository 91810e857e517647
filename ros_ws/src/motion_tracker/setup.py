# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging for colcon and pip, the same file in every package.

The metadata are in package.xml, the entry points in setup.cfg.
"""

from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

#: Wheels whose names differ from the rosdep key without `python3-` and `-pip`.
WHEELS = {'yaml': 'pyyaml'}

manifest = ElementTree.parse('package.xml').getroot()
name = manifest.findtext('name')
maintainer = manifest.find('maintainer')
# Packages of ROS and of this workspace come from the workspace: PyPI does not have them.
keys = [element.text for element in manifest.findall('exec_depend')]
wheels = [
    key.removeprefix('python3-').removesuffix('-pip') for key in keys if key.startswith('python3-')
]
extras = {}
for element in manifest.findall('export/pip'):  # without a rosdep key
    extras.setdefault(element.get('extra', ''), []).append(element.text)

setup(
    name=name,
    version=manifest.findtext('version'),
    description=manifest.findtext('description'),
    maintainer=maintainer.text,
    maintainer_email=maintainer.get('email'),
    license=manifest.findtext('license'),
    packages=find_packages(exclude=['test']),
    package_data={'': ['py.typed', 'data/**/*', 'templates/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{name}']),
        (f'share/{name}', ['package.xml']),
        (f'share/{name}/config', glob('config/*.*')),
        (f'share/{name}/launch', glob('launch/*.launch.py')),
    ],
    install_requires=[WHEELS.get(wheel, wheel) for wheel in wheels] + extras.pop('', []),
    extras_require=extras,
    zip_safe=False,
)
