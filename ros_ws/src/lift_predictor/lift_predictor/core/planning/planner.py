# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans a lift: task and person in, optimal lift out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, Generic

from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.options import SAGITTAL, choose_model
from lift_predictor.core.planning.feet import Trial, search_feet
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.progress import PlanListener, PlanProgress
from lift_predictor.core.planning.technique import technique
from lift_predictor.core.predictor import INPUT_ERRORS, LiftPredictor
from lift_predictor.core.problem.maximum_weight import Weighting, maximum_weight, open_mass
from lift_predictor.core.problem.model import T
from lift_predictor.core.problem.nearest_lift import (
    INFEASIBLE_STATUSES,
    REGULARISATION,
    Way,
    relax_placement,
    with_nearest,
)
from lift_predictor.core.problem.prediction import NearestLift, Prediction
from lift_predictor.core.problem.run import Progress, SolverRun, Start
from lift_predictor.core.problem.task_solver import TaskSolver

WINDOW_HALVINGS: Final = 4
"""Halvings of the posture window where the optimum leaves the technique's range; the posture in
its middle is inside."""


class LiftPlanner:
    """Plans lifts with a predictor's solvers.

    Parameters
    ----------
    predictor : LiftPredictor, optional
        Solves and checks.
    weighting : Weighting, optional
        Of effort and weight, where the largest mass is asked for.
    """

    def __init__(
        self, predictor: LiftPredictor | None = None, weighting: Weighting | None = None
    ) -> None:
        self.predictor = predictor or LiftPredictor()
        self.weighting = weighting or Weighting()

    def plan(
        self,
        subject: Subject,
        task: PlanTask,
        listener: PlanListener | None = None,
        weighting: Weighting | None = None,
    ) -> PlannedLift:
        """Plan one lift.

        Parameters
        ----------
        subject : Subject
            Person.
        task : PlanTask
            What is lifted.
        listener : callable, optional
            Called after each run of the solver; may raise `CancelledError`.
        weighting : Weighting, optional
            In place of the planner's own.

        Returns
        -------
        PlannedLift
            Its report holds the status, and without a lift the reason: out of reach, too heavy
            (the first constraint to become infeasible is named, and the nearest feasible lift is
            in `prediction.nearest`), or not sagittal where the predictor's dimension is '2d'.
        """
        weights = weighting or self.weighting
        options = self.predictor.options
        model = SAGITTAL
        try:
            model = choose_model(options, lambda: task.asymmetry)
            if model == SAGITTAL:
                return Planning(self.predictor.sagittal, subject, weights, listener).plan(task)
            return Planning(self.predictor.spatial, subject, weights, listener).plan(task)
        except INPUT_ERRORS as error:
            return _refused(model, subject, task, error)


class Planning(Generic[T]):
    """Plans for one person by one model."""

    def __init__(
        self,
        solver: TaskSolver[T],
        subject: Subject,
        weighting: Weighting,
        listener: PlanListener | None,
    ) -> None:
        self.solver, self.model = solver, solver.model
        self.subject, self.weighting, self.listener = subject, weighting, listener

    def plan(self, task: PlanTask) -> PlannedLift:
        """Plan; where the task is infeasible, add the nearest feasible lift."""
        planned = self._attempt(task, self.model.plan_starts_limit)
        failed = planned.prediction
        if failed.report.status not in INFEASIBLE_STATUSES:
            return planned
        nearest = failed.nearest
        feet = self._known_feet(task, planned)
        if failed.runs and task.box_mass and not self.model.method.reduces_mass:
            plan = self.model.plan(self.subject, task, feet)
            # A box that is too heavy to be held gives no start; empty hands do.
            light = replace(plan, task=plan.task.with_mass(0.0, 0.0))
            nearest = self.solver.reduce_mass(plan.task, self.model.plan_starts(light))
        for ways in () if nearest else self.model.plan_ways(task, feet):
            nearest = self._closer(task, failed, feet, ways)
            if nearest is not None:
                break
        return replace(planned, prediction=with_nearest(failed, nearest))

    def _known_feet(self, task: PlanTask, planned: PlannedLift) -> Feet:
        """Place of the feet that was given or found, or else the first one to try."""
        if task.feet is not None:
            return Feet(*task.feet)
        found = planned.feet.forward == planned.feet.forward
        return planned.feet if found else self.model.first_feet(task)[0]

    def _closer(
        self, task: PlanTask, failed: Prediction, feet: Feet, ways: Mapping[str, Way]
    ) -> NearestLift | None:
        keep = feet if self.model.keeps_feet else None

        def attempt(fraction: float) -> Prediction:
            there = {name: way.at(fraction) for name, way in ways.items()}
            other = replace(
                task, start=there.get('start', task.start), end=there.get('end', task.end)
            )
            return self._attempt(other, self.model.probe_starts, keep).prediction

        return relax_placement(attempt, failed, ways)

    def _attempt(
        self, task: PlanTask, n_starts: int | None, feet: Feet | None = None
    ) -> PlannedLift:
        """Plan for given feet, those of the task, or free feet; input errors become a report."""
        try:
            if feet is None and task.feet is None:
                return self._with_free_feet(task, n_starts)
            return self.at(
                task, feet or Feet(*task.feet or ()), n_starts, progress=self._report_run
            )
        except INPUT_ERRORS as error:
            return _refused(self.model.name, self.subject, task, error)

    def _with_free_feet(self, task: PlanTask, n_starts: int | None) -> PlannedLift:
        found, placements = search_feet(self, task)
        planned = found.planned
        if planned is not None and not planned.report.ok:
            return replace(planned, placements=placements)
        first = () if found.start is None else (found.start,)
        again = self.at(task, found.feet, n_starts, first, self._report_run)
        if planned is not None and planned.value < again.value:
            again = planned
        return replace(again, placements=placements)

    def at(
        self,
        task: PlanTask,
        feet: Feet,
        n_starts: int | None,
        first: Sequence[Start] = (),
        progress: Progress | None = None,
    ) -> PlannedLift:
        """Plan with the feet at a place.

        Parameters
        ----------
        task : PlanTask
            What is lifted.
        feet : Feet
            Place of the feet.
        n_starts : int or None
            Generated initial guesses at most; None: all, and basin hops.
        first : sequence of Start
            Initial guesses tried before the generated ones.
        progress : callable, optional
            Called after each run.

        Raises
        ------
        TaskError
            The task does not fit the model, or the lift leaves the technique's range.
        UnreachableError
            A place of the box is out of reach.
        """
        model, style = self.model, technique(task.technique)
        hops = model.method.basin_hops if n_starts is None else 0
        for halving in range(WINDOW_HALVINGS + 1):
            plan = model.plan(self.subject, task, feet, 0.5**halving)
            starts = (*first, *model.plan_starts(plan, n_starts))
            if task.box_mass is None:
                prediction = maximum_weight(
                    self.solver, open_mass(plan.task), starts, self.weighting,
                    progress=progress,
                ).prediction  # fmt: skip
            else:
                prediction = self.solver.solve(plan.task, starts, progress, basin_hops=hops)
            if not prediction.report.ok:
                return PlannedLift(self.subject, task, prediction, feet)
            control = prediction.runs[0].control
            index = model.squat_index(self.subject, plan.task, control)
            if model.technique_is_constraint or style.holds(index):
                return PlannedLift(self.subject, task, prediction, feet, index)
        raise TaskError(
            f'task.technique: the best lift grasps the box with a Stoop-Squat-Index of '
            f'{index:.0f}; {style.name} is {style.lower:g} to {style.upper:g}'
        )

    def trial(self, task: PlanTask, feet: Feet, neighbour: Trial | None) -> Trial:
        """Solve a plan fast to compare places of the feet, from the best place so far."""
        first = None if neighbour is None else neighbour.start
        if not self.model.probes:
            planned = self.at(task, feet, 1, () if first is None else (first,))
            best = planned.prediction.runs[0]
            return Trial(feet, planned.value, planned.report.message, best, planned)
        plan = self.model.plan(self.subject, task, feet)
        problem = plan.task
        if task.box_mass is None:
            problem = open_mass(problem).with_objective(REGULARISATION, 1.0)
        run: SolverRun | None = None
        if first is not None and neighbour is not None:
            run = self.solver.run(problem, first, neighbour.run.solution)
        if run is None or not run.converged:
            run = self.solver.run(problem, self.model.plan_starts(plan, 1)[0])
        value = run.objective if task.box_mass is not None else -run.box_mass
        return Trial(feet, value if run.converged else float('inf'), str(run.status), run)

    def _report_run(self, done: int, total: int, best: float) -> None:
        self.report('lift', done, total, best)

    def report(self, stage: str, done: int, total: int, best: float) -> None:
        """Call the listener."""
        if self.listener is not None:
            self.listener(PlanProgress(stage, done, total, best))


def plan(subject: Subject, task: PlanTask, listener: PlanListener | None = None) -> PlannedLift:
    """Plan one lift with a predictor of default options; for many, keep a `LiftPlanner`."""
    return LiftPlanner().plan(subject, task, listener)


def _refused(model: str, subject: Subject, task: PlanTask, error: Exception) -> PlannedLift:
    unreachable = isinstance(error, UnreachableError)
    status = SolveStatus.PREDICTOR_UNREACHABLE if unreachable else SolveStatus.PREDICTOR_BAD_INPUT
    prediction = Prediction(
        model=model, lift_id=task.name, duration=task.duration,
        box_mass=float('nan') if task.box_mass is None else task.box_mass,
        report=SolveReport(status, str(error)),
    )  # fmt: skip
    return PlannedLift(subject, task, prediction)
