# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force of the box on the hands: on the floor, in the air, between, and shared."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from human_model.constants import GRAVITY as G
from motion_tracker.core.exceptions import HandForceError
from motion_tracker.core.forces.hand_force import HandForceEstimator, HandForceSettings
from motion_tracker.core.forces.hand_force_kernel import split

SIZE = (0.25, 0.30, 0.15)
BOX = np.array([0.4, 0.0, 0.1])
HANDS = np.array([[0.4, -0.15, 0.1], [0.4, 0.15, 0.1]])
AWAY = HANDS + [0.0, 0.0, 1.0]
STILL = np.zeros(3)


@pytest.fixture
def estimator():
    return HandForceEstimator(12.0, SIZE)


def test_carried_box_weighs_mass_times_gravity_and_acceleration(estimator):
    force = estimator.estimate(
        None, HANDS + [0, 0, 0.5], BOX + [0, 0, 0.5], np.array([1.0, 0.0, 2.0]), 0.1, None
    )
    assert force.sum(axis=0) == pytest.approx([-12.0, 0.0, -12.0 * (G + 2.0)])


def test_on_the_floor_the_plates_tell_what_the_hands_take(estimator):
    for _ in range(300):
        estimator.observe(-7.0, AWAY, BOX, 0.0, False, 0.01, 0.03)
    assert estimator.bias == pytest.approx(-7.0)
    # The plates give 50 N more than the body needs, beyond what they always do.
    force = estimator.estimate(-57.0, HANDS, BOX, STILL, estimator.support, None)
    assert force.sum(axis=0) == pytest.approx([0.0, 0.0, -50.0])


def test_hands_away_from_the_box_carry_nothing(estimator):
    assert not estimator.estimate(-500.0, AWAY, BOX, STILL, 0.1, None).any()


def test_more_than_the_box_weighs_is_not_believed(estimator):
    force = estimator.estimate(-900.0, HANDS, BOX, STILL, 0.1, None)
    assert force[:, 2].sum() == pytest.approx(-1.5 * 12.0 * G)


def test_nothing_is_lifted_without_a_box():
    nothing = HandForceEstimator(0.0, (0.0, 0.0, 0.0))
    assert not nothing.estimate(-100.0, HANDS, BOX, STILL, 0.1, None).any()
    unseen = HandForceEstimator(5.0, SIZE)
    assert not unseen.estimate(-100.0, HANDS, np.full(3, np.nan), STILL, 0.1, None).any()


def test_a_whole_lift_has_no_step(estimator):
    """Approach, load, lift-off, carry, release: 1 ms apart, forces move by a few newtons."""
    time = np.arange(0.0, 6.0, 1e-3)
    ramp = np.clip((time - 1.5) / 0.5, 0.0, 1.0)
    load = 12.0 * G * ramp**2 * (3 - 2 * ramp)
    s = np.clip((time - 2.0) / 1.5, 0.0, 1.0)
    rise = 0.8 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    lift = 0.8 / 1.5**2 * (60 * s - 180 * s**2 + 120 * s**3)
    away = np.clip(1.0 - time, 0.0, 1.0) + np.clip(time - 5.0, 0.0, 1.0)
    last, largest, peak = None, 0.0, 0.0
    for t, w, z, a, d in zip(time, load, rise, lift, away, strict=True):
        box, hands = BOX + [0, 0, z], HANDS + [0, 0, z + d]
        since = t - 3.8 if t > 3.8 else None
        estimator.observe(
            -w if t < 3.8 else 0.0,
            hands,
            box,
            0.0 if 0.0 in (s[0], z) else 0.1,
            2.0 < t < 4.2,
            1e-3,
            0.03,
        )
        force = estimator.estimate(
            -w if t < 3.8 else 0.0, hands, box, np.array([0, 0, a]), 0.1, since
        )
        if last is not None:
            largest = max(largest, float(np.abs(force - last).max()))
        last = force
        peak = min(peak, float(force[:, 2].sum()))
    assert largest < 1.5
    assert peak == pytest.approx(-12.0 * (G + lift.max()), rel=0.02)
    assert not last.any()


def test_samples_at_once_have_the_bits_of_samples_alone(estimator):
    estimator.observe(-7.0, AWAY, BOX, 0.0, False, 0.01, 0.03)
    rng = np.random.default_rng(5)
    rise = np.linspace(0.0, 0.1, 20)[:, None] * [0.0, 0.0, 1.0]
    hands = HANDS + rng.normal(0.0, 0.08, (20, 2, 3))
    missing, acceleration = rng.normal(-60.0, 60.0, 20), rng.normal(size=(20, 3))
    whole = estimator.estimate(missing, hands, BOX + rise, acceleration, 0.1, 0.1)
    single = [
        estimator.estimate(float(m), h, b, a, 0.1, 0.1)
        for m, h, b, a in zip(missing, hands, BOX + rise, acceleration, strict=True)
    ]
    assert np.array_equal(whole, single)
    assert np.ptp(whole[:, :, 2].sum(axis=1)) > 50.0


# The first example may have to compile.
@settings(deadline=None)
@given(share=st.floats(0.0, 1.0))
def test_shares_balance_the_moment_of_the_weight(share):
    box = HANDS[1] + share * (HANDS[0] - HANDS[1])
    right = split(HANDS.copy(), box)
    moment = right * (HANDS[0] - box) + (1.0 - right) * (HANDS[1] - box)
    assert moment == pytest.approx(np.zeros(3), abs=1e-12)


def test_shares_stay_between_the_hands():
    assert split(HANDS.copy(), np.array([0.4, -0.5, 0.1])) == 1.0
    assert split(HANDS.copy(), np.array([0.4, 0.5, 0.1])) == 0.0
    assert split(np.zeros((2, 3)), BOX) == 0.5


@pytest.mark.parametrize(
    ('mass', 'size', 'words'),
    [
        (-1.0, SIZE, 'box_mass'),
        (np.nan, SIZE, 'box_mass'),
        (1.0, (0.1, 0.1), 'box_size'),
        (1.0, (0.1, -0.1, 0.1), 'box_size'),
    ],
)
def test_impossible_boxes_are_refused(mass, size, words):
    with pytest.raises(HandForceError, match=words):
        HandForceEstimator(mass, size)


def test_blends_need_positive_lengths():
    with pytest.raises(HandForceError, match='free_rise'):
        HandForceSettings(free_rise=0.0)
