# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift urdf`: a person of a file becomes a URDF with that person's mass."""

from xml.etree import ElementTree

import pytest
import yaml

from lifting_cli.cli import main

PERSON = {'pseudonym': 'S04', 'sex': 'female', 'mass': 62.6, 'stature': 1.68, 'age': 31}


def written(tmp_path, **changes):
    path = tmp_path / 'person.yaml'
    path.write_text(yaml.safe_dump({'subject': PERSON | changes, 'task': {'left': 'alone'}}))
    return path


def test_a_persons_file(tmp_path):
    output = tmp_path / 'person.urdf'
    assert main(['urdf', str(written(tmp_path)), '-o', str(output)]) == 0
    robot = ElementTree.parse(output).getroot()
    assert robot.get('name') == 'S04'
    masses = [float(mass.get('value')) for mass in robot.iter('mass')]
    assert sum(masses) == pytest.approx(62.6, rel=1e-12)
    moving = [joint for joint in robot.findall('joint') if joint.get('type') != 'fixed']
    assert len(moving) == 40


def test_the_file_is_named_after_the_pseudonym(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(['urdf', str(written(tmp_path))]) == 0
    assert (tmp_path / 'S04.urdf').exists()


def test_bad_input_is_named(tmp_path, capsys):
    assert main(['urdf', str(written(tmp_path, mass=6260))]) == 1
    assert 'subject.mass: 6260 kg is outside' in capsys.readouterr().err
    assert main(['urdf', str(written(tmp_path)), '-o', str(tmp_path / 'no' / 'p.urdf')]) == 1
    assert 'cannot be written' in capsys.readouterr().err
