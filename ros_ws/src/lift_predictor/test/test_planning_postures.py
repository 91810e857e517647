# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""End postures without a recording, techniques, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lift_predictor.core.exceptions import PlanError, UnreachableError
from lift_predictor.core.least_squares import minimise
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.lowering import stoop_squat_index
from lift_predictor.core.models.sagittal.plan import build_plan, plan_parameters
from lift_predictor.core.planning.plan_task import DEFAULT_DURATION, PlanTask
from lift_predictor.core.planning.technique import technique, techniques

TASK = PlanTask(
    'shelf', 12.0, (0.238, 0.305, 0.127), (0.35, 0.0, 0.1135), (0.55, 0.0, 0.9635), feet=(0.0, 0.0)
)


def test_least_squares_finds_rosenbrocks_valley_and_stops_at_a_bound() -> None:
    def rosenbrock(x):
        return np.column_stack((10.0 * (x[:, 1] - x[:, 0] ** 2), 1.0 - x[:, 0]))

    wide = np.full(2, 5.0)
    free = minimise(rosenbrock, np.array([-1.2, 1.0]), -wide, wide)
    np.testing.assert_allclose(free, [1.0, 1.0], atol=1e-5)
    held = minimise(rosenbrock, np.array([-1.2, 1.0]), -wide, np.array([0.5, 5.0]))
    np.testing.assert_allclose(held, [0.5, 0.25], atol=1e-5)


def test_index_is_zero_for_bent_legs_and_hundred_for_a_leaning_trunk(person) -> None:
    parameters = plan_parameters(person, TASK, 0.0)
    legs = np.radians([0.0, 0.0, 0.0, 60.0, 100.0, 40.0])  # pelvis stays level
    trunk = np.radians([-60.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    index = stoop_squat_index(np.stack((legs, trunk, np.zeros(6))), person, parameters)
    assert index[0] == pytest.approx(0.0, abs=1e-9)
    assert index[1] == pytest.approx(100.0, abs=1e-9)
    assert np.isnan(index[2])


def test_techniques_cover_the_index_without_overlap() -> None:
    squat, semi, stoop = (technique(name) for name in ('squat', 'semi_squat', 'stoop'))
    assert (squat.lower, stoop.upper) == (0.0, 100.0)
    assert squat.upper == semi.lower
    assert semi.upper == stoop.lower
    assert all(entry.source for entry in techniques().values())
    assert technique('free').holds(float('nan'))


@pytest.mark.parametrize('name', ['squat', 'semi_squat', 'stoop'])
def test_window_of_a_technique_lies_round_a_posture_of_it(person, name: str) -> None:
    plan = build_plan(person, replace(TASK, technique=name, end_posture='upright'))
    bounds = plan.task.bounds
    assert np.all(np.isfinite(bounds.posture_lower[[0, 2]]))
    assert np.all(np.isinf(bounds.posture_lower[1]))
    for pair in plan.ends:
        index = stoop_squat_index(pair[:1], person, plan.task.parameters)[0]
        assert technique(name).holds(index)
        assert np.all(pair >= bounds.posture_lower[[0, 2]])
        assert np.all(pair <= bounds.posture_upper[[0, 2]])


@settings(max_examples=20, deadline=None)
@given(
    low=st.floats(0.1, 0.7),
    high=st.floats(0.7, 1.4),
    begin=st.floats(0.37, 0.5),
    finish=st.floats(0.37, 0.55),
)
def test_end_postures_hold_the_box_clear_and_in_balance(person, low, high, begin, finish) -> None:
    task = replace(TASK, start=(begin, 0.0, low), end=(finish, 0.0, high))
    plan = build_plan(person, task)
    assert np.all(np.isinf(plan.task.bounds.posture_lower))
    rear, front = plan.task.parameters.support
    for pair in plan.ends:
        state = chain_positions(pair, plan.task.parameters)
        np.testing.assert_allclose(state.joints['hand'], plan.task.bounds.hand, atol=1e-4)
        assert state.gaps.min() > -1.1e-3
        assert rear - 1.1e-3 <= state.centre_of_mass.min()
        assert state.centre_of_mass.max() <= front + 1.1e-3
        assert np.all(pair >= person.angle_lower)
        assert np.all(pair <= person.angle_upper)


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        ({'end': (0.5, 0.0, 2.6)}, r'task\.end: .*mm away'),
        ({'start': (1.6, 0.0, 0.1)}, r'task\.start: '),
        ({'start': (0.0, 0.0, 0.1)}, r'task\.start: .*(deep in the body|mm away)'),
    ],
)
def test_place_out_of_reach_is_named(person, change, words: str) -> None:
    with pytest.raises(UnreachableError, match=words):
        build_plan(person, replace(TASK, **change))


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        ({'box_mass': -1.0}, r'task\.box_mass: -1'),
        ({'box_mass': '7'}, r"task\.box_mass: .*'7'"),
        ({'box_size': (0.0, 0.3, 0.1)}, r'task\.box_size'),
        ({'start': (0.4, 0.0, 0.01)}, r'task\.start: .*under the floor'),
        ({'end': (0.4, float('nan'), 1.0)}, r'task\.end: .*nan'),
        ({'end': (0.4, 1.0)}, r'task\.end: 3 numbers'),
        ({'feet': (0.0,)}, r'task\.feet'),
        ({'duration': 0.0}, r'task\.duration: 0 s'),
        ({'technique': 'deadlift'}, r"task\.technique: 'deadlift'"),
        ({'end_posture': 'kneeling'}, r"task\.end_posture: 'kneeling'"),
        ({'name': ' '}, r'task\.name'),
    ],
)
def test_bad_field_is_named(change, words: str) -> None:
    with pytest.raises(PlanError, match=words):
        replace(TASK, **change)


def test_box_at_the_side_is_refused_with_its_angle(person) -> None:
    with pytest.raises(PlanError, match=r'task\.start, task\.end: .* 45 deg'):
        build_plan(person, replace(TASK, end=(0.5, 0.5, 1.0)))


def test_defaults() -> None:
    assert TASK.duration == DEFAULT_DURATION == 1.32
    assert (TASK.technique, TASK.end_posture) == ('free', 'free')
