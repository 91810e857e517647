# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Centre of pressure, free moment, thresholds and the check of the body mass."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motion_tracker.core.exceptions import ForcePlateError
from motion_tracker.core.forces.force_plates import (
    PlateGeometry,
    ground_reaction,
    total_centre_of_pressure,
)

shear = st.floats(-100.0, 100.0)
place = st.floats(-0.5, 0.5)


def plate(turn=0.0, height=0.05):
    c, s = np.cos(turn), np.sin(turn)
    # Turned about the vertical and upside down, as plates with z downward are.
    rotation = np.array([[c, s, 0.0], [s, -c, 0.0], [0.0, 0.0, -1.0]])
    return PlateGeometry('plate', np.array([0.3, -0.2, height - 0.04]), rotation, height)


# The first example may have to compile.
@settings(max_examples=60, deadline=None)
@given(
    x=place,
    y=place,
    fx=shear,
    fy=shear,
    fz=st.floats(50.0, 2000.0),
    tz=st.floats(-20.0, 20.0),
    turn=st.floats(-3.0, 3.0),
)
def test_a_known_force_at_a_known_place_is_found_again(x, y, fx, fy, fz, tz, turn):
    geometry = plate(turn)
    at, force = np.array([x, y, 0.05]), np.array([fx, fy, fz])
    moment = np.cross(at - geometry.origin, force) + [0.0, 0.0, tz]
    foot = ground_reaction(force @ geometry.rotation, moment @ geometry.rotation, geometry, 20.0)
    assert foot.centre_of_pressure[0] == pytest.approx(at, abs=1e-9)
    assert foot.force[0] == pytest.approx(force, abs=1e-9)
    assert foot.free_moment[0] == pytest.approx([0.0, 0.0, tz], abs=1e-8)


def test_below_the_threshold_a_foot_is_silent():
    foot = ground_reaction(
        [[1.0, 2.0, 19.9], [1.0, 2.0, 20.1]], np.ones((2, 3)), PlateGeometry('right'), 20.0
    )
    assert foot.loaded.tolist() == [False, True]
    assert np.isnan(foot.centre_of_pressure[0]).all()
    assert np.isfinite(foot.centre_of_pressure[1]).all()
    assert not foot.force[0].any()
    assert not foot.free_moment[0].any()


def both(*feet):
    return (
        np.stack([foot.force for foot in feet], axis=1),
        np.stack([foot.centre_of_pressure for foot in feet], axis=1),
    )


def test_total_centre_of_pressure_is_weighted_by_the_load():
    feet = [
        ground_reaction([[0.0, 0.0, load]], [[0.0, -x * load, 0.0]], PlateGeometry('p'), 20.0)
        for x, load in ((0.1, 300.0), (0.4, 100.0), (5.0, 10.0))
    ]
    assert total_centre_of_pressure(*both(*feet[:2]))[0] == pytest.approx([0.175, 0.0, 0.0])
    # The third foot is below the threshold.
    assert total_centre_of_pressure(*both(*feet[1:]))[0] == pytest.approx([0.4, 0.0, 0.0])


def test_total_of_unloaded_feet_has_no_place():
    foot = ground_reaction(np.zeros((1, 3)), np.zeros((1, 3)), PlateGeometry('p'), 20.0)
    assert np.isnan(total_centre_of_pressure(*both(foot, foot))).all()


def test_geometry_is_checked():
    with pytest.raises(ForcePlateError, match=r'left\.rotation'):
        PlateGeometry('left', rotation=np.diag([1.0, 1.0, -1.0]))
    with pytest.raises(ForcePlateError, match=r'left\.origin'):
        PlateGeometry('left', origin=np.array([0.0, np.nan, 0.0]))
    with pytest.raises(ForcePlateError, match='threshold'):
        ground_reaction(np.zeros((1, 3)), np.zeros((1, 3)), PlateGeometry('p'), 0.0)
