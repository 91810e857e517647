# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The L5-S1 disc frame: hand-computed loads, published angles, sensitivities."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muscle_analyzer.core.exceptions import InputArrayError, OptionError
from muscle_analyzer.core.loads.disc_frame import (
    DEFAULT_OPTION,
    DiscOption,
    disc_load,
    disc_option,
    disc_rotation,
    disc_setting,
    sacral_angle,
)

UPRIGHT = np.eye(3)


def leant(degrees):
    """Return axes that lean forward: turned about OpenSim's axis to the right, negative."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def test_signs_by_hand():
    """S1 pushes L5 up with 2000 N, back with 300 N and to the left with 50 N (OpenSim z right)."""
    reaction = np.array([1.0, 2.0, 3.0, -300.0, 2000.0, -50.0])
    load = disc_load(reaction, disc_rotation(DiscOption.VERTEBRAL, UPRIGHT, UPRIGHT, 0.0))
    assert load.compression == pytest.approx(2000.0)
    assert load.anterior_shear == pytest.approx(300.0)
    assert load.lateral_shear == pytest.approx(50.0)
    assert load.moment == pytest.approx([1.0, -3.0, 2.0])


def test_bruno_frame_by_hand():
    """2000 N straight up on a disc that leans 21 deg forward."""
    reaction = np.array([0.0, 0.0, 0.0, 0.0, 2000.0, 0.0])
    load = disc_load(reaction, disc_rotation(DiscOption.BRUNO2015, UPRIGHT, UPRIGHT, 0.0))
    assert load.compression == pytest.approx(2000.0 * math.cos(math.radians(21.0)))
    assert load.anterior_shear == pytest.approx(2000.0 * math.sin(math.radians(21.0)))
    assert load.lateral_shear == pytest.approx(0.0)


@pytest.mark.parametrize(
    ('trunk', 'knee', 'expected'), [(0.0, 180.0, 38.9), (90.0, 180.0, 88.0), (45.0, 90.0, 46.4)]
)
def test_published_sacral_angles(trunk, knee, expected):
    """Facts 4.11: beta of -1.1, 48 and 6.4 degrees."""
    regression = disc_setting(DiscOption.CHAFFIN).regression
    assert sacral_angle(regression, trunk, knee) == pytest.approx(expected, abs=0.1)


def test_chaffin_frame_is_level_sideways_and_leans_by_the_sacral_angle():
    rotation = disc_rotation(DiscOption.CHAFFIN, leant(20.0), leant(45.0), math.pi / 2.0)
    regression = disc_setting(DiscOption.CHAFFIN).regression
    alpha = math.radians(sacral_angle(regression, 45.0, 90.0))
    expected = np.array([math.sin(alpha), math.cos(alpha), 0.0])
    np.testing.assert_allclose(rotation[:, 2], expected, atol=1e-12)
    np.testing.assert_allclose(rotation[:, 1], [0.0, 0.0, -1.0], atol=1e-12)


@pytest.mark.parametrize('option', list(DiscOption))
def test_frames_are_right_handed_and_follow_the_vertebra(option):
    rotation = disc_rotation(option, leant(30.0), leant(40.0), 0.5)
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@given(st.lists(st.floats(-3000.0, 3000.0), min_size=6, max_size=6), st.floats(-40.0, 60.0))
def test_sensitivities_are_derivatives(reaction, lean):
    def load(angle):
        return disc_load(
            np.array(reaction), disc_rotation(DiscOption.VERTEBRAL, leant(angle), UPRIGHT, 0.0)
        )

    step = 1e-3
    after, before = load(lean + step), load(lean - step)
    compression = (after.compression - before.compression) / (2.0 * step)
    shear = (after.anterior_shear - before.anterior_shear) / (2.0 * step)
    assert load(lean).compression_per_degree == pytest.approx(compression, abs=1e-4)
    assert load(lean).shear_per_degree == pytest.approx(shear, abs=1e-4)


def test_ten_degrees_move_430_newtons():
    """Facts 4.11: 434 N of shear at 2500 N of compression."""
    reaction = np.array([0.0, 0.0, 0.0, 0.0, 2500.0, 0.0])
    load = disc_load(reaction, disc_rotation(DiscOption.VERTEBRAL, UPRIGHT, UPRIGHT, 0.0))
    assert 10.0 * load.shear_per_degree == pytest.approx(434.0, abs=3.0)


def test_options_and_bad_input_are_named():
    assert disc_option('bruno2015') is DEFAULT_OPTION
    with pytest.raises(OptionError, match=r"'tilted'.*bruno2015, chaffin, vertebral"):
        disc_option('tilted')
    with pytest.raises(InputArrayError, match='nan'):
        disc_load(np.full(6, np.nan), UPRIGHT)
