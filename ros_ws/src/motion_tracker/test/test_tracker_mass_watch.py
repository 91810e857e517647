# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Weight on the plates against the masses as entered."""

import numpy as np
import pytest

from human_model.constants import GRAVITY
from motion_tracker.core.exceptions import ForcePlateError
from motion_tracker.core.forces.mass_watch import MassWatch

RATE = 100.0


def watched(watch, vertical, need=None, box_mass=0.0):
    """Push samples; return what the watch said."""
    weight = np.full(len(vertical), 70.0 * GRAVITY)
    needs = weight if need is None else need
    said = [watch.push(f, n, box_mass, RATE) for f, n in zip(vertical, needs, strict=True)]
    return [check for check in said if check is not None]


@pytest.mark.parametrize(
    ('mass', 'ok'), [(70.0, True), (72.9, True), (66.0, False), (74.0, False)]
)
def test_weight_off_by_more_than_five_percent_is_told(mass, ok):
    rng = np.random.default_rng(4)
    watch = MassWatch(70.0, 0.05)
    quiet = mass * GRAVITY + rng.normal(0.0, 1.0, 100)
    (check,) = watched(watch, quiet)
    assert check.plate_mass == pytest.approx(mass, abs=0.1)
    assert check.ok is ok is watch.agrees
    assert f'plates: {mass:.1f} kg' in str(check)
    assert 'subject.mass: 70.0 kg' in str(check)


def test_only_a_changed_verdict_is_told():
    watch = MassWatch(70.0, 0.05)
    said = watched(watch, np.repeat([690.0, 680.0, 600.0, 590.0, 690.0, 685.0], 200))
    assert [check.ok for check in said] == [True, False, True]
    assert watch.agrees


def test_movement_is_no_weight():
    """Neither a force that swings, nor one that is even while the body gains speed."""
    watch = MassWatch(70.0, 0.05)
    assert not watched(watch, 700.0 + 70.0 * np.sin(np.arange(300) / 5.0))
    even = np.full(300, 620.0)
    assert not watched(watch, even, need=even)
    assert watch.agrees
    assert watch.check is None


def test_box_in_the_hands_counts_and_an_unknown_one_does_not():
    watch = MassWatch(70.0, 0.05)
    held = np.full(100, 82.0 * GRAVITY)
    assert not watched(watch, held, box_mass=None)
    (check,) = watched(watch, held, box_mass=12.0)
    assert check.ok
    assert 'task.box_mass: 12.0 kg' in str(check)
    (check,) = watched(watch, held, box_mass=0.0)
    assert check.deviation == pytest.approx(12.0 / 70.0)


def test_a_stretch_does_not_reach_over_a_change_of_the_load():
    watch = MassWatch(70.0, 0.05)
    weight = np.full(40, 70.0 * GRAVITY)
    assert not watched(watch, weight)
    assert not watched(watch, weight, box_mass=12.0)
    assert not watched(watch, weight)


def test_masses_must_be_positive():
    with pytest.raises(ForcePlateError, match='mass watch'):
        MassWatch(0.0, 0.05)
