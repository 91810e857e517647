# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated asymmetric lift predicted in space, checked without the optimiser's own model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.frames import matrix_from_quaternion, quaternion_from_matrix
from human_model.motion import BodyMotion, Lift
from human_model.report import SolveReport, SolveStatus
from human_model.skeleton import ExternalForce
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.models.spatial.task import KEY_JOINTS, SpatialTask, without_ground_windows
from lift_predictor.core.models.spatial.verify import TOLERANCE
from lift_predictor.core.options import PredictorOptions, Windows
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.task_solver import TaskSolver

BAGS = Path(__file__).parents[4] / 'bags'
MASS, SIZE = 7.0, (0.238, 0.305, 0.127)
SIDES = ('r', 'l')


def recording(name: str) -> Lift:
    """Return the stored truth of a simulated recording."""
    path = BAGS / name / 'truth.npz'
    if not path.exists():
        pytest.skip(f'{path} is not there')
    truth = np.load(path)
    arrays = {
        key: truth[key]
        for key in ('time', 'position', 'velocity', 'acceleration', 'points', 'frames',
                    'ground_force', 'centre_of_pressure', 'free_moment', 'hand_force',
                    'box_position')
    }  # fmt: skip
    names = {key: tuple(truth[key]) for key in ('coordinates', 'point_names', 'frame_names')}
    motion = BodyMotion(skeleton='3d_40dof', **arrays, **names)
    return Lift(
        'lift_001', 'measured', float(truth['lift_start']), float(truth['lift_end']),
        float(truth['box_mass']), motion, SolveReport(),
    )  # fmt: skip


@pytest.fixture(scope='module')
def lift() -> Lift:
    return recording('asymmetric_7kg')


@pytest.fixture(scope='module')
def predictor() -> LiftPredictor:
    return LiftPredictor(PredictorOptions(dimension='3d'))


@pytest.fixture(scope='module')
def spatial(predictor: LiftPredictor) -> TaskSolver[SpatialTask]:
    return predictor.spatial


@pytest.fixture(scope='module')
def solved(predictor: LiftPredictor, subject: Subject, lift: Lift):
    return predictor.predict(subject, lift, Box(MASS, SIZE))


def test_solved_with_small_kkt_residuals_and_verified_between_the_nodes(solved) -> None:
    predicted, comparison = solved, solved.comparison
    assert predicted.report.ok, predicted.report.message
    best = predicted.runs[0].solution
    assert best.primal < 1e-6
    assert best.dual < 1e-6
    assert best.complementarity < 1e-6
    check = predicted.verification
    assert check.n_points == 241
    assert set(check.violation) == set(TOLERANCE)
    for name, limit in TOLERANCE.items():
        assert check.violation[name] <= limit, (name, check.worst[name])
    assert comparison.predicted_effort < comparison.measured_effort


def test_motion_and_forces_balance_on_the_skeleton(solved, spatial, subject) -> None:
    """Read alone, the motion with its forces on feet and hands has no residual at the pelvis."""
    predicted = solved
    motion, skeleton = predicted.lift.motion, spatial.model.person(subject).skeleton
    assert motion.skeleton == '3d_40dof'
    np.testing.assert_allclose(np.diff(motion.time), 0.01, atol=1e-9)
    for i in range(0, len(motion), 16):
        external = []
        for k, side in enumerate(SIDES):
            external.append(
                ExternalForce(
                    f'foot_{side}', motion.ground_force[i, k], motion.centre_of_pressure[i, k],
                    motion.free_moment[i, k],
                )
            )  # fmt: skip
            hand = motion.point(f'hand_{side}')[i]
            external.append(ExternalForce(f'hand_{side}', motion.hand_force[i, k], hand))
        forces = skeleton.inverse_dynamics(
            motion.position[i], motion.velocity[i], motion.acceleration[i], external
        )
        np.testing.assert_allclose(forces[:6], 0.0, atol=1e-6)
        np.testing.assert_allclose(forces[6:], predicted.torque[i], atol=1e-9)
        points = skeleton.points(motion.position[i])
        for name in ('hand_l', 'toe_r', 'head'):
            np.testing.assert_allclose(points[name], motion.point(name)[i], atol=1e-9)
    rates = np.gradient(motion.position, motion.time, axis=0)
    np.testing.assert_allclose(rates[2:-2], motion.velocity[2:-2], atol=0.05)
    speeds = np.diff(motion.velocity, axis=0) / np.diff(motion.time)[:, None]
    mean = 0.5 * (motion.acceleration[:-1] + motion.acceleration[1:])
    np.testing.assert_allclose(speeds, mean, atol=2.0)


def test_motion_meets_the_task(solved, lift, spatial, subject) -> None:
    """Feet, hands, limits, windows, from the result alone."""
    predicted = solved
    motion, recorded = predicted.lift.motion, lift.window
    limits = spatial.model.person(subject).skeleton.limits
    for j, name in enumerate(motion.coordinates):
        low, high = limits[j]
        assert motion.position[:, j].min() >= low - 1e-3, name
        assert motion.position[:, j].max() <= high + 1e-3, name
    assert np.all(predicted.torque >= predicted.torque_lower - 0.5)
    assert np.all(predicted.torque <= predicted.torque_upper + 0.5)
    for side in SIDES:
        for point in ('ankle', 'heel', 'toe'):
            at = motion.point(f'{point}_{side}')
            np.testing.assert_allclose(at, np.broadcast_to(at[0], at.shape), atol=1e-9)
            np.testing.assert_allclose(at[0], recorded.point(f'{point}_{side}')[0], atol=1e-4)
    hands = np.stack([motion.point(f'hand_{side}') for side in SIDES], axis=1)
    apart = hands[:, 1] - hands[:, 0]
    np.testing.assert_allclose(np.linalg.norm(apart, axis=1), 0.305, atol=2.1e-3)
    np.testing.assert_allclose(apart[:, 2], 0.0, atol=2e-3)
    for k, side in enumerate(SIDES):
        for row in (0, -1):
            there = recorded.point(f'hand_{side}')[row]
            np.testing.assert_allclose(hands[row, k], there, atol=2e-4)
    np.testing.assert_allclose(motion.velocity[[0, -1]], 0.0, atol=1e-9)
    assert motion.ground_force[:, :, 2].min() > -1.0
    for row, epsilon in ((0, 10.0), (len(motion) // 2, 5.0), (-1, 10.0)):
        own = row if row <= 0 else len(recorded) // 2
        for name in KEY_JOINTS:
            off = motion.coordinate(name)[row] - recorded.coordinate(name)[own]
            assert abs(np.degrees(off)) < epsilon + 0.5, (name, row)
        off = motion.ground_force[row, :, 2] - recorded.ground_force[own, :, 2]
        assert np.abs(off).max() < 55.0


def mirrored(lift: Lift) -> Lift:
    """Reflect a recorded lift in the plane y = 0."""
    motion = lift.motion
    mirror = np.array([1.0, -1.0, 1.0])

    def other(name: str) -> str:
        swap = {'_r': '_l', '_l': '_r'}
        return name[:-2] + swap.get(name[-2:], name[-2:])

    def swapped(names: tuple[str, ...]) -> list[int]:
        return [names.index(other(name)) for name in names]

    odd = ('pelvis_tz', 'pelvis_list', 'pelvis_rotation')
    sign = np.array(
        [-1.0 if name in odd or name.endswith(('bending', '_rotation')) else 1.0
         for name in motion.coordinates]
    )  # fmt: skip
    order = swapped(motion.coordinates)
    flip = np.diag(mirror)
    frames = flip @ matrix_from_quaternion(motion.frames)[:, swapped(motion.frame_names)] @ flip
    return replace(lift, motion=replace(
        motion,
        position=motion.position[:, order] * sign,
        velocity=motion.velocity[:, order] * sign,
        acceleration=motion.acceleration[:, order] * sign,
        points=motion.points[:, swapped(motion.point_names)] * mirror,
        frames=quaternion_from_matrix(frames),
        ground_force=motion.ground_force[:, ::-1] * mirror,
        centre_of_pressure=motion.centre_of_pressure[:, ::-1] * mirror,
        free_moment=motion.free_moment[:, ::-1] * -mirror,
        hand_force=motion.hand_force[:, ::-1] * mirror,
        box_position=motion.box_position * mirror,
    ))  # fmt: skip


def test_lift_to_the_right_is_the_mirror_image(
    spatial: TaskSolver[SpatialTask], subject: Subject, lift: Lift
) -> None:
    """Same objective and reflected motion; strength must be symmetric for that."""
    both = []
    for recorded in (lift, mirrored(lift)):
        task = spatial.model.recorded_task(subject, recorded, Box(MASS, SIZE))
        p = task.parameters
        # Published trunk rotation is 71.6 N m to the right, 71 N m to the left.
        rotation = [2, 5]
        lower, upper = p.strength_lower.copy(), p.strength_upper.copy()
        upper[rotation] = -lower[rotation]
        even = replace(task, parameters=replace(p, strength_lower=lower, strength_upper=upper))
        both.append(spatial.solve(even, spatial.model.starts(even)[:1]))
    left, right = both
    assert left.report.ok and right.report.ok
    assert right.report.objective == pytest.approx(left.report.objective, rel=1e-6)
    image = mirrored(replace(right.lift, report=SolveReport())).motion
    np.testing.assert_allclose(image.position, left.lift.motion.position, atol=2e-4)
    np.testing.assert_allclose(image.ground_force, left.lift.motion.ground_force, atol=0.5)


def test_turned_laboratory_gives_the_same_lift(
    predictor: LiftPredictor, subject: Subject, lift: Lift, solved
) -> None:
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0],
                     [0.0, 0.0, 1.0]])  # fmt: skip
    shift = np.array([0.5, -0.2, 0.0])
    motion = lift.motion
    moved = replace(
        motion,
        points=motion.points @ turn.T + shift,
        box_position=motion.box_position @ turn.T + shift,
        ground_force=motion.ground_force @ turn.T,
        frames=quaternion_from_matrix(turn @ matrix_from_quaternion(motion.frames)),
    )
    other = predictor.predict(subject, replace(lift, motion=moved), Box(MASS, SIZE))
    assert other.report.ok
    assert other.report.objective == pytest.approx(solved.report.objective, rel=1e-5)
    there = solved.lift.motion.points @ turn.T + shift
    np.testing.assert_allclose(other.lift.motion.points, there, atol=1e-3)


def test_the_pipeline_takes_asymmetric_lifts_to_space(subject: Subject, lift: Lift) -> None:
    predictor = LiftPredictor()
    predicted = predictor.predict(subject, lift, Box(MASS, SIZE))
    assert predicted.report.ok, predicted.report.message
    assert predicted.lift.motion.skeleton == '3d_40dof'
    assert predicted.comparison.joint_names == KEY_JOINTS
    flat = LiftPredictor(PredictorOptions(dimension='2d'))
    refused = flat.predict(subject, lift, Box(MASS, SIZE))
    assert refused.report.status is SolveStatus.PREDICTOR_BAD_INPUT
    assert 'turns' in refused.report.message


def test_free_duration_does_not_cost_more(subject: Subject, lift: Lift, solved) -> None:
    options = PredictorOptions(windows=Windows(duration=(0.8, 1.25)))
    free = LiftPredictor(options).spatial
    task = free.model.recorded_task(subject, lift, Box(MASS, SIZE))
    predicted = free.solve(task, free.model.starts(task)[:1])
    assert predicted.report.ok, predicted.report.message
    recorded = lift.end - lift.start
    assert 0.8 * recorded - 1e-6 <= predicted.duration <= 1.25 * recorded + 1e-6
    assert abs(predicted.duration - recorded) > 1e-3
    assert predicted.report.objective < solved.report.objective
    assert predicted.lift.motion.time[-1] - lift.start == pytest.approx(predicted.duration)


def test_too_heavy_a_box_names_what_breaks(
    predictor: LiftPredictor, spatial: TaskSolver[SpatialTask], subject: Subject, lift: Lift
) -> None:
    """The heaviest feasible lift comes with it; with a little more weight it is not feasible."""
    predicted = predictor.predict(subject, lift, Box(60.0, SIZE))
    assert predicted.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert 'no feasible motion: joint torque limit' in predicted.report.message
    assert 'breaks first' in predicted.report.message
    assert predicted.lift is None
    assert predicted.torque.size == 0
    nearest = predicted.nearest.prediction
    assert nearest.report.ok
    assert MASS < nearest.box_mass < 60.0
    heavier = without_ground_windows(
        spatial.model.recorded_task(subject, lift, Box(nearest.box_mass + 2.0, SIZE))
    )
    start = replace(spatial.model.starts(heavier)[0], control=nearest.runs[0].control)
    assert not spatial.solve(heavier, (start,)).report.ok


def test_bad_input_is_named(predictor: LiftPredictor, subject: Subject, lift: Lift) -> None:
    motion = lift.motion
    walking = motion.points.copy()
    foot = [motion.point_names.index(f'{part}_r') for part in ('heel', 'toe', 'ankle')]
    walking[:, foot, 0] += np.linspace(0.0, 2.0, len(motion))[:, None]
    step = replace(lift, motion=replace(motion, points=walking))
    report = predictor.predict(subject, step, Box(MASS, SIZE)).report
    assert report.status is SolveStatus.PREDICTOR_BAD_INPUT
    assert 'right foot moves' in report.message
    bad = SolveReport(SolveStatus.TRACKER_MARKERS_MISSING, 'marker T10 is missing')
    report = predictor.predict(subject, replace(lift, report=bad), Box(MASS, SIZE)).report
    assert 'marker T10' in report.message
