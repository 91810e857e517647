# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The sagittal model of the lift problem: both sides of the body together, in one plane."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from human_model.motion import Lift
from human_model.subject import Subject
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.bspline import simpson_weights
from lift_predictor.core.models.sagittal import feet as places
from lift_predictor.core.models.sagittal.assembly import (
    sagittal_assembler,
    sagittal_library,
    sagittal_nlp,
)
from lift_predictor.core.models.sagittal.evaluation import SagittalLoads, evaluate
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.lift_motion import body_motion, mtp_torque
from lift_predictor.core.models.sagittal.lowering import stoop_squat_index
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plan import build_plan
from lift_predictor.core.models.sagittal.plane import SideView
from lift_predictor.core.models.sagittal.solved_lifts import library_starts
from lift_predictor.core.models.sagittal.starts import make_starts
from lift_predictor.core.models.sagittal.task import SagittalTask, asymmetry, build_task
from lift_predictor.core.models.sagittal.verify import verify
from lift_predictor.core.models.sagittal.way import StraightWay, standard_ways
from lift_predictor.core.options import POSTURE_TOLERANCE, SAGITTAL, PredictorOptions
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.problem.comparison import ComparedCurves, Pair
from lift_predictor.core.problem.loads import Coordinates
from lift_predictor.core.problem.maximum_weight import open_mass
from lift_predictor.core.problem.model import LiftModel, LiftResult, Plan, SolveMethod
from lift_predictor.core.problem.nearest_lift import Way
from lift_predictor.core.problem.run import SolverRun, Start
from lift_predictor.core.problem.verification import DENSITY, Verification
from lift_predictor.core.solvers.solution import InteriorPointOptions
from lift_predictor.core.solvers.spline_nlp import SplineNlp
from lift_predictor.core.solvers.stop import StopFlag

COLD: Final = InteriorPointOptions(barrier=3e-3, bound_push=0.1)
"""Found on random lifts: a third fewer iterations than with IPOPT's values for general problems,
and minima that are no worse."""
NEAR: Final = InteriorPointOptions(barrier=1e-4, bound_push=1e-2)
"""For starts that are near a minimum."""
POSTURE_TOLERANCES: Final = (0.1, 0.15, 0.1)
"""Epsilon of equation 2.23 at 0, T/2 and T [rad], for the maximum weight."""
COMPARED_JOINTS: Final = ('spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle')
"""The dissertation's names of `parameters.JOINTS`, in the same order."""
TORQUE_NAMES: Final = (*JOINTS, 'mtp_angle')


class SagittalModel(LiftModel[SagittalTask]):
    """The sagittal model.

    Parameters
    ----------
    options : PredictorOptions
        Settings.
    stop : StopFlag, optional
        Ends the construction of plans.
    grid : SagittalGrid, optional
        In place of the one of the options.

    Notes
    -----
    Building loads the compiled functions, or compiles them once per machine.
    """

    name = SAGITTAL
    plan_starts_limit = 4
    probe_starts = 2
    technique_is_constraint = False
    keeps_feet = False
    feet_moves = 2
    probes = False
    grid: SagittalGrid

    def __init__(
        self,
        options: PredictorOptions | None = None,
        stop: StopFlag | None = None,
        grid: SagittalGrid | None = None,
    ) -> None:
        self.options = options = options or PredictorOptions()
        self.stop = stop
        self.grid = grid or SagittalGrid(
            options.spline_control, options.n_nodes, options.static_ends
        )
        self.library = sagittal_library()
        self.method = SolveMethod(
            cold=COLD, near=NEAR, time_limit=options.time_limit, refinements=options.refinements,
            margin=1.05, growth=2.0, margin_candidates=1, finer=(2, 4, DENSITY), light=0.5,
            reduces_mass=True, uses_reference=True,
        )  # fmt: skip
        self._assembler = sagittal_assembler(self.library, self.grid)
        self._person: Person | None = None
        self._view: tuple[Lift, Person, SideView] | None = None

    def person(self, subject: Subject) -> Person:
        """Return the person of a subject; the last one is kept."""
        if self._person is None or self._person.subject is not subject:
            self._person = Person.of(subject, self.options.coefficient_set)
        return self._person

    def view(self, subject: Subject, lift: Lift) -> SideView:
        """Return a recorded lift seen from the side; the last one is kept."""
        person = self.person(subject)
        if self._view is None or self._view[0] is not lift or self._view[1] is not person:
            view = SideView.of(lift.window, lift.start, person.neutral)
            self._view = (lift, person, view)
        return self._view[2]

    def asymmetry(self, subject: Subject, lift: Lift, box: Box) -> str:
        """Return the reason why a recorded lift does not fit the model; empty: it fits."""
        view = self.view(subject, lift)
        return asymmetry(lift, view, box, self.options.posture_tolerance)

    def nlp(self, task: SagittalTask) -> SplineNlp:
        """Return the NLP of a task."""
        return sagittal_nlp(self._assembler, self.grid, task.parameters.pack(), task.bounds)

    def variables(self, task: SagittalTask, start: Start) -> Array:
        """Return the variables of an initial guess."""
        return np.append(start.control, start.box_mass)

    def duration(self, task: SagittalTask, x: Array) -> float:
        """Duration of a solution [s]."""
        return task.parameters.duration

    def finer(self, factor: int) -> SagittalModel:
        """Return the same model with more nodes."""
        grid = replace(self.grid, n_nodes=factor * (self.grid.n_nodes - 1) + 1)
        return SagittalModel(self.options, self.stop, grid)

    def recorded_task(
        self, subject: Subject, lift: Lift, box: Box, fraction: float = 1.0
    ) -> SagittalTask:
        """Return the task of a recorded lift."""
        view, tolerance = self.view(subject, lift), self.options.posture_tolerance
        return build_task(self.person(subject), lift, box, tolerance, fraction, view)

    def maximum_weight_task(self, subject: Subject, lift: Lift, box: Box) -> SagittalTask:
        """Return the task of a recorded lift whose mass is open."""
        view = self.view(subject, lift)
        task = build_task(self.person(subject), lift, box, POSTURE_TOLERANCES, view=view)
        return open_mass(task)

    def starts(self, task: SagittalTask) -> tuple[Start, ...]:
        """Return the initial guesses of a recorded task."""
        return make_starts(task, self.grid.spline)

    def library_starts(self, task: SagittalTask) -> tuple[Start, ...]:
        """Return initial guesses from solved lifts of other persons, for planned tasks."""
        return () if task.is_recorded else library_starts(self.grid.spline)

    def heaviest_starts(self, task: SagittalTask, starts: Iterable[Start]) -> tuple[Start, ...]:
        """Return the initial guesses where the weight alone is maximised: with the task's mass."""
        mass = task.parameters.box_mass
        return tuple(s if s.box_mass > 0.0 else replace(s, box_mass=mass) for s in starts)

    def recorded_ways(self, subject: Subject, lift: Lift, box: Box) -> dict[str, Way]:
        """Ways of the grip from the recorded places to those asked for."""
        if box.start is None and box.end is None:
            return {}
        task = self.recorded_task(subject, lift, box, 0.0)
        ways: dict[str, Way] = {}
        for row, (name, place) in enumerate((('start', box.start), ('end', box.end))):
            if place is not None:
                grip = task.plane.into(np.asarray(place, dtype=float))
                x, z = grip - task.parameters.box_from_hand - task.bounds.hand[row]
                ways[name] = StraightWay((0.0, 0.0, 0.0), (float(x), 0.0, float(z)))
        return ways

    def loads(
        self, task: SagittalTask, coordinates: Coordinates, box_mass: float
    ) -> SagittalLoads:
        """Return the loads of n instants."""
        parameters = replace(task.parameters, box_mass=box_mass)
        return evaluate(self.library, *coordinates, parameters)

    def effort_rule(self) -> tuple[Array, Array]:
        """Simpson's rule at the nodes, as in the objective."""
        return self.grid.times, simpson_weights(self.grid.n_nodes)

    def verify(self, task: SagittalTask, run: SolverRun) -> Verification:
        """Check a solution between the nodes."""
        parameters = replace(task.parameters, box_mass=run.box_mass)
        return verify(self.library, self.grid, run.control, parameters, task.bounds)

    def tightened(self, task: SagittalTask, check: Verification, factor: float) -> SagittalTask:
        """Return the task with a margin of a factor times the excess of a check."""
        margin = 0.0 if task.bounds.margin is None else task.bounds.margin
        return replace(task, bounds=replace(task.bounds, margin=margin + factor * check.excess))

    def result(self, task: SagittalTask, run: SolverRun, time: Array) -> LiftResult:
        """Return a solution as forces and motion in the laboratory."""
        duration = run.duration
        coordinates = self.grid.spline.sample(run.control, time / duration, duration)
        loads = self.loads(task, coordinates, run.box_mass)
        low, high = (np.full((len(time), 1), bound) for bound in task.person.mtp_limits)
        return LiftResult(
            motion=body_motion(task, task.start + time, *coordinates, loads),
            torque_names=TORQUE_NAMES,
            torque=np.column_stack((loads.torque, mtp_torque(task, loads))),
            torque_lower=np.hstack((loads.lower, low)),
            torque_upper=np.hstack((loads.upper, high)),
            zmp=loads.zmp,
            support=np.array(task.parameters.support),
            ground_force=loads.ground_force,
            loads=loads,
            curves=self.compared_curves(task, time, coordinates[0], loads, self.effort(task, run)),
        )

    def compared_curves(
        self, task: SagittalTask, time: Array, q: Array, loads: SagittalLoads, effort: float
    ) -> ComparedCurves | None:
        """Return the curves of a recorded task and of its solution (tables 2.4 and 2.5)."""
        recorded = task.measured
        if recorded is None:
            return None

        def pairs(own: Array, predicted: Array) -> list[Pair]:
            return [
                Pair(mine, np.interp(recorded.time, time, other))
                for mine, other in zip(own.T, predicted.T, strict=True)
            ]

        horizontal, vertical = pairs(recorded.ground_force, loads.ground_force)
        own = evaluate(self.library, recorded.q, recorded.dq, recorded.ddq, task.parameters)
        return ComparedCurves(
            joints=dict(zip(COMPARED_JOINTS, pairs(recorded.q, q), strict=True)),
            feet=(),
            vertical=vertical,
            horizontal=horizontal,
            time=recorded.time,
            torque_names=JOINTS,
            recorded_loads=own,
            predicted_effort=effort,
        )

    def plan(
        self, subject: Subject, task: PlanTask, feet: Feet, narrowing: float = 1.0
    ) -> Plan[SagittalTask]:
        """Build the task of a planned lift for feet at a place."""
        tolerance = narrowing * POSTURE_TOLERANCE
        return build_plan(self.person(subject), task, feet, tolerance, self.stop)

    def plan_starts(self, plan: Plan[SagittalTask], limit: int | None = None) -> tuple[Start, ...]:
        """Return generated initial guesses of a plan, at most `limit`.

        For each pair of end postures there is a smooth step and an arc clear of the body; first
        come the steps and arcs of the first pair, then those of the next.
        """
        starts: list[Start] = []
        for number, ends in enumerate(plan.ends, 1):
            if limit is not None and len(starts) >= limit:
                break
            if self.stop is not None:
                self.stop.check()
            made = make_starts(replace(plan.task, ends=ends), self.grid.spline)
            starts += [replace(start, name=f'{start.name} {number}') for start in made]
        return tuple(starts[:limit])

    def squat_index(self, subject: Subject, task: SagittalTask, control: Array) -> float:
        """Stoop-Squat-Index of the first posture; NaN where C7 is not lowered."""
        return float(stoop_squat_index(control[:1], self.person(subject), task.parameters)[0])

    def first_feet(self, task: PlanTask) -> tuple[Feet, ...]:
        """Return places of the feet to begin the search with."""
        return places.first_feet(task)

    def feet_rounds(self) -> tuple[float, ...]:
        """Scales of the steps from the best place, round by round."""
        return places.rounds()

    def feet_around(self, task: PlanTask, feet: Feet, scale: float) -> tuple[Feet, ...]:
        """Return places one step from the best."""
        return places.feet_around(task, feet, scale)

    def plan_ways(self, task: PlanTask, feet: Feet) -> Iterable[Mapping[str, Way]]:
        """Yield ways of the box from the standard location of the revised NIOSH equation."""
        return standard_ways(task)
