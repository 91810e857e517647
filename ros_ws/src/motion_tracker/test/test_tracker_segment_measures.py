# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The depth of the pelvis from its iliac spines, and what it does to the trunk."""

import numpy as np
import pytest

from human_model.anthropometry import segment_lengths
from human_model.skeletons import Skeleton3D
from motion_tracker.core.calibration import calibrate
from motion_tracker.core.markers.marker_set import available, load_marker_set
from motion_tracker.core.markers.segment_measures import measured_lengths

FRONT_AND_BACK = {
    'plug_in_gait_58': (('RASI', 'LASI'), ('RPSI', 'LPSI')),
    'opencap_lab_51': (('r.ASIS', 'L.ASIS'), ('r.PSIS', 'L.PSIS')),
    'plug_in_gait_39': (('RASI', 'LASI'), ('RPSI', 'LPSI')),
}


def stretched(markers, marker_set, by):
    """Return the markers with the spines' distances stretched about the middle of each side."""
    moved = dict(markers)
    for front, back in zip(*FRONT_AND_BACK[marker_set.name], strict=True):
        middle = (markers[front] + markers[back]) / 2
        moved[front] = middle + by * (markers[front] - middle)
        moved[back] = middle + by * (markers[back] - middle)
    return moved


def test_every_marker_set_measures_the_pelvis():
    assert set(available()) == set(FRONT_AND_BACK)


@pytest.mark.parametrize('name', sorted(FRONT_AND_BACK))
@pytest.mark.parametrize('by', [0.9, 1.0, 1.15])
def test_depth_goes_with_the_distance_of_the_spines(person, name, by):
    marker_set, predicted = load_marker_set(name), segment_lengths(person)[0]
    markers = stretched(marker_set.positions(predicted), marker_set, by)
    found = measured_lengths(marker_set, markers, predicted)
    assert found == {'pelvis_depth': pytest.approx(by * predicted['pelvis_depth'])}


def test_no_depth_without_all_spines(person):
    marker_set, predicted = load_marker_set('plug_in_gait_58'), segment_lengths(person)[0]
    markers = marker_set.positions(predicted)
    del markers['LPSI']
    assert measured_lengths(marker_set, markers, predicted) == {}


def standing(person, marker_set, by):
    """Return names and positions (frames, n, 3) of a person standing with stretched pelvis."""
    skeleton = Skeleton3D.of(person)
    frames = skeleton.forward(skeleton.standing())
    markers = stretched(marker_set.positions(skeleton.parameters.lengths), marker_set, by)
    names = tuple(markers)
    at = [skeleton.segments.index(marker_set.marker(name).segment) for name in names]
    world = [
        frames[i, :3, :3] @ markers[n] + frames[i, :3, 3] for i, n in zip(at, names, strict=True)
    ]
    return names, np.tile(world, (5, 1, 1))


def trunk(lengths):
    """Return the distance from mid-hip to mid-shoulder, trunk straight [m]."""
    return np.hypot(
        *(
            sum(lengths[f'{part}_{to}'] for part in ('l5s1', 't12l1', 'shoulder'))
            for to in ('forward', 'height')
        )
    )


def test_deeper_pelvis_leaves_the_trunk_its_length(person):
    """Hip centres and shoulders stay: opencap_lab_51 has hip centres as markers of their own."""
    marker_set = load_marker_set('opencap_lab_51')
    skeleton = Skeleton3D.of(person)
    hips = {
        f'{side}_HJC': skeleton.points(skeleton.standing())[f'hip_{side.lower()}'] for side in 'RL'
    }
    found = []
    for by in (1.0, 1.1):
        names, positions = standing(person, marker_set, by)
        names += tuple(hips)
        extra = np.tile(list(hips.values()), (len(positions), 1, 1))
        calibrated = calibrate(marker_set, names, np.concatenate([positions, extra], 1), person)
        found.append(calibrated.calibration.lengths)
    usual, deep = found
    assert deep['pelvis_depth'] == pytest.approx(1.1 * usual['pelvis_depth'])
    assert trunk(deep) == pytest.approx(trunk(usual), abs=1e-9)
    own = segment_lengths(person)[0]
    assert trunk(usual) == pytest.approx(trunk(own), rel=1e-6)
    assert usual['l5s1_height'] == pytest.approx(own['l5s1_height'], rel=1e-6)
    # The pelvis below the sacrum grows by a tenth, sacrum and spine give way by one factor.
    below = [
        [lengths[f'l5s1_{to}'] - lengths[f'sacrum_{to}'] for to in ('forward', 'height')]
        for lengths in found
    ]
    assert below[1] == pytest.approx(1.1 * np.array(below[0]))
    shares = [
        deep[name] / usual[name]
        for name in ('sacrum_height', 't12l1_height', 'shoulder_height', 'shoulder_forward')
    ]
    assert shares == pytest.approx([shares[0]] * 4)
    assert 0.97 < shares[0] < 1.0
