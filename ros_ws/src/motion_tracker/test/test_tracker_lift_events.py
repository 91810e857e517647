# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Start and end of a lift: exact on clean paths, near on noisy ones, the same live and offline."""

import numpy as np
import pytest

from motion_tracker.core.exceptions import LiftEventError
from motion_tracker.core.lifts.lift_events import (
    LiftEventDetector,
    LiftEventSettings,
    LiftPhase,
    _parabola_at_zero,
    detect_lifts,
)

RATE = 100.0


def minimum_jerk(time, rise, duration):
    s = np.clip(time / duration, 0.0, 1.0)
    return rise * (10 * s**3 - 15 * s**4 + 6 * s**5)


def steady_push(time, rise, duration):
    """Constant acceleration, then constant deceleration."""
    t = np.clip(time, 0.0, duration)
    a = 4 * rise / duration**2
    return np.where(t < duration / 2, 0.5 * a * t**2, rise - 0.5 * a * (duration - t) ** 2)


def over_the_edge(time, rise, duration):
    """Up past the platform, slowed to a stop, and down on it by 5 cm."""
    return minimum_jerk(time, rise + 0.05, duration) - minimum_jerk(time - duration, 0.05, 0.4)


def recording(path, rise, duration, noise, seed):
    rng = np.random.default_rng(seed)
    late = rng.uniform(0.0, 1.0 / RATE)
    time = 1e9 + np.arange(-1.0, duration + 1.5, 1.0 / RATE)
    height = 0.1 + path(time - 1e9 - late, rise, duration) + rng.normal(0.0, noise, time.shape)
    return time, height, 1e9 + late, 1e9 + late + duration


@pytest.mark.parametrize(
    ('path', 'noise', 'tolerance'),
    [
        (minimum_jerk, 0.0, 0.010),
        (minimum_jerk, 5e-4, 0.020),
        (over_the_edge, 0.0, 0.010),
        (over_the_edge, 5e-4, 0.020),
        (steady_push, 0.0, 0.010),
    ],
)
@pytest.mark.parametrize(('rise', 'duration'), [(0.9, 1.2), (0.8, 1.5), (1.0, 1.9)])
def test_start_and_end_are_found(path, noise, tolerance, rise, duration):
    for seed in range(5 if noise else 1):
        time, height, start, end = recording(path, rise, duration, noise, seed)
        first, last = detect_lifts(time, height)
        assert (first.phase, last.phase) == (LiftPhase.START, LiftPhase.END)
        assert abs(first.time - start) <= tolerance, seed
        assert abs(last.time - end) <= tolerance, seed
        assert first.height == pytest.approx(0.1, abs=2e-3)


def test_live_and_offline_give_the_same_events():
    time, height, _, _ = recording(over_the_edge, 0.9, 1.4, 5e-4, 3)
    detector = LiftEventDetector()
    live = []
    for t, z in zip(time, height, strict=True):
        for event in detector.push(float(t), float(z)):
            assert event.time + event.detection_delay == pytest.approx(t)
            live.append(event)
    offline = detect_lifts(time, height)
    assert live == offline
    assert [event.phase for event in live] == [LiftPhase.START, LiftPhase.END]
    assert all(0.0 < event.detection_delay < 0.6 for event in live)


def test_long_recordings_forget_their_past_without_changing_events():
    single, height, *_ = recording(minimum_jerk, 0.8, 1.2, 3e-4, 1)
    time = np.concatenate([single + 20.0 * k for k in range(6)])
    heights = np.tile(height, 6)
    detector = LiftEventDetector(history=5.0)
    live = [
        e for t, z in zip(time, heights, strict=True) for e in detector.push(float(t), float(z))
    ]
    live += detector.finish()
    assert live == detect_lifts(time, heights)
    assert [event.number for event in live] == [k for k in range(1, 7) for _ in range(2)]
    assert [event.phase for event in live] == [LiftPhase.START, LiftPhase.END] * 6


def test_a_box_at_rest_is_never_lifted():
    rng = np.random.default_rng(8)
    time = np.arange(6000) / RATE
    assert detect_lifts(time, 0.1 + rng.normal(0.0, 1e-3, time.shape)) == []


def test_rises_below_the_minimum_are_no_lift():
    time = np.arange(400) / RATE
    height = minimum_jerk(time - 1.0, 0.04, 0.5)
    assert detect_lifts(time, height) == []
    assert len(detect_lifts(time, height, settings=LiftEventSettings(minimum_rise=0.02))) == 2


def test_raised_arms_are_no_lift_but_a_squat_is():
    """From the hands: the shoulders must rise with them."""
    time = np.arange(500) / RATE
    arms = minimum_jerk(time - 1.0, 0.5, 0.8)
    assert detect_lifts(time, arms, np.full_like(arms, 1.4)) == []
    both = detect_lifts(time, arms, 1.0 + 0.4 * arms)
    assert [event.phase for event in both] == [LiftPhase.START, LiftPhase.END]


def test_turning_point_without_rest_is_the_start():
    """Hands that go down and up again without a pause: the lowest point."""
    time = np.arange(600) / RATE
    height = 0.6 + 0.3 * np.cos(2 * np.pi * time / 3.0)
    events = detect_lifts(time, height)
    assert events[0].time == pytest.approx(1.5, abs=2e-3)
    assert events[1].time == pytest.approx(3.0, abs=2e-3)


def test_second_local_maximum_does_not_count():
    """Thesis 4.3: the first local maximum ends the lift, a later higher one does not."""
    time = np.arange(600) / RATE
    height = (
        minimum_jerk(time - 1.0, 0.6, 1.0)
        - minimum_jerk(time - 2.0, 0.1, 0.5)
        + minimum_jerk(time - 2.5, 0.02, 0.5)
    )
    events = detect_lifts(time, height)
    assert events[1].time == pytest.approx(2.0, abs=0.01)
    assert len(events) == 2


def test_lost_samples_do_not_matter():
    time, height, start, end = recording(minimum_jerk, 0.9, 1.4, 3e-4, 2)
    keep = np.random.default_rng(0).random(time.shape) > 0.1
    keep[:5] = True
    holed = np.where(keep, height, np.nan)
    first, last = detect_lifts(time, holed)
    assert abs(first.time - start) < 0.02
    assert abs(last.time - end) < 0.02


def test_bad_settings_and_unsorted_stamps_are_refused():
    with pytest.raises(LiftEventError, match='rest_speed'):
        LiftEventSettings(rest_speed=0.0)
    detector = LiftEventDetector()
    detector.push(1.0, 0.1)
    with pytest.raises(LiftEventError, match='does not follow'):
        detector.push(1.0, 0.1)
    with pytest.raises(LiftEventError, match='one shape'):
        detect_lifts(np.arange(3), np.arange(4))


@pytest.mark.parametrize('samples', [4, 9, 11])
def test_parabola_is_that_of_least_squares(samples):
    rng = np.random.default_rng(samples)
    t, z = np.sort(rng.uniform(-1.0, 1.0, samples)), rng.normal(size=samples)
    height_and_slope = np.polynomial.polynomial.polyfit(t, z, 2)[:2]
    assert _parabola_at_zero(t.tolist(), z.tolist()) == pytest.approx(tuple(height_and_slope))
