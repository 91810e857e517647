# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Infeasible tasks: what breaks first, and what can be done instead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.report import SolveReport, SolveStatus
from human_model.task import Box
from lift_predictor.core.models.sagittal.way import StraightWay
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.nearest_lift import (
    PLACE_TOLERANCE,
    NearestLift,
    first_limit,
    missing_way,
    relax_placement,
    with_nearest,
)
from lift_predictor.core.problem.prediction import Prediction

SIZE = (0.238, 0.305, 0.127)


@pytest.fixture(scope='module')
def too_heavy(subject, predictor, make_lift):
    return predictor.predict(subject, make_lift(7.0), Box(40.0, SIZE))


def test_too_heavy_a_box_names_a_torque_and_the_mass_that_can_be_lifted(too_heavy) -> None:
    report, nearest = too_heavy.report, too_heavy.nearest
    assert report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert too_heavy.lift is None
    assert nearest is not None
    assert 'joint torque limit (4.2)' in nearest.limit
    assert nearest.limit in report.message
    mass = nearest.prediction.box_mass
    assert 5.0 < mass < 40.0
    assert f'{mass:.2f} kg instead of 40.00 kg' in report.message
    assert nearest.prediction.report.ok
    assert nearest.prediction.verification.passed
    assert nearest.prediction.lift.box_mass == mass


def test_the_nearest_mass_can_be_lifted_and_a_little_more_cannot(
    subject, predictor, make_lift, too_heavy
) -> None:
    # Before the margin between the nodes.
    mass = max(run.box_mass for run in too_heavy.nearest.prediction.runs)
    lighter = predictor.predict(subject, make_lift(7.0), Box(0.97 * mass, SIZE))
    assert lighter.report.ok, lighter.report.message
    assert lighter.nearest is None
    heavier = predictor.predict(subject, make_lift(7.0), Box(1.03 * mass, SIZE))
    assert heavier.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert heavier.nearest.prediction.box_mass == pytest.approx(mass, rel=0.02)


@pytest.mark.parametrize(
    ('shift', 'words'),
    [((0.0, 0.0, 0.6), 'mm lower than asked for'), ((0.5, 0.0, 0.0), 'mm nearer than asked for')],
)
def test_places_out_of_reach_give_the_nearest_that_can_be_reached(
    subject, predictor, make_lift, shift, words
) -> None:
    lift = make_lift(7.0)
    recorded = lift.motion.box_position[-1]
    result = predictor.predict(subject, lift, Box(7.0, SIZE, end=recorded + shift))
    assert result.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    assert result.lift is None
    assert words in result.report.message
    assert 'the start' not in result.nearest.change
    reached = result.nearest.prediction
    assert reached.report.ok
    assert reached.verification.passed
    way = reached.lift.motion.box_position[-1] - recorded
    share = np.linalg.norm(way) / np.linalg.norm(shift)
    assert 0.0 < share < 1.0
    np.testing.assert_allclose(way, share * np.array(shift), atol=1e-4)
    missing = 1e3 * (1.0 - share) * np.linalg.norm(shift)
    stated = float(result.nearest.change.split(' mm')[0].split()[-1])
    assert stated == pytest.approx(missing, abs=1.0)


def test_too_weak_for_the_posture_alone_has_no_nearest_lift(subject, make_lift) -> None:
    weak = LiftPredictor()
    result = weak.predict(replace(subject, strength_z=-2.0), make_lift(7.0), Box(7.0, SIZE))
    assert result.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert result.nearest is None
    assert 'largest violation' in result.report.message


def outcome(status: SolveStatus = SolveStatus.OK, message: str = '') -> Prediction:
    report = SolveReport(status, message)
    return Prediction(model='sagittal', lift_id='lift', box_mass=7.0, duration=1.0, report=report)


def test_bisection_ends_within_its_tolerance() -> None:
    border, length = 0.637, 0.8
    way = StraightWay((0.0, 0.0, 0.0), (length, 0.0, 0.0))
    tried = []

    def attempt(share: float) -> Prediction:
        tried.append(share)
        if share <= border:
            return outcome()
        return outcome(SolveStatus.PREDICTOR_UNREACHABLE, f'arm too short: at {share:g}')

    nearest = relax_placement(attempt, attempt(1.0), {'end': way})
    missing = float(nearest.change.split(' mm')[0].removeprefix('the end ')) / 1e3
    assert 0.0 <= border * length - (length - missing) <= PLACE_TOLERANCE + 1e-3
    assert nearest.limit.startswith('reach of the hands (arm too short; at 0.6')
    assert len(tried) <= 2 + np.log2(length / PLACE_TOLERANCE) + 1


def test_no_nearest_place_if_the_recorded_one_fails() -> None:
    failed = outcome(SolveStatus.PREDICTOR_INFEASIBLE, 'no')
    ways = {'end': StraightWay((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))}
    assert relax_placement(lambda fraction: failed, failed, ways) is None
    assert relax_placement(lambda fraction: outcome(), failed, {}) is None
    assert with_nearest(failed, None) is failed


def test_a_solver_that_gave_up_on_an_infeasible_task_is_corrected() -> None:
    failed = outcome(SolveStatus.PREDICTOR_NOT_CONVERGED, 'IPOPT: Restoration_Failed')
    better = with_nearest(failed, NearestLift('balance (4.3)', '3 kg instead of 7 kg', outcome()))
    assert better.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    for words in ('balance (4.3) breaks first', '3 kg instead of 7 kg', 'Restoration_Failed'):
        assert words in better.report.message


def test_limits_of_the_person_come_before_postures_of_the_recording() -> None:
    posture = 'posture (4.8) of hip_flexion at the start'
    assert first_limit([posture, 'balance (4.3)']) == 'balance (4.3)'
    assert first_limit([posture]) == posture
    assert first_limit([]) == 'none'


def test_missing_way_in_words() -> None:
    none, here = (0.0, 0.0, 0.0), StraightWay((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    ways = {'start': here, 'end': StraightWay(none, (-0.1, 0.0, 0.4))}
    assert missing_way(ways, 0.75) == (
        'the end 25 mm farther forward and 100 mm lower than asked for'
    )
    assert missing_way({'start': here}, 0.5) == 'the same places to half a millimetre'
