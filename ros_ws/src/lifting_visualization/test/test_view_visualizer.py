# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What is in the picture when: rates, statuses, loads that come late, ghosts."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from lifting_visualization.core.ghost import GHOST, GHOST_LOAD
from lifting_visualization.core.shapes import Kind
from lifting_visualization.core.spine_loads import SpineLoads
from lifting_visualization.core.tables import colours
from lifting_visualization.core.visualizer import GROUND, PATHS, PERSON, SPINE


def by_place(shapes):
    """Return shapes by layer and number; no place is drawn twice."""
    found = {(shape.layer, shape.number): shape for shape in shapes}
    assert len(found) == len(shapes)
    return found


def lift(skeleton, duration=1.0, n=11):
    """Return a motion in which the person rises by 0.2 m in a straight line."""
    time = 5.0 + np.linspace(0.0, duration, n)
    q = np.tile(skeleton.standing(), (n, 1))
    q[:, skeleton.index('pelvis_ty')] += np.linspace(0.0, 0.2, n)
    return skeleton.body_motion(time, q, 0.0 * q, 0.0 * q)


def test_pictures_come_at_the_rate_and_begin_anew_when_time_goes_back(visualizer, motion_at):
    drawn = [k for k in range(100) if visualizer.picture(motion_at(k / 100), 0)]
    assert drawn == list(range(0, 100, 2))
    assert visualizer.picture(motion_at(0.0), 0)


def test_forces_of_a_sample(visualizer, motion_at):
    found = by_place(visualizer.picture(motion_at(1.0), 0))
    np.testing.assert_allclose(found[GROUND, 0].points, [[0.05, -0.1, 0.0], [0.05, -0.1, 0.6]])
    assert found[GROUND, 1].kind is Kind.NOTHING
    assert found[PERSON, 0].colour == colours()['person']


def test_what_was_not_solved_is_grey_and_has_no_forces(visualizer, motion_at):
    found = by_place(visualizer.picture(motion_at(1.0), int(SolveStatus.TRACKER_FILTER_SETTLING)))
    assert found[PERSON, 0].colour == colours()['not_solved']
    assert found[GROUND, 0].kind is found[GROUND, 1].kind is Kind.NOTHING


def loads(time, compression):
    """Return loads of n samples on a level disc that rises by 0.01 m a sample from 1 m."""
    n = len(time)
    position = np.zeros((n, 3))
    position[:, 2] = 1.0 + 0.01 * np.arange(n)
    return SpineLoads(
        np.asarray(time, float),
        np.asarray(compression, float),
        position,
        np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)),
    )


def test_a_late_load_is_drawn_where_the_disc_was(visualizer, motion_at, skeleton):
    visualizer.picture(motion_at(1.0), 0)
    q = skeleton.standing() + 0.1
    visualizer.picture(skeleton.body_motion(1.01, q, 0 * q, 0 * q), 0)
    leant = loads([1.0], [3500.0])._replace(
        position=np.array([[0.2, -0.1, 0.9]]), orientation=np.array([[0.0, 0.6, 0.0, 0.8]])
    )
    found = by_place(visualizer.load_picture(leant))
    tail, tip = found[SPINE, 0].points
    np.testing.assert_allclose(tip, [0.2, -0.1, 0.9])
    np.testing.assert_allclose(tail - tip, 0.35 * np.array([0.96, 0.0, 0.28]), atol=1e-12)
    assert found[SPINE, 0].colour == colours()['above_action']
    assert found[SPINE, 1].text == '3500 N'


def test_a_load_that_is_not_good_has_no_arrow(visualizer):
    shapes = visualizer.load_picture(loads([1.0], [np.nan]))
    assert {shape.kind for shape in shapes} == {Kind.NOTHING}


def test_an_old_arrow_is_taken_away(visualizer, motion_at):
    visualizer.picture(motion_at(1.0), 0)
    visualizer.load_picture(loads([1.0], [3500.0]))
    assert (SPINE, 0) not in by_place(visualizer.picture(motion_at(1.1), 0))
    assert by_place(visualizer.picture(motion_at(1.3), 0))[SPINE, 0].kind is Kind.NOTHING


def test_the_same_person_again_changes_nothing(visualizer, woman, skeleton):
    visualizer.set_predicted('lift_001', lift(skeleton), 10.0)
    assert not visualizer.set_subject(woman)
    assert visualizer.ghost is not None
    before = visualizer.urdf
    assert visualizer.set_subject(replace(woman, mass=70.0))
    assert visualizer.ghost is None
    assert visualizer.urdf != before


def test_links_follow_the_motion(visualizer, motion_at, skeleton):
    places = visualizer.transforms(motion_at(1.0))
    assert places.shape == (40, 7)
    assert places[:3, :3].sum() == pytest.approx(skeleton.standing_height)


def test_ghost_is_played_in_a_loop_with_a_pause(visualizer, skeleton):
    motion = lift(skeleton)
    visualizer.set_predicted('lift_001', motion, 10.0)
    samples = [visualizer.ghost.sample(t) for t in (0.0, 0.5, 0.999, 1.2, 1.499, 1.5, 2.0)]
    assert samples == [0, 5, 10, 10, 10, 0, 5]
    found = by_place(visualizer.ghost_picture(0.5))
    np.testing.assert_array_equal(found[GHOST, 1].points, motion.points[5])
    assert '10 kg' in found[GHOST, 3].text
    assert found[GHOST_LOAD, 0].kind is Kind.NOTHING


@pytest.mark.parametrize('load_first', [True, False])
def test_load_of_the_predicted_lift_comes_before_or_after_it(visualizer, skeleton, load_first):
    motion = lift(skeleton)
    steps = [
        lambda: visualizer.set_predicted('lift_002', motion, 10.0),
        lambda: visualizer.set_predicted_load(
            'lift_002', loads(motion.time, np.linspace(3000.0, 4000.0, 11))
        ),
    ]
    for step in steps[::-1] if load_first else steps:
        step()
    found = by_place(visualizer.ghost_picture(0.5))
    assert found[GHOST_LOAD, 1].text == '3500 N'
    np.testing.assert_allclose(found[GHOST_LOAD, 0].points, [[0.0, 0.0, 1.4], [0.0, 0.0, 1.05]])


def test_load_of_another_lift_is_not_shown(visualizer, skeleton):
    motion = lift(skeleton)
    visualizer.set_predicted('lift_001', motion, 10.0)
    visualizer.set_predicted_load('lift_002', loads(motion.time, np.full(11, 9e3)))
    assert by_place(visualizer.ghost_picture(0.5))[GHOST_LOAD, 0].kind is Kind.NOTHING


def test_a_failed_prediction_takes_the_ghost_away(visualizer, skeleton):
    visualizer.set_predicted('lift_001', lift(skeleton), 10.0)
    shapes = visualizer.set_predicted('lift_002', None, 10.0)
    assert {shape.kind for shape in shapes} == {Kind.NOTHING}
    places = set(by_place(shapes))
    assert visualizer.ghost_picture(0.0) == []
    visualizer.set_predicted('lift_003', lift(skeleton), 10.0)
    drawn = by_place(
        [
            *visualizer.ghost_picture(0.0),
            *visualizer.set_predicted('lift_003', lift(skeleton), 10.0),
        ]
    )
    assert set(drawn) == places


def test_paths_of_the_hands(visualizer, skeleton):
    motion = lift(skeleton)
    report = SolveReport(SolveStatus.OK, '', 0, 0.0, 0.0, 0.0, 0.0, 0.0)
    (recorded,) = visualizer.set_measured(
        Lift('lift_001', 'measured', 5.0, 6.0, 10.0, motion, report)
    )
    middle = 0.5 * (motion.point('hand_r') + motion.point('hand_l'))
    np.testing.assert_allclose(recorded.points[[0, -1]], middle[[0, -1]])
    (predicted,) = visualizer.set_predicted('lift_001', motion, 10.0)
    assert {(s.layer, s.number) for s in (recorded, predicted)} == {(PATHS, 0), (PATHS, 1)}
