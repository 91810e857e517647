# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The hand-computed example of lifting_interfaces/README.md, and the same through the code."""

import math
from pathlib import Path

import numpy as np
import pytest

from human_model.frames import to_opensim
from muscle_analyzer.core.loads.disc_frame import (
    DiscOption,
    disc_load,
    disc_parameters,
    disc_rotation,
)

README = Path(__file__).parents[1] / 'ros_ws/src/lifting_interfaces/README.md'

#: The example: mass above L5-S1 [kg], its distance in front of the joint [m], lever arm of the
#: one muscle [m], forward lean of the disc normal [deg].
MASS, FRONT, LEVER, LEAN = 50.0, 0.30, 0.05, 60.0
GRAVITY = 9.80665
WEIGHT = MASS * GRAVITY
MUSCLE = WEIGHT * FRONT / LEVER


def by_hand():
    """Compression and anterior shear [N] by trigonometry alone."""
    lean = math.radians(LEAN)
    return WEIGHT * math.cos(lean) + MUSCLE, WEIGHT * math.sin(lean)


def turned_forward(degrees):
    """Axes leant forward: turned about REP-103's y, which points to the left (columns x, y, z)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def opensim_axes(rotation):
    """OpenSim's body axes (forward, up, right) of a body turned like this, in OpenSim's ground."""
    forward, left, up = rotation.T
    return np.column_stack([to_opensim(axis) for axis in (forward, up, -left)])


def through_the_code(sideways=0.0):
    """Load of the disc by the muscle analyzer; the weight may be carried to the left [N]."""
    vertebra_lean = LEAN - disc_parameters(DiscOption.BRUNO2015)['forward_tilt']
    vertebra = opensim_axes(turned_forward(vertebra_lean))
    normal = turned_forward(LEAN)[:, 2]
    weight = np.array([0.0, sideways, -WEIGHT])
    reaction = -(weight - MUSCLE * normal)
    six = np.concatenate([np.zeros(3), to_opensim(reaction)])
    return disc_load(six, disc_rotation(DiscOption.BRUNO2015, vertebra, np.eye(3), 0.0))


def test_example_through_the_code_equals_the_example_by_hand():
    compression, shear = by_hand()
    load = through_the_code()
    assert load.compression == pytest.approx(compression)
    assert load.anterior_shear == pytest.approx(shear)
    assert load.lateral_shear == pytest.approx(0.0, abs=1e-9)
    assert load.force == pytest.approx([-shear, 0.0, compression], abs=1e-9)


def test_upper_body_pushed_to_the_left_gives_lateral_force_to_the_right():
    """S1 holds L5 back: what pushes the upper body to the left is met by a force to the right."""
    assert through_the_code(sideways=80.0).lateral_shear == pytest.approx(-80.0)


def test_numbers_printed_in_the_readme():
    text = README.read_text(encoding='utf-8')
    compression, shear = by_hand()
    load = through_the_code()
    printed = (
        f'{WEIGHT:.0f} N', f'{MUSCLE:.0f} N', f'**{compression:.0f} N**', f'**{shear:.0f} N**',
        f'{load.compression_per_degree:.1f} N', f'{load.shear_per_degree:+.1f} N',
    )  # fmt: skip
    assert [number for number in printed if number not in text.replace('−', '-')] == []
