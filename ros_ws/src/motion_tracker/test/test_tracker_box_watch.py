# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Place of the box by its pose, by the hands that carry it, and where it was at rest."""

import numpy as np
import pytest

from motion_tracker.core.forces.box_watch import BoxWatch

OFFSET = np.array([0.05, 0.0, -0.1])


def carry(change, frames=100, noise=0.0005, speed=1.0):
    """Hands rise at a speed with a box; return true and found places (n, 3), and the doubts."""
    rng = np.random.default_rng(4)
    watch = BoxWatch()
    true, found, doubts = [], [], []
    for k in range(frames):
        hands = np.array([0.4, 0.0, 0.5 + speed * 0.01 * k])
        box = hands + OFFSET
        place = watch.check(
            0.01 * k, change(k, box + rng.normal(0.0, noise, 3)), hands, k > 5, True
        )
        true.append(box)
        found.append(place.position)
        doubts.append(place.doubt)
    return np.array(true), np.array(found), doubts


def test_a_good_pose_is_used_as_it_is():
    poses = []
    _, found, doubts = carry(lambda k, box: poses.append(box) or box)
    assert np.array_equal(found, poses)
    assert not any(doubts)


@pytest.mark.parametrize(
    ('name', 'change'),
    [
        ('not seen', lambda k, box: None if 40 <= k < 80 else box),
        ('to the side', lambda k, box: box + [0.1, 0.0, 0.0] if 40 <= k < 60 else box),
        ('one stray', lambda k, box: box + [0.0, 0.0, 0.03] if k == 40 else box),
        ('another body', lambda k, box: np.zeros(3) if 40 <= k < 60 else box),
        ('frozen', lambda k, box: np.array([0.45, 0.0, 0.8]) if 40 <= k < 60 else box),
    ],
)
def test_a_box_in_the_hands_stays_there_when_its_pose_is_wrong(name, change):
    true, found, doubts = carry(change)
    assert np.abs(found - true).max() < 0.005
    assert any(doubts[40:42])
    assert doubts[45] or name == 'one stray'
    assert not any(doubts[:40])


def test_a_pose_that_stays_elsewhere_is_taken_without_a_step():
    """The marker body was redefined: the load sees no step of 50 mm."""
    _, found, doubts = carry(lambda k, box: box + [0.0, 0.0, 0.05] if k >= 40 else box)
    assert np.abs(np.diff(found[:, 2]) - 0.01).max() < 0.005
    assert doubts[50]
    assert not any(doubts[70:])


def test_noise_ends_the_use_of_the_pose():
    rng = np.random.default_rng(2)
    true, found, _ = carry(lambda k, box: box + rng.normal(0.0, 0.01, 3) * (k >= 20))
    assert np.abs(found - true)[30:].std() < 0.005


def test_a_box_that_was_never_seen_has_no_place():
    assert BoxWatch().check(0.0, None, np.zeros(3), False, False) is None


def test_a_box_at_rest_is_moved_after_confirmation():
    """A stray is left out; a box that somebody carried away while it was hidden is found."""
    watch, hands = BoxWatch(), np.array([0.0, 0.0, 1.5])
    place = np.array([0.4, 0.0, 0.2])
    for k in range(20):
        watch.check(0.01 * k, place, hands, False, False)
    stray = watch.check(0.2, place + [0.5, 0.0, 0.0], hands, False, False)
    assert np.array_equal(stray.position, place)
    assert 'm/s' in stray.doubt
    moved = [
        watch.check(0.21 + 0.01 * k, place + [0.0, 0.6, 0.0], hands, False, False)
        for k in range(30)
    ]
    assert np.array_equal(moved[0].position, place)
    assert np.array_equal(moved[-1].position, place + [0.0, 0.6, 0.0])
    assert sum(found.jumped for found in moved) == 1


def test_a_frozen_pose_is_found_before_the_box_counts_as_carried():
    watch, place = BoxWatch(), np.array([0.4, 0.0, 0.2])
    doubts = [
        watch.check(0.01 * k, place, place + [0.0, 0.0, 0.1 + 0.002 * k], False, True).doubt
        for k in range(20)
    ]
    assert not any(doubts[:10])
    assert all('while the hands at it rise' in doubt for doubt in doubts[12:])
