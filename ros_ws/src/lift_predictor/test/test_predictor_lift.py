# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifts of the dissertation's subject (7 and 12 kg), solved, verified and challenged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from human_model.report import SolveReport, SolveStatus
from human_model.skeleton import ExternalForce
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.models.sagittal.verify import TOLERANCE
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.run import Start

BOX_SIZE = (0.238, 0.305, 0.127)

MASSES = (0.0, 7.0, 12.0)


@pytest.mark.parametrize('mass', MASSES)
def test_solved_with_small_kkt_residuals_and_verified_between_the_nodes(outcome, mass) -> None:
    predicted = outcome(mass).predicted
    assert predicted.report.ok, predicted.report.message
    best = predicted.runs[0]
    assert best.solution.primal < 1e-7
    assert best.solution.dual < 1e-6
    assert best.solution.complementarity < 1e-6
    check = predicted.verification
    assert check is not None and check.n_points == 241
    assert set(check.violation) == set(TOLERANCE)
    for name, limit in TOLERANCE.items():
        assert check.violation[name] <= limit


@pytest.mark.parametrize('mass', MASSES)
def test_all_starts_end_at_the_same_optimum(outcome, mass) -> None:
    optima = {run.start: run for run in reversed(outcome(mass).predicted.runs[-3:])}
    assert set(optima) == {'recorded motion', 'smooth step', 'clearance arc'}
    objectives = [run.objective for run in optima.values()]
    assert max(objectives) <= min(objectives) * 1.001


@pytest.mark.long  # IPOPT from many starts: a quarter of a minute
@pytest.mark.parametrize('mass', (7.0, 12.0))
def test_random_starts_find_nothing_better(outcome, predictor, person, mass) -> None:
    """Five random starts of IPOPT as the reference: not more than 0.1 % above the best of them."""
    result = outcome(mass)
    task = build_task(person, result.lift, result.box)
    rng = np.random.default_rng(7)
    low, high = person.angle_lower, person.angle_upper
    shape = (predictor.sagittal.model.grid.spline.n_free, 6)
    starts = [Start(f'random {k}', rng.uniform(low, high, shape)) for k in range(5)]
    runs = list(predictor.sagittal.reference_runs(task, starts))
    solved = [run.objective for run in runs if run.converged]
    assert solved, [run.status for run in runs]
    best = min(run.objective for run in result.predicted.runs[-3:] if run.converged)
    assert best <= min(solved) * 1.001


def test_effort_is_less_than_recorded_and_grows_with_the_box(outcome) -> None:
    efforts = []
    for mass in MASSES:
        comparison = outcome(mass).comparison
        assert comparison is not None
        assert comparison.predicted_effort < comparison.measured_effort
        efforts.append(comparison.predicted_effort)
    assert efforts == sorted(efforts)


@pytest.mark.parametrize('mass', MASSES)
def test_motion_meets_the_task(outcome, person, mass) -> None:
    result = outcome(mass)
    motion, recorded = result.predicted.lift.motion, result.lift.motion
    assert motion.skeleton == '2d_10dof'
    np.testing.assert_allclose(np.diff(motion.time), 0.01, atol=1e-9)
    assert (motion.time[0], motion.time[-1]) == (recorded.time[0], pytest.approx(1.2))
    for sample in (0, -1):
        np.testing.assert_allclose(
            motion.point('hand_r')[sample], recorded.point('hand_r')[sample], atol=1e-6
        )
    for name in ('ankle_r', 'heel_l', 'toe_r'):
        np.testing.assert_allclose(motion.point(name), recorded.point(name), atol=1e-9)
    np.testing.assert_allclose(motion.velocity[[0, -1]], 0.0, atol=1e-9)
    middle = len(motion) // 2
    for joint in JOINTS:
        for sample in (0, middle, -1):
            apart = motion.coordinate(joint)[sample] - recorded.coordinate(joint)[sample]
            assert abs(apart) <= 0.15 + 1e-3
    lowest = recorded.box_position[[0, -1], 2].min() if mass > 0.0 else 0.0
    assert motion.point('hand_r')[:, 2].min() >= lowest - 2e-3
    rear, front = result.predicted.support
    assert rear - 1e-3 <= result.predicted.zmp.min()
    assert result.predicted.zmp.max() <= front + 1e-3
    low, high = result.predicted.torque_lower, result.predicted.torque_upper
    assert np.all(result.predicted.torque >= low - 0.5)
    assert np.all(result.predicted.torque <= high + 0.5)


@pytest.mark.parametrize('mass', (0.0, 7.0))
def test_motion_and_forces_balance_on_the_skeleton(outcome, person, mass) -> None:
    """Read alone, the motion with its forces on feet and hands has no residual at the pelvis."""
    predicted = outcome(mass).predicted
    motion, skeleton = predicted.lift.motion, person.skeleton
    for i in range(0, len(motion), 20):
        external = []
        for side in (0, 1):
            point = motion.point(f'hand_{"rl"[side]}')[i]
            external.append(
                ExternalForce(
                    'foot', motion.ground_force[i, side], motion.centre_of_pressure[i, side]
                )
            )
            external.append(ExternalForce('forearm', motion.hand_force[i, side], point))
        forces = skeleton.inverse_dynamics(
            motion.position[i], motion.velocity[i], motion.acceleration[i], external
        )
        np.testing.assert_allclose(forces[:3], 0.0, atol=1e-6)
        own = [forces[skeleton.index(joint)] for joint in JOINTS]
        np.testing.assert_allclose(predicted.torque[i, :6], own, atol=1e-6)
    rates = np.gradient(motion.position, motion.time, axis=0)
    np.testing.assert_allclose(rates[2:-2], motion.velocity[2:-2], atol=0.02)


def test_both_hands_carry_half_of_weight_and_inertia(outcome) -> None:
    motion = outcome(7.0).predicted.lift.motion
    velocity = np.gradient(motion.point('hand_r'), motion.time, axis=0)
    impulse = cumulative_trapezoid(motion.hand_force[:, 0], motion.time, axis=0, initial=0.0)
    gravity = np.outer(motion.time - motion.time[0], [0.0, 0.0, 9.80665])
    expected = -3.5 * (velocity + gravity)
    np.testing.assert_allclose(impulse[1:-1], expected[1:-1], atol=0.03)
    np.testing.assert_allclose(motion.hand_force[:, 0], motion.hand_force[:, 1])
    np.testing.assert_allclose(
        motion.box_position[:, [0, 2]], motion.point('hand_r')[:, [0, 2]], atol=1e-9
    )


def test_turned_laboratory_gives_the_same_lift(subject, predictor, outcome) -> None:
    from human_model.frames import matrix_from_quaternion, quaternion_from_matrix

    result = outcome(7.0)
    motion = result.lift.motion
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([0.5, -0.2, 0.0])
    moved = replace(
        motion,
        points=motion.points @ turn.T + shift,
        box_position=motion.box_position @ turn.T + shift,
        ground_force=motion.ground_force @ turn.T,
        frames=quaternion_from_matrix(turn @ matrix_from_quaternion(motion.frames)),
    )
    other = predictor.predict(subject, replace(result.lift, motion=moved), result.box)
    assert other.report.ok
    assert other.report.objective == pytest.approx(result.predicted.report.objective, rel=1e-6)
    same, there = result.predicted.lift.motion, other.lift.motion
    np.testing.assert_allclose(there.points, same.points @ turn.T + shift, atol=1e-5)
    np.testing.assert_allclose(
        there.centre_of_pressure, same.centre_of_pressure @ turn.T + shift, atol=1e-4
    )
    np.testing.assert_allclose(there.ground_force, same.ground_force @ turn.T, atol=0.1)
    back = np.einsum('ji,nfjk->nfik', turn, matrix_from_quaternion(there.frames))
    np.testing.assert_allclose(back, matrix_from_quaternion(same.frames), atol=1e-5)


def refused(result, status: SolveStatus, *words: str) -> None:
    assert result.report.status is status
    for word in words:
        assert word in result.report.message
    assert result.lift is None
    assert result.torque.size == result.zmp.size == 0


def test_too_heavy_a_box_is_infeasible_and_names_the_constraint(subject, make_lift) -> None:
    patient = LiftPredictor(PredictorOptions(time_limit=60.0))
    result = patient.predict(subject, make_lift(30.0), Box(30.0, BOX_SIZE))
    refused(result, SolveStatus.PREDICTOR_INFEASIBLE, 'no feasible motion', 'joint torque limit')
    assert result.comparison is None


def test_unreachable_target_is_named(subject, predictor, make_lift) -> None:
    box = Box(7.0, BOX_SIZE, end=np.array([1.6, 0.0, 1.0]))
    result = predictor.predict(subject, make_lift(7.0), box)
    refused(result, SolveStatus.PREDICTOR_UNREACHABLE, 'hand position (4.6) at the end', 'mm')


def test_bad_recording_is_not_predicted(subject, predictor, make_lift) -> None:
    bad = SolveReport(SolveStatus.TRACKER_MARKERS_MISSING, 'marker T10 is missing')
    result = predictor.predict(subject, replace(make_lift(7.0), report=bad), Box(7.0, BOX_SIZE))
    refused(result, SolveStatus.PREDICTOR_BAD_INPUT, 'TRACKER_MARKERS_MISSING', 'T10')


def test_time_limit_is_kept(subject: Subject, make_lift) -> None:
    hurried = LiftPredictor(PredictorOptions(time_limit=1e-3))
    result = hurried.predict(subject, make_lift(7.0), Box(7.0, BOX_SIZE))
    refused(result, SolveStatus.PREDICTOR_TIME_LIMIT, 'time limit')


def test_same_numbers_without_a_compiler(
    monkeypatch: pytest.MonkeyPatch, subject: Subject, outcome
) -> None:
    monkeypatch.setenv('CC', '/no/such/compiler')
    slow = LiftPredictor()
    result = slow.predict(subject, outcome(7.0).lift, outcome(7.0).box)
    assert result.report.ok
    assert 'virtual machine' in result.report.message
    reference = outcome(7.0).predicted
    assert result.report.objective == pytest.approx(reference.report.objective, rel=1e-7)
    np.testing.assert_allclose(
        result.lift.motion.position, reference.lift.motion.position, atol=1e-4
    )


def test_free_postures_cost_less_and_the_best_start_is_kept(
    subject: Subject, predictor, outcome
) -> None:
    """Without the recorded postures (4.8) the effort cannot be higher."""
    result = outcome(12.0)
    free = LiftPredictor(PredictorOptions(posture_tolerance=3.0))
    predicted = free.predict(subject, result.lift, result.box)
    assert predicted.report.ok
    assert predicted.report.objective < result.predicted.report.objective
    first_round = [run.objective for run in predicted.runs[-3:] if run.converged]
    assert predicted.runs[-3].objective == min(first_round)
