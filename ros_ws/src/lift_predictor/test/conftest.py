# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lift of the dissertation's subject (section 4.3), made up without the optimiser."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from human_model.motion import Lift
from human_model.report import SolveReport
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.models.sagittal.assembly import sagittal_library
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.kinematics import pelvis_motion, reach
from lift_predictor.core.models.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.task import PlacedBox, SpatialTask, place_task
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.comparison import LiftComparison
from lift_predictor.core.problem.prediction import Prediction

BOX_SIZE = (0.238, 0.305, 0.127)
BOX_DEPTH, _, BOX_HEIGHT = BOX_SIZE
BOX_GAP, SHELF_GAP, SHELF_HEIGHT = 0.033, 0.305, 0.9
DURATION = 1.2

MakeLift = Callable[..., Lift]


class Outcome(NamedTuple):
    """One lift and what was made of it."""

    lift: Lift
    box: Box
    predicted: Prediction
    comparison: LiftComparison | None


@pytest.fixture(scope='session')
def subject() -> Subject:
    return Subject(pseudonym='thesis', sex='male', mass=63.5, stature=1.69, age=31.0)


@pytest.fixture(scope='session')
def person(subject: Subject) -> Person:
    return Person.of(subject)


@pytest.fixture(scope='session')
def placed(subject: Subject) -> Callable[[SpatialGrid, float], SpatialTask]:
    """Lifts of a box from the front to the left, by grid and mass."""
    who = SpatialPerson.of(subject)
    height = who.ankle_height
    frame = StanceFrame(
        0.0, np.zeros(3), np.array([[0.0, -0.15, height], [0.0, 0.15, height]]),
        np.array([-0.14, 0.14]),
    )  # fmt: skip
    places = np.array([[0.42, 0.0, 0.2], [0.3, 0.3, 0.9]])

    def make(grid: SpatialGrid, mass: float) -> SpatialTask:
        box = PlacedBox((mass, mass), (0.24, 0.3, 0.127), 0.3, places, np.array([0.0, 0.7]))
        return place_task(who, frame, box, (1.3, 1.3), grid)

    return make


@pytest.fixture(scope='session')
def parameters(person: Person) -> LiftParameters:
    """Feet at the laboratory's origin, 7 kg in the hands."""
    return lift_parameters(person, 7.0)


@pytest.fixture(scope='session')
def make_lift(person: Person) -> MakeLift:
    """Return a function that makes a recorded lift on the 2D skeleton."""
    library = sagittal_library()

    @cache
    def make(
        mass: float, shelf_gap: float = SHELF_GAP, shelf_height: float = SHELF_HEIGHT
    ) -> Lift:
        parameters = lift_parameters(person, mass)
        edge = parameters.support[1]
        floor = np.array([edge + BOX_GAP + BOX_DEPTH / 2, BOX_HEIGHT / 2])
        shelf = np.array([edge + shelf_gap + BOX_DEPTH / 2, shelf_height + BOX_HEIGHT / 2])
        low, high = person.angle_lower, person.angle_upper
        first, _ = reach(floor, np.radians([-40.0, 60, 10, 95, 90, 20]), low, high, parameters)
        last, _ = reach(shelf, np.radians([0.0, 50, 30, 5, 5, 0]), low, high, parameters)
        middle = 0.5 * (first + last) + np.radians([-5.0, -25, 10, 10, -15, 0])
        spline = RestToRestSpline(7)
        control = np.stack(
            [first, 0.7 * first + 0.3 * middle, middle, 0.7 * last + 0.3 * middle, last]
        )
        time = np.linspace(0.0, DURATION, round(100 * DURATION) + 1)
        q, dq, ddq = spline.sample(control, time / DURATION, DURATION)
        loads = evaluate(library, q, dq, ddq, parameters)
        return recorded_lift(person, parameters, time, (q, dq, ddq), loads)

    return make


def lift_parameters(person: Person, mass: float) -> LiftParameters:
    neutral = person.neutral
    ankle = np.array([0.0, person.ankle_height])
    support = np.array([neutral[name][0] - neutral['ankle_r'][0] for name in ('heel_r', 'toe_r')])
    return LiftParameters(
        body=person.body,
        strength_lower=person.strength_lower,
        strength_upper=person.strength_upper,
        circle=person.circle,
        hip_range=person.hip_range,
        ankle=ankle,
        support=support,
        ground_height=0.0,
        gravity=person.gravity,
        duration=DURATION,
        box_mass=mass,
        box_half=0.5 * np.array([BOX_DEPTH, BOX_HEIGHT]),
        box_acceleration=1e3,
        box_from_hand=np.zeros(2),
        lowest_grip=0.0,
    )


def recorded_lift(person, parameters, time, coordinates, loads) -> Lift:
    skeleton, n = person.skeleton, len(time)
    full = []
    for joints, root in zip(coordinates, pelvis_motion(*coordinates, parameters), strict=True):
        block = np.zeros((n, len(skeleton.coordinates)))
        for column, name in enumerate(JOINTS):
            block[:, skeleton.index(name)] = joints[:, column]
        for column, name in enumerate(('pelvis_tx', 'pelvis_ty', 'pelvis_tilt')):
            block[:, skeleton.index(name)] = root[:, column]
        full.append(block)
    ground = np.zeros((n, 2, 3))
    ground[:, :, 0] = 0.5 * loads.ground_force[:, :1]
    ground[:, :, 2] = 0.5 * loads.ground_force[:, 1:]
    hands = np.zeros((n, 2, 3))
    hands[:, :, 0] = 0.5 * loads.hand_force[:, :1]
    hands[:, :, 2] = 0.5 * loads.hand_force[:, 1:]
    box = np.zeros((n, 3))
    box[:, [0, 2]] = loads.centres[:, -1]
    motion = skeleton.body_motion(
        time, *full, ground_force=ground, hand_force=hands, box_position=box
    )
    return Lift(
        'lift_001', 'measured', 0.0, float(time[-1]), parameters.box_mass, motion, SolveReport()
    )


@pytest.fixture(scope='session')
def predictor() -> LiftPredictor:
    """Predictor of the dissertation's subject, with the functions of the user's cache."""
    return LiftPredictor()


@pytest.fixture(scope='session')
def outcome(
    subject: Subject, predictor: LiftPredictor, make_lift: MakeLift
) -> Callable[[float], Outcome]:
    """Return a function that predicts (once per mass) the lift of a mass [kg]."""

    @cache
    def solve(mass: float) -> Outcome:
        lift, box = make_lift(mass), Box(mass, BOX_SIZE if mass > 0.0 else (0.0, 0.0, 0.0))
        predicted = predictor.predict(subject, lift, box)
        return Outcome(lift, box, predicted, predicted.comparison)

    return solve
