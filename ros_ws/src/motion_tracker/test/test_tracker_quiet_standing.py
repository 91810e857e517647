# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Quiet standing: which frames count, and what is missing for balance."""

import numpy as np
import pytest

from human_model import compiled
from human_model.constants import GRAVITY
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.quiet_standing import coordinates_of, find_quiet_standing, missing_moment

RATE = 100.0
TIME = np.arange(0.0, 3.0, 1.0 / RATE)
SWAY = 2.0 * np.pi * 0.4


def swaying(skeleton, depth=0.0):
    """Return coordinates of a body that sways about its hips by 1 degree, in a squat if deep."""
    values = {
        'hip_flexion_r': depth,
        'hip_flexion_l': depth,
        'knee_angle_r': depth,
        'knee_angle_l': depth,
    }
    q = np.tile(skeleton.vector(values, skeleton.standing()), (len(TIME), 1))
    q[:, skeleton.index('pelvis_tilt')] += np.radians(1.0) * np.sin(SWAY * TIME)
    return q


def ground(skeleton, q):
    """Return force and moment about the origin that this motion needs from the ground."""
    wave = np.zeros_like(q)
    wave[:, skeleton.index('pelvis_tilt')] = np.radians(1.0)
    rate = wave * (SWAY * np.cos(SWAY * TIME))[:, None]
    acceleration = -wave * (SWAY**2 * np.sin(SWAY * TIME))[:, None]
    forces, moments = [], []
    nothing = np.zeros((len(skeleton.segments), 6))
    for row in zip(q, rate, acceleration, strict=True):
        tau = compiled.newton_euler(skeleton.tree, *(a.copy() for a in row), nothing, GRAVITY)
        _, origin, axis = compiled.body_frames(skeleton.tree, row[0].copy())
        force = np.array([tau[0], -tau[2], tau[1]])
        forces.append(force)
        moments.append(np.linalg.solve(axis[3:6], tau[3:6]) + np.cross(origin[5], force))
    return np.array(forces), np.array(moments)


def test_nothing_is_missing_when_the_ground_gives_what_the_motion_needs(skeleton):
    q = swaying(skeleton)
    force, moment = ground(skeleton, q)
    standing = find_quiet_standing(skeleton, RATE, q, force)
    assert len(standing.frames) >= 0.8 * len(TIME)
    missing = missing_moment(skeleton, standing, force[standing.frames], moment[standing.frames])
    # What the filter takes off the sway: 0.2 N m are 0.3 mm of the centre of pressure.
    assert np.abs(missing).max() < 0.2


def test_ground_that_pushes_elsewhere_is_missed(skeleton):
    q = swaying(skeleton)
    force, moment = ground(skeleton, q)
    standing = find_quiet_standing(skeleton, RATE, q, force)
    off = np.cross([0.012, -0.005, 0.0], force)
    moved = moment - off
    missing = missing_moment(skeleton, standing, force[standing.frames], moved[standing.frames])
    assert missing == pytest.approx(off[standing.frames], abs=0.2)


def test_frames_without_markers_are_left_out(skeleton):
    q = swaying(skeleton)
    force, _ = ground(skeleton, q)
    q[100:120] = np.nan
    standing = find_quiet_standing(skeleton, RATE, q, force)
    assert not set(standing.frames) & set(range(100, 120))
    assert np.isfinite(standing.q).all()


@pytest.mark.parametrize(('depth', 'load'), [(1.0, 1.0), (0.0, 1.1)])
def test_squatting_and_carrying_is_not_quiet_standing(skeleton, depth, load):
    q = swaying(skeleton, depth)
    force, _ = ground(skeleton, q)
    with pytest.raises(TrackerError, match=r'quiet standing: 0\.00 s'):
        find_quiet_standing(skeleton, RATE, q, load * force)


def test_real_squats_have_pauses(squats):
    """Of 13.5 s some 3 s are quiet; the same is missing in each pause within 4 mm."""
    skeleton, q = coordinates_of(squats.subject, squats.marker_set, squats.names, squats.markers)
    force, moment = (
        np.sum([parts[k] for parts in squats.wrenches.values()], axis=0) for k in (0, 1)
    )
    # The mass entered there is 4 % above what the plates carry.
    scale = skeleton.total_mass / 60.1
    standing = find_quiet_standing(skeleton, RATE, q, scale * force)
    assert 2.0 < len(standing.frames) / RATE < 4.0
    missing = missing_moment(
        skeleton, standing, scale * force[standing.frames], scale * moment[standing.frames]
    )
    assert (missing[:, :2] / (skeleton.total_mass * GRAVITY)).std(axis=0).max() < 4e-3
