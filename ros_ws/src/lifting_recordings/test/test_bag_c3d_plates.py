# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force plates of types 1 to 4 from their channels, as the C3D User Guide defines them."""

import re
from pathlib import Path

import ezc3d
import numpy as np
import pytest

from lifting_recordings.c3d_plates import read_plates

RATE = 1000.0
#: A plate on the floor, turned by 30 degrees; its z axis points down [mm].
TURN = np.radians(30.0)
X = np.array([np.cos(TURN), np.sin(TURN), 0.0])
Y = np.array([np.sin(TURN), -np.cos(TURN), 0.0])
MIDDLE = np.array([500.0, -300.0, 0.0])
CORNERS = np.array(
    [MIDDLE + a * X + b * Y for a, b in ((300, 200), (-300, 200), (-300, -200), (300, -200))]
)
AXES = np.stack((X, Y, np.cross(X, Y)), axis=1)
# Force of the ground [N], centre of pressure from the middle of the plate, in its axes [m], and
# free moment [N m].
FORCE = np.array([[30.0, -20.0, -600.0], [-10.0, 40.0, -350.0]])
COP = np.array([[0.11, -0.07, 0.0], [-0.2, 0.15, 0.0]])
FREE = np.array([[0.0, 0.0, 3.0], [0.0, 0.0, -2.0]])
MOMENT = np.cross(COP, FORCE) + FREE


def truth() -> tuple[np.ndarray, np.ndarray]:
    """Return force [N] and moment about the origin [N m] in laboratory axes."""
    force = FORCE @ AXES.T
    return force, MOMENT @ AXES.T + np.cross(MIDDLE * 1e-3, force)


def file(path: Path, kind: int, channels: np.ndarray, units: list[str], origin, **more) -> object:
    """Write a C3D file with one plate and return it as ezc3d reads it."""
    c3d = ezc3d.c3d()
    p = c3d['parameters']
    p['POINT']['RATE']['value'] = [RATE]
    p['POINT']['LABELS']['value'] = ['C7']
    p['POINT']['UNITS']['value'] = ['mm']
    c3d['data']['points'] = np.ones((4, 1, len(channels)))
    c3d['data']['analogs'] = channels.T[np.newaxis]
    p['ANALOG']['RATE']['value'] = [RATE]
    p['ANALOG']['LABELS']['value'] = [f'channel {i}' for i in range(channels.shape[1])]
    p['ANALOG']['UNITS']['value'] = units
    for name, value in {
        'USED': np.array([1]),
        'TYPE': np.array([kind]),
        'ZERO': np.array([1, 0]),
        'CORNERS': CORNERS.T[:, :, np.newaxis],
        'ORIGIN': np.reshape(origin, (3, 1)).astype(float),
        'CHANNEL': np.arange(1, channels.shape[1] + 1).reshape(-1, 1),
        **more,
    }.items():
        p['FORCE_PLATFORM'][name]['value'] = value
    c3d.write(str(path))
    return ezc3d.c3d(str(path))


def check(path: Path, c3d: object) -> None:
    (plate,), used = read_plates(path, c3d)
    force, moment = truth()
    assert plate.problem == ''
    np.testing.assert_allclose(plate.force, force, atol=1e-3)
    np.testing.assert_allclose(plate.moment, moment, atol=1e-3)
    np.testing.assert_allclose(plate.time, np.arange(2) / RATE)
    assert used == set(range(len(used)))


def test_type_1_holds_centre_of_pressure_and_free_moment(tmp_path):
    channels = np.concatenate((FORCE, COP[:, :2] * 1e3, FREE[:, 2:] * 1e3), axis=1)
    units = ['N', 'N', 'N', 'mm', 'mm', 'Nmm']
    check(tmp_path / 'a.c3d', file(tmp_path / 'a.c3d', 1, channels, units, (0, 0, 0)))


@pytest.mark.parametrize('sign', [-1.0, 1.0])
def test_type_2_holds_the_moment_about_the_transducers(tmp_path, sign):
    origin = np.array([4.0, -3.0, -40.0])
    about = MOMENT + np.cross(origin * 1e-3, FORCE)
    channels = np.concatenate((FORCE, about * 1e3), axis=1)
    units = ['N'] * 3 + ['Nmm'] * 3
    c3d = file(tmp_path / 'a.c3d', 2, channels, units, -sign * origin)
    check(tmp_path / 'a.c3d', c3d)


def test_type_2_equals_ezc3d(tmp_path):
    channels = np.concatenate((FORCE, MOMENT * 1e3), axis=1)
    file(tmp_path / 'a.c3d', 2, channels, ['N'] * 3 + ['Nmm'] * 3, (1.0, 2.0, -30.0))
    other = ezc3d.c3d(str(tmp_path / 'a.c3d'), extract_forceplat_data=True)
    (plate,), _ = read_plates(tmp_path / 'a.c3d', other)
    (found,) = other['data']['platform']
    centre = found['corners'].mean(axis=1) * 1e-3
    np.testing.assert_allclose(plate.force, found['force'].T, rtol=1e-9, atol=1e-9)
    moment = found['moment'].T * 1e-3 + np.cross(centre, found['force'].T)
    np.testing.assert_allclose(plate.moment, moment, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize('unit', ['Nm', 'Nmm'])
def test_unit_of_the_moment_is_that_which_puts_the_load_on_the_plate(tmp_path, unit):
    channels = np.concatenate((FORCE, MOMENT * 1e3), axis=1)
    check(
        tmp_path / 'a.c3d',
        file(tmp_path / 'a.c3d', 2, channels, ['N'] * 3 + [unit] * 3, (0, 0, 0)),
    )
    channels = np.concatenate((FORCE, MOMENT), axis=1)
    check(
        tmp_path / 'b.c3d',
        file(tmp_path / 'b.c3d', 2, channels, ['N'] * 3 + ['Nm'] * 3, (0, 0, 0)),
    )


def test_type_3_holds_eight_channels_of_four_transducers(tmp_path):
    a, b, depth = 0.24, 0.15, 0.052
    below = MOMENT + np.cross((0.0, 0.0, -depth), FORCE)
    # Shear and vertical forces of the transducers that give force and moment.
    mx, my, mz = below.T
    fx, fy, fz = FORCE.T
    x34 = fx / 2 + mz / (4 * b)
    y14 = fy / 2 + mz / (4 * a)
    quarter = fz / 4
    z1 = quarter + mx / (4 * b) - my / (4 * a)
    z2 = quarter + mx / (4 * b) + my / (4 * a)
    z3 = quarter - mx / (4 * b) + my / (4 * a)
    z4 = quarter - mx / (4 * b) - my / (4 * a)
    channels = np.stack((fx - x34, x34, y14, fy - y14, z1, z2, z3, z4), axis=1)
    for sign in (-1.0, 1.0):
        origin = 1e3 * np.array([a, b, sign * depth])
        path = tmp_path / f'{sign}.c3d'
        check(path, file(path, 3, channels, ['N'] * 8, origin))


def test_type_4_is_calibrated(tmp_path):
    matrix = np.diag([2.0, 3.0, 4.0, 500.0, 600.0, 700.0]) + np.arange(36).reshape(6, 6) / 50.0
    volts = np.linalg.solve(matrix, np.concatenate((FORCE, MOMENT * 1e3), axis=1).T).T
    path = tmp_path / 'a.c3d'
    c3d = file(path, 4, volts, ['V'] * 6, (0, 0, 0), CAL_MATRIX=matrix[:, :, np.newaxis])
    check(path, c3d)


def test_type_stored_with_two_dimensions(tmp_path):
    channels = np.concatenate((FORCE, MOMENT * 1e3), axis=1)
    units = ['N'] * 3 + ['Nmm'] * 3
    c3d = file(tmp_path / 'a.c3d', 2, channels, units, (0, 0, 0), TYPE=np.array([[2]]))
    check(tmp_path / 'a.c3d', c3d)


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        ({'TYPE': np.array([6])}, 'FORCE_PLATFORM:TYPE.*is 6; types 1, 2, 3, 4 are read'),
        ({'CHANNEL': np.full((6, 1), 40)}, 'FORCE_PLATFORM:CHANNEL.*40.*of the 6 channels'),
        ({'CORNERS': np.zeros((3, 4, 1))}, 'FORCE_PLATFORM:CORNERS.*is no rectangle'),
        ({'ORIGIN': np.zeros((0, 1))}, 'FORCE_PLATFORM:ORIGIN.*1 plates are in use'),
    ],
)
def test_plate_that_cannot_be_read_carries_its_problem(tmp_path, change, words):
    channels = np.concatenate((FORCE, MOMENT * 1e3), axis=1)
    path = tmp_path / 'a.c3d'
    c3d = file(path, 2, channels, ['N'] * 3 + ['Nmm'] * 3, (0, 0, 0))
    for name, value in change.items():
        c3d['parameters']['FORCE_PLATFORM'][name]['value'] = value
    (plate,), _ = read_plates(path, c3d)
    assert plate.time.size == 0
    assert re.search(words, plate.problem)


def test_type_1_with_moments_is_read_as_type_2(tmp_path):
    channels = np.concatenate((FORCE, MOMENT * 1e3), axis=1)
    units = ['N'] * 3 + ['Nmm'] * 3
    check(tmp_path / 'a.c3d', file(tmp_path / 'a.c3d', 1, channels, units, (0, 0, 0)))
