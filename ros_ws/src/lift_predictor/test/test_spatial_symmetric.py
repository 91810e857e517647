# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A symmetric lift in space and in the sagittal plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.subject import Subject
from lift_predictor.core.models.sagittal.evaluation import evaluate as evaluate_2d
from lift_predictor.core.models.sagittal.grid import LiftBounds
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plane import SagittalPlane
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.models.spatial.assembly import (
    spatial_assembler,
    spatial_library,
    spatial_nlp,
)
from lift_predictor.core.models.spatial.evaluation import evaluate
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.grid import (
    LIMITED,
    WAY_CONSTRAINTS,
    SpatialGrid,
    constraint_slice,
)
from lift_predictor.core.models.spatial.parameters import SPLINED, STRONG, SpatialParameters
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.task import PlacedBox, place_task
from lift_predictor.core.problem.run import Start
from lift_predictor.core.solvers.solution import InteriorPointOptions
from lift_predictor.core.solvers.solve import solve

PLANAR = {
    'lumbar_extension': ('lumbar_extension',),
    'arm_flex': ('arm_flex_r', 'arm_flex_l'),
    'elbow_flex': ('elbow_flex_r', 'elbow_flex_l'),
    'hip_flexion': ('hip_mean',),
    'knee_angle': ('knee_angle_r', 'knee_angle_l'),
    'ankle_angle': ('ankle_mean',),
}
"""Coordinates of the sagittal model, and those of the spatial one that are the same then."""


@pytest.fixture(scope='module')
def who(subject: Subject) -> SpatialPerson:
    return SpatialPerson.of(subject)


def in_space(q: np.ndarray) -> np.ndarray:
    """Spatial coordinates (n, 26) of sagittal postures (n, 6): no other joint moves."""
    full = np.zeros((len(q), len(SPLINED)))
    for column, joint in enumerate(JOINTS):
        for name in PLANAR[joint]:
            full[:, SPLINED.index(name)] = q[:, column]
    return full


def upright(who: SpatialPerson) -> StanceFrame:
    """Feet parallel below the hips, as the sagittal model has them."""
    half = who.pelvis[0]
    ankle = np.array([[0.0, -half, who.ankle_height], [0.0, half, who.ankle_height]])
    return StanceFrame(0.0, np.zeros(3), ankle, np.zeros(2))


@pytest.fixture(scope='module')
def planar(subject, outcome):
    """Return the 7 kg lift of the sagittal predictor."""
    result = outcome(7.0)
    assert result.predicted.report.ok
    return result


def test_model_agrees_with_the_sagittal_one(who, person, parameters, planar, predictor) -> None:
    """Same motion: torques of both limbs, ground and zero-moment point, to 1e-8."""
    motion = planar.predicted.lift.motion
    index = [motion.coordinates.index(joint) for joint in JOINTS]
    parts = motion.position, motion.velocity, motion.acceleration
    q, dq, ddq = (np.array(part[:, index]) for part in parts)
    places = np.array([[0.4, 0.0, 0.1], [0.4, 0.0, 1.0]])
    box = PlacedBox((7.0, 7.0), (0.238, 0.305, 0.127), 2.0 * who.arm[0], places, np.zeros(2))
    task = place_task(who, upright(who), box, (1.2, 1.2), SpatialGrid(10, 25, 'acceleration'))
    # Feet without the inward lean, which the plane has no place for.
    spatial_parameters = replace(task.parameters, inward_lean=0.0)
    three = evaluate(
        spatial_library(), *(in_space(part) for part in (q, dq, ddq)), 7.0, spatial_parameters
    )
    two = evaluate_2d(predictor.sagittal.model.library, q, dq, ddq, parameters)
    for column, joint in enumerate(JOINTS):
        names = [f'{joint}_{side}' for side in 'rl'] if joint != 'lumbar_extension' else [joint]
        own = sum(three.torque[:, STRONG.index(name)] for name in names)
        np.testing.assert_allclose(own, two.torque[:, column], atol=1e-8, err_msg=joint)
    np.testing.assert_allclose(
        three.ground_force.sum(axis=1)[:, [0, 2]], two.ground_force, atol=1e-8
    )
    np.testing.assert_allclose(three.zmp[:, 0], two.zmp, atol=1e-10)
    np.testing.assert_allclose(three.zmp[:, 1], 0.0, atol=1e-10)
    np.testing.assert_allclose(three.hand.mean(axis=1)[:, [0, 2]], two.centres[:, -1], atol=1e-10)
    np.testing.assert_allclose(
        three.ground_force[:, 0] * [1, -1, 1], three.ground_force[:, 1], atol=1e-8
    )


def with_criterion_of_the_plane(p: SpatialParameters, person: Person) -> SpatialParameters:
    """Strength that makes equation 3.9 twice the sagittal criterion.

    There each pair of limbs counts once, here each limb: the lumbar joint has to count twice. It
    bends as the whole trunk. What the plane has no joint for is made so strong that it costs
    nothing.
    """
    magnitude = [0, 1, 4, 7]
    sides = {f'{joint}_{side}' for joint in JOINTS for side in 'rl'}
    changed = []
    tables = (p.strength_lower, person.strength_lower), (p.strength_upper, person.strength_upper)
    for table, planar_table in tables:
        strong = table.copy()
        for row, name in enumerate(STRONG):
            if name == 'lumbar_extension':
                strong[row] = planar_table[JOINTS.index(name)]
                strong[row, magnitude] /= np.sqrt(2.0)
            elif name not in sides:
                strong[row, magnitude] *= 1e6
        changed.append(strong)
    return replace(p, strength_lower=changed[0], strength_upper=changed[1], inward_lean=0.0)


def test_symmetric_optimum_is_the_sagittal_one(
    who: SpatialPerson, person: Person, parameters, predictor
) -> None:
    """Where only the sagittal joints move and the criterion is the same, so is the optimum."""
    grid, width = SpatialGrid(10, 25, 'acceleration'), 2.0 * who.arm[0]
    begin, finish = np.array([0.4, 0.0, 0.35]), np.array([0.45, 0.0, 0.95])
    box = PlacedBox((7.0, 7.0), (0.0, 0.0, 0.0), width, np.array([begin, finish]), np.zeros(2))
    task = place_task(who, upright(who), box, (1.2, 1.2), grid)
    spatial_parameters = with_criterion_of_the_plane(task.parameters, person)
    # The sagittal box may go anywhere when it has no size.
    task.bounds.node_lower[:, constraint_slice(WAY_CONSTRAINTS)] = -1e3
    lumbar = LIMITED.index('lumbar_extension')
    task.bounds.angle_lower[:, lumbar] = person.angle_lower[JOINTS.index('lumbar_extension')]
    task.bounds.angle_upper[:, lumbar] = person.angle_upper[JOINTS.index('lumbar_extension')]
    programme = spatial_nlp(
        spatial_assembler(spatial_library(), grid), grid, spatial_parameters.pack(), task.bounds
    )
    fixed = np.ones((grid.spline.n_free, len(SPLINED)), dtype=bool)
    fixed[:, [SPLINED.index(name) for names in PLANAR.values() for name in names]] = False
    fixed = np.append(fixed.ravel(), (False, False))
    programme.lower[fixed] = programme.upper[fixed] = 0.0
    first = np.radians([-40.0, 70, 20, 75, 70, 15])
    last = np.radians([-5.0, 60, 45, 10, 12, 3])
    s = np.linspace(0.0, 1.0, 41)[:, None]
    path = first + (10 * s**3 - 15 * s**4 + 6 * s**5) * (last - first)
    start = grid.spline.fit(s[:, 0], path)
    solution = solve(
        programme,
        np.append(in_space(start).ravel(), (7.0, 1.2)),
        InteriorPointOptions(barrier=1e-2),
    )
    assert solution.ok, (solution.status, solution.violated)
    control = solution.x[:-2].reshape(-1, len(SPLINED))

    anywhere = np.tile(person.angle_lower, (3, 1)), np.tile(person.angle_upper, (3, 1))
    bounds = LiftBounds(
        person.angle_lower, person.angle_upper, *anywhere,
        np.array([begin[[0, 2]], finish[[0, 2]]]), np.array([7.0, 7.0]),
    )  # fmt: skip
    circle = np.zeros_like(parameters.circle)
    flat_parameters = replace(parameters, circle=circle, box_half=np.zeros(2))
    plane, ends = SagittalPlane(0.0, 0.0), np.stack((first, last))
    flat_task = SagittalTask('same', 0.0, person, plane, None, flat_parameters, bounds, ends, ())
    flat = predictor.sagittal.run(flat_task, Start('same', start, 7.0))
    assert flat.converged, flat.status
    assert solution.objective == pytest.approx(2.0 * flat.objective, rel=1e-4)
    for column, joint in enumerate(JOINTS):
        for name in PLANAR[joint]:
            np.testing.assert_allclose(
                control[:, SPLINED.index(name)], flat.control[:, column], atol=2e-2, err_msg=name
            )
