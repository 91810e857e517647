# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Idle plates, a plate under the box, one under both feet, plates left out by option."""

from dataclasses import replace

import numpy as np
import pytest

from lifting_recordings.alignment import ConventionOptions, align
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.plate_assignment import Carried
from lifting_recordings.recording import Plate

G = 9.80665


def plate(name: str, time: np.ndarray, force: np.ndarray, at: tuple[float, float]) -> Plate:
    """Return a plate with forces (n, 3) at one place on the floor."""
    return Plate(name, time, force, np.cross((*at, 0.0), force))


def aligned(standing, plates, carried=None, markers=None, names=None, option=None):
    raw = replace(
        standing.raw,
        plates=tuple(plates),
        positions=standing.raw.positions if markers is None else markers,
        names=standing.raw.names if names is None else names,
    )
    carried = carried or Carried(standing.mass)
    return align(raw, standing.stature, carried, ConventionOptions(plates=option or {}))


def noise(time: np.ndarray, sign: float) -> np.ndarray:
    """Return the force of an unloaded plate with an offset and a spike."""
    force = np.random.default_rng(3).normal(0.0, 2.0, (time.size, 3))
    force[:, 2] += sign * 3.0
    force[7, 2] = sign * 400.0
    return force


@pytest.mark.parametrize('sign', [-1.0, 0.0, 1.0])
def test_idle_plate_of_either_sign_is_left_out(standing, sign):
    time = standing.raw.time
    force = noise(time, sign) * (sign != 0.0)
    for turned in (False, True):
        loaded = [
            replace(p, force=-p.force, moment=-p.moment) if turned else p
            for p in standing.raw.plates
        ]
        found = aligned(standing, [plate('fp0', time, force, (1.0, 1.0)), *loaded])
        np.testing.assert_allclose(found.plates['right'].force, standing.raw.plates[0].force)
        assert any('fp0: above 50 N for less than' in text for text in found.statements)


def test_plate_left_out_by_option_is_not_looked_at(standing):
    time = standing.raw.time
    push = np.tile((0.0, 300.0, -500.0), (time.size, 1))
    extra = plate('fp3', time, push, (2.0, 0.0))
    with pytest.raises(ConventionError, match=r'--plate NAME=none|markers and plates'):
        aligned(standing, [*standing.raw.plates, extra])
    found = aligned(standing, [*standing.raw.plates, extra], option={'fp3': 'none'})
    np.testing.assert_allclose(found.plates['left'].force, standing.raw.plates[1].force)


def test_plate_that_cannot_be_read_is_named_and_can_be_left_out(standing):
    none = np.zeros((0, 3))
    bad = Plate('fp3', none[:, 0], none, none, problem='TYPE is 6')
    with pytest.raises(ConventionError, match=r"'fp3'.*TYPE is 6.*--plate fp3=none"):
        aligned(standing, [*standing.raw.plates, bad])
    aligned(standing, [*standing.raw.plates, bad], option={'fp3': 'none'})


def test_all_plates_left_out_is_a_recording_without_plates(standing):
    found = aligned(standing, standing.raw.plates, option={'fp1': 'none', 'fp2': 'none'})
    assert found.plates == {}
    assert any('No loaded plate under a foot' in text for text in found.statements)


@pytest.mark.parametrize('with_markers', [False, True])
def test_plate_under_the_box_is_found(standing, with_markers):
    time = standing.raw.time
    weight = 12.0 * G * (1.0 if not with_markers else 1.6)
    force = np.zeros((time.size, 3))
    force[:120, 2] = weight
    third = plate('fp3', time, force, (0.5, 0.05))
    markers, names = standing.raw.positions, standing.raw.names
    if with_markers:
        box = np.tile((0.55, 0.0, 0.2), (time.size, 1, 1))
        markers, names = np.concatenate((markers, box), axis=1), (*names, 'BOX1')
    carried = Carried(standing.mass, 12.0, ('BOX1',))
    found = aligned(standing, [*standing.raw.plates, third], carried, markers, names)
    assert any(text.startswith('Plate fp3: the box') for text in found.statements)
    np.testing.assert_allclose(found.plates['right'].force, standing.raw.plates[0].force)
    with pytest.raises(ConventionError, match='--plate fp3=SIDE with right, left, both, box or'):
        aligned(standing, [*standing.raw.plates, third])
    found = aligned(standing, [*standing.raw.plates, third], option={'fp3': 'box'})
    assert any('Plate fp3: the box (option' in text for text in found.statements)


@pytest.mark.parametrize('option', [{}, {'one': 'both'}])
def test_plate_under_both_feet_is_shared_and_the_sum_is_kept(standing, option):
    right, left = standing.raw.plates
    whole = Plate('one', right.time, right.force + left.force, right.moment + left.moment)
    found = aligned(standing, [whole], option=option).plates
    force = found['right'].force + found['left'].force
    moment = found['right'].moment + found['left'].moment
    np.testing.assert_allclose(force, whole.force, atol=1e-9)
    np.testing.assert_allclose(moment, whole.moment, atol=1e-9)
    # The lever rule finds the shares of 60 and 40 %, and each load is under its foot.
    np.testing.assert_allclose(found['right'].force[:, 2], right.force[:, 2], rtol=0.03)
    for side, y in (('right', -0.125), ('left', 0.125)):
        cop = found[side].moment[:, 0] / found[side].force[:, 2]
        np.testing.assert_allclose(cop, y, atol=0.01)


def test_plate_under_both_feet_beside_another_needs_the_option(standing):
    right, left = standing.raw.plates
    half = [
        Plate(f'half_{i}', right.time, 0.5 * (right.force + left.force),
              0.5 * (right.moment + left.moment))
        for i in (1, 2)
    ]  # fmt: skip
    with pytest.raises(ConventionError, match='--plate half_1=SIDE with right, left, both'):
        aligned(standing, half)
    found = aligned(standing, half, option={'1': 'both', '2': 'both'}).plates
    np.testing.assert_allclose(
        found['right'].force + found['left'].force, right.force + left.force, atol=1e-9
    )


def test_option_that_is_no_load_says_what_to_write():
    with pytest.raises(ConventionError, match=r'--plate 1=table: .* right, left, both, box, none'):
        ConventionOptions(plates={'1': 'table'})


def test_raised_plate_is_warned_of(standing):
    corners = np.array([[0.3, 0.0, 0.12], [0.3, -0.3, 0.12], [-0.3, -0.3, 0.12], [-0.3, 0, 0.12]])
    plates = [replace(p, corners=corners) for p in standing.raw.plates]
    said = aligned(standing, plates).statements
    assert any('Warning: the surface of plate fp1 is +120 mm' in text for text in said)


def test_recording_that_begins_with_the_box_in_the_hands(standing):
    heavier = [
        replace(p, force=p.force * (82.0 / 70.0), moment=p.moment * (82.0 / 70.0))
        for p in standing.raw.plates
    ]
    said = aligned(standing, heavier, Carried(70.0, 12.0)).statements
    assert any('Mass of body and box on the plates: 82.0 kg' in text for text in said)
    with pytest.raises(ConventionError, match=r'82\.0 kg .*says 70 kg, \+17'):
        aligned(standing, heavier, Carried(70.0))
    with pytest.raises(ConventionError, match=r'says 60 kg or, with task\.box_mass, 72 kg'):
        aligned(standing, heavier, Carried(60.0, 12.0))


def test_sitting_is_not_taken_for_standing(standing):
    n = standing.raw.time.size
    markers = standing.raw.positions.copy()
    markers[: n // 2, 4:8, 2] -= 0.4
    share = np.where(np.arange(n) < n // 2, 0.5, 1.0)[:, None]
    seated = [replace(p, force=p.force * share, moment=p.moment * share)
              for p in standing.raw.plates]  # fmt: skip
    said = aligned(standing, seated, markers=markers).statements
    assert any('70.0 kg (quiet standing at 1.' in text for text in said)
    with pytest.raises(ConventionError, match=r'35\.0 kg'):
        aligned(standing, seated)
