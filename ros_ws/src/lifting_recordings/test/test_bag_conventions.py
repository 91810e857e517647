# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Units, axes, sides and plates: detected where the data settle them, refused where not."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest

from lifting_recordings.alignment import ConventionOptions, align
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.plate_assignment import Carried
from lifting_recordings.recording import Plate, centre_of_pressure

DEFAULT = ConventionOptions()


def right_handed_frames() -> list[np.ndarray]:
    frames = []
    for order, signs in product(permutations(range(3)), product((1, -1), repeat=3)):
        matrix = np.zeros((3, 3))
        for row, (column, sign) in enumerate(zip(order, signs, strict=True)):
            matrix[row, column] = sign
        if np.linalg.det(matrix) > 0.0:
            frames.append(matrix)
    return frames


@pytest.mark.parametrize('matrix', right_handed_frames())
@pytest.mark.parametrize(('units', 'scale'), [('m', 1.0), ('mm', 1000.0)])
def test_every_axis_convention_comes_back_the_same(standing, matrix, units, scale):
    file = replace(standing.turned(standing.raw, matrix, scale), units=units)
    found = align(file, standing.stature, Carried(standing.mass), DEFAULT)
    np.testing.assert_allclose(found.markers, standing.raw.positions, atol=1e-9)
    np.testing.assert_allclose(
        found.plates['right'].force, standing.raw.plates[0].force, atol=1e-9
    )
    np.testing.assert_allclose(
        found.plates['left'].moment, standing.raw.plates[1].moment, atol=1e-9
    )


def test_everything_detected_is_stated(standing):
    said = ' '.join(
        align(standing.raw, standing.stature, Carried(standing.mass), DEFAULT).statements
    )
    for part in ('units: m', 'Vertical axis', 'Facing', 'Left and right', 'fp1: right', 'Floor'):
        assert part in said


def test_force_on_the_plate_is_turned_round(standing):
    pressed = tuple(Plate(p.name, p.time, -p.force, -p.moment) for p in standing.raw.plates)
    found = align(
        replace(standing.raw, plates=pressed), standing.stature, Carried(standing.mass), DEFAULT
    )
    np.testing.assert_allclose(found.plates['right'].force, standing.raw.plates[0].force)
    assert any('sign turned' in text for text in found.statements)


def test_swapped_plates_are_assigned_by_where_the_feet_are(standing):
    found = align(
        replace(standing.raw, plates=standing.raw.plates[::-1]),
        standing.stature,
        Carried(standing.mass),
        DEFAULT,
    )
    np.testing.assert_allclose(found.plates['right'].force, standing.raw.plates[0].force)


def test_swapped_plates_as_option_are_refused(standing):
    options = ConventionOptions(plates={'fp1': 'left', 'fp2': 'right'})
    with pytest.raises(ConventionError, match=r"'fp1': --plate says left.*says right"):
        align(standing.raw, standing.stature, Carried(standing.mass), options)


def test_plate_option_takes_the_last_part_of_a_name(standing):
    named = tuple(
        Plate(f'ground_force_{i}', p.time, p.force, p.moment)
        for i, p in enumerate(standing.raw.plates, 1)
    )
    raw = replace(standing.raw, plates=named)
    options = ConventionOptions(plates={'1': 'right', 'ground_force_2': 'left'})
    found = align(raw, standing.stature, Carried(standing.mass), options)
    assert any('ground_force_1: right foot (option' in text for text in found.statements)
    with pytest.raises(ConventionError, match='--plate 3=left: the file has no plate'):
        align(
            raw, standing.stature, Carried(standing.mass), ConventionOptions(plates={'3': 'left'})
        )


def test_plate_between_the_feet_needs_the_option(standing):
    plate = standing.raw.plates[0]
    moment = plate.moment + np.cross((0.0, 0.125, 0.0), plate.force)
    between = (Plate('fp1', plate.time, plate.force, moment), standing.raw.plates[1])
    with pytest.raises(ConventionError, match=r"'fp1'.*--plate fp1=SIDE"):
        align(
            replace(standing.raw, plates=between),
            standing.stature,
            Carried(standing.mass),
            DEFAULT,
        )


def test_foot_without_plate_is_refused(standing):
    with pytest.raises(ConventionError, match='no loaded plate under the left foot'):
        align(
            replace(standing.raw, plates=standing.raw.plates[:1]),
            standing.stature,
            Carried(0.6 * standing.mass),
            DEFAULT,
        )


def test_two_plates_under_one_foot_are_added(standing):
    first = standing.raw.plates[0]
    halves = tuple(Plate(n, first.time, first.force / 2, first.moment / 2) for n in ('a', 'b'))
    found = align(
        replace(standing.raw, plates=(*halves, standing.raw.plates[1])),
        standing.stature,
        Carried(standing.mass),
        DEFAULT,
    )
    np.testing.assert_allclose(found.plates['right'].moment, first.moment)


def test_millimetres_called_metres_are_refused_and_the_option_settles_it(standing):
    wrong = replace(standing.raw, positions=standing.raw.positions * 1000.0)
    with pytest.raises(ConventionError, match=r"stated 'm'.*fit 'mm'.*--units"):
        align(wrong, standing.stature, Carried(standing.mass), DEFAULT)
    found = align(wrong, standing.stature, Carried(standing.mass), ConventionOptions(units='mm'))
    np.testing.assert_allclose(found.markers, standing.raw.positions, atol=1e-9)


def test_unstated_units_are_not_guessed(standing):
    with pytest.raises(ConventionError, match='give --units'):
        align(replace(standing.raw, units=''), standing.stature, Carried(standing.mass), DEFAULT)


def test_swapped_labels_are_named(standing):
    names = list(standing.raw.names)
    i, j = names.index('RHEE'), names.index('LHEE')
    names[i], names[j] = names[j], names[i]
    with pytest.raises(ConventionError, match='RHEE and LHEE'):
        align(
            replace(standing.raw, names=tuple(names), plates=()),
            standing.stature,
            Carried(standing.mass),
            DEFAULT,
        )


@pytest.mark.parametrize('missing', ['RASI', 'LASI', 'RPSI', 'LPSI', 'RTOE', 'LHEE'])
def test_one_marker_of_a_pair_does_not_turn_the_person(standing, missing):
    positions = standing.raw.positions.copy()
    column = standing.raw.names.index(missing)
    raw = replace(standing.raw, positions=positions, plates=())
    carried = Carried(standing.mass)
    names = tuple('unknown' if name == missing else name for name in raw.names)
    if missing in ('RTOE', 'LHEE'):
        with pytest.raises(ConventionError, match=r'roles: \{MARKER: (toe right|heel left)'):
            align(replace(raw, names=names), standing.stature, carried, DEFAULT)
    else:
        found = align(replace(raw, names=names), standing.stature, carried, DEFAULT)
        assert any('(from feet, ' in text for text in found.statements)
        positions[:, column] = np.nan
        align(raw, standing.stature, carried, DEFAULT)


def test_marker_of_the_trunk_that_is_never_seen_does_not_count(standing):
    positions = standing.raw.positions.copy()
    positions[:, standing.raw.names.index('C7')] = np.nan
    positions[3:, standing.raw.names.index('CLAV')] = np.nan
    found = align(
        replace(standing.raw, positions=positions),
        standing.stature,
        Carried(standing.mass),
        DEFAULT,
    )
    assert any('Vertical axis of the file: +z' in text for text in found.statements)


def moved(standing, shifts: dict[str, tuple[float, float, float]]) -> np.ndarray:
    positions = standing.raw.positions.copy()
    for name, shift in shifts.items():
        positions[:, standing.raw.names.index(name)] += shift
    return positions


def test_feet_of_a_side_stance_are_not_swapped_labels(standing):
    crossed = {'RHEE': (0.3, 0.13, 0.0), 'RTOE': (0.3, 0.13, 0.0), 'LHEE': (-0.1, -0.12, 0.0)}
    raw = replace(standing.raw, positions=moved(standing, crossed), plates=())
    found = align(raw, standing.stature, Carried(standing.mass), DEFAULT)
    assert any('Not settled for RHEE and LHEE (-10 mm)' in text for text in found.statements)


def test_person_who_turns_has_no_swapped_labels(standing):
    n = standing.raw.time.size
    angle = np.linspace(0.0, 1.9 * np.pi / 2, n)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.zeros((n, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1] = c, -s, s, c
    turn[:, 2, 2] = 1.0
    positions = np.einsum('nij,nmj->nmi', turn, standing.raw.positions)
    raw = replace(standing.raw, positions=positions, plates=())
    align(raw, standing.stature, Carried(standing.mass), ConventionOptions(facing='+y'))


def test_toes_turned_away_from_the_pelvis_need_the_option(standing):
    out = {'RTOE': (-0.09, 0.12, 0.0), 'LTOE': (-0.09, 0.12, 0.0)}
    raw = replace(standing.raw, positions=moved(standing, out), plates=())
    carried = Carried(standing.mass)
    with pytest.raises(ConventionError, match=r'degrees apart: .*or give --facing'):
        align(raw, standing.stature, carried, DEFAULT)
    align(raw, standing.stature, carried, ConventionOptions(facing='+x'))


def test_message_names_the_file(standing):
    with pytest.raises(ConventionError, match=r'^person\.trc: marker units'):
        align(replace(standing.raw, units=''), standing.stature, Carried(standing.mass), DEFAULT)


def test_facing_between_two_axes_needs_the_option(standing):
    c = np.cos(np.pi / 4)
    diagonal = standing.turned(
        standing.raw, np.array([[c, -c, 0.0], [c, c, 0.0], [0.0, 0.0, 1.0]])
    )
    with pytest.raises(ConventionError, match='--facing'):
        align(diagonal, standing.stature, Carried(standing.mass), DEFAULT)
    found = align(
        diagonal, standing.stature, Carried(standing.mass), ConventionOptions(facing='+x')
    )
    assert any('(option)' in text for text in found.statements)


def test_option_against_the_data_is_refused(standing):
    with pytest.raises(ConventionError, match='--facing says -x'):
        align(
            standing.raw, standing.stature, Carried(standing.mass), ConventionOptions(facing='-x')
        )
    with pytest.raises(ConventionError, match=r'--vertical says \+y'):
        align(
            standing.raw,
            standing.stature,
            Carried(standing.mass),
            ConventionOptions(vertical='+y'),
        )


def test_markers_and_plates_in_different_axes_are_refused(standing):
    other = tuple(
        Plate(p.name, p.time, p.force[:, [0, 2, 1]], p.moment) for p in standing.raw.plates
    )
    with pytest.raises(ConventionError, match='different axes'):
        align(
            replace(standing.raw, plates=other), standing.stature, Carried(standing.mass), DEFAULT
        )


def test_weight_off_by_more_than_five_percent_is_refused(standing):
    with pytest.raises(ConventionError, match=r'plates say 70\.0 kg.*subject\.mass says 75 kg'):
        align(standing.raw, standing.stature, Carried(75.0), DEFAULT)
    align(standing.raw, standing.stature, Carried(75.0), ConventionOptions(mass_tolerance=0.1))


def test_floor_not_at_zero_needs_the_option(standing):
    high = replace(standing.raw, positions=standing.raw.positions + (0.0, 0.0, 0.5), plates=())
    with pytest.raises(ConventionError, match='--floor-height'):
        align(high, standing.stature, Carried(standing.mass), DEFAULT)
    found = align(
        high, standing.stature, Carried(standing.mass), ConventionOptions(floor_height=0.5)
    )
    np.testing.assert_allclose(found.markers, standing.raw.positions, atol=1e-9)


def test_floor_height_moves_the_moments_too(standing):
    lift = np.array([0.0, 0.0, 0.5])
    plates = tuple(
        Plate(p.name, p.time, p.force, p.moment + np.cross(lift, p.force))
        for p in standing.raw.plates
    )
    high = replace(standing.raw, positions=standing.raw.positions + lift, plates=plates)
    found = align(
        high, standing.stature, Carried(standing.mass), ConventionOptions(floor_height=0.5)
    )
    np.testing.assert_allclose(
        found.plates['left'].moment, standing.raw.plates[1].moment, atol=1e-9
    )


def test_unknown_marker_names_need_roles(standing):
    names = tuple(f'M{i}' for i in range(len(standing.raw.names)))
    bare = replace(standing.raw, names=names)
    with pytest.raises(ConventionError, match=r'roles: \{MARKER: heel right'):
        align(bare, standing.stature, Carried(standing.mass), DEFAULT)
    kinds = {'HEE': 'heel', 'TOE': 'toe', 'ASI': 'pelvis_front', 'SHO': 'trunk'}
    sides = {'R': 'right', 'L': 'left'}
    roles = {
        f'M{i}': f'{kinds[name[1:]]} {sides[name[0]]}'
        for i, name in enumerate(standing.raw.names)
        if name[1:] in kinds
    }
    found = align(bare, standing.stature, Carried(standing.mass), DEFAULT, roles)
    np.testing.assert_allclose(found.markers, standing.raw.positions, atol=1e-9)


def test_centre_of_pressure_of_a_tilted_force():
    cop = np.array([[0.2, -0.1, 0.0]])
    force = np.array([[30.0, -20.0, 500.0]])
    moment = np.cross(cop, force) + (0.0, 0.0, 3.0)
    np.testing.assert_allclose(centre_of_pressure(force, moment), cop, atol=1e-12)
