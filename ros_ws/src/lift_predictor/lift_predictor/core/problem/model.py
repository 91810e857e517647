# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The interface of a model of the lifting person to the lift problem."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, Generic, NamedTuple, TypeVar

import numpy as np

from human_model.motion import BodyMotion, Lift
from human_model.subject import Subject
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.problem.comparison import ComparedCurves
from lift_predictor.core.problem.grid import TimeGrid
from lift_predictor.core.problem.loads import Coordinates, Loads
from lift_predictor.core.problem.nearest_lift import Way
from lift_predictor.core.problem.run import SolverRun, Start
from lift_predictor.core.problem.task import LiftTask
from lift_predictor.core.problem.verification import Verification
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.solution import InteriorPointOptions
from lift_predictor.core.solvers.spline_nlp import SplineNlp

T = TypeVar('T', bound=LiftTask)


@dataclass(frozen=True)
class SolveMethod:
    """Settings of the solution of one model's problems.

    Attributes
    ----------
    cold, near : InteriorPointOptions
        From initial guesses in general, and from those that are near a minimum.
    time_limit : float
        Wall time of one run at most, and time after which no run begins [s].
    refinements : int
        Solves with a margin against violations between the nodes at most, for each minimum.
    margin, growth : float
        First margin, in units of the violation, and its factor each time that it did not suffice.
    warm_margins : bool
        Whether a solve with a margin begins with the multipliers of the one before.
    margin_candidates : int or None
        Minima that are solved again with margins at most; None: all.
    finer : tuple of int
        Node intervals of finer grids in one of the first, where no margin suffices.
    basin_hops : int
        Runs from the best solution, displaced.
    light : float
        Fraction of the mass asked for at which the search for the largest feasible mass begins.
    reduces_mass : bool
        Whether each infeasible problem is solved for the largest feasible mass at once.
    uses_reference : bool
        Whether IPOPT is tried where no start leads to a minimum or to local infeasibility.
    """

    cold: InteriorPointOptions
    near: InteriorPointOptions
    time_limit: float
    refinements: int
    margin: float
    growth: float = 1.0
    warm_margins: bool = False
    margin_candidates: int | None = None
    finer: tuple[int, ...] = ()
    basin_hops: int = 0
    light: float = 0.0
    reduces_mass: bool = False
    uses_reference: bool = False


class LiftResult(NamedTuple):
    """A solution as forces and motion on the skeleton; fields as in `Prediction`.

    Attributes
    ----------
    loads : Loads
        At the samples of the motion, by the model.
    curves : ComparedCurves or None
        With the recorded lift, where there is one.
    problem : str
        Reason to refuse the solution after all; empty: none.
    """

    motion: BodyMotion
    torque_names: tuple[str, ...]
    torque: Array
    torque_lower: Array
    torque_upper: Array
    zmp: Array
    support: Array
    ground_force: Array
    loads: Loads
    curves: ComparedCurves | None
    problem: str = ''


@dataclass(frozen=True, eq=False)
class Plan(Generic[T]):
    """A planned task ready to be solved.

    Attributes
    ----------
    feet : Feet
        Place of the feet.
    task : LiftTask
        Numbers and demands.
    ends : tuple of ndarray, shape (2, n_coordinates)
        Pairs of postures that hold the box at start and end.
    """

    feet: Feet
    task: T
    ends: tuple[Array, ...]


class LiftModel(ABC, Generic[T]):
    """A model of the lifting person: coordinates, constraints, initial guesses, results.

    Attributes
    ----------
    name : str
        'sagittal' or 'spatial'.
    task_constraints : tuple of str
        Parts of the names of constraints that state the task and are no limit.
    plan_starts_limit, probe_starts : int or None
        Generated initial guesses of a planned lift, and of one on the way to the nearest feasible
        lift, at most; None: all, and basin hops.
    technique_is_constraint : bool
        Whether the problem holds the technique; otherwise windows on postures are narrowed.
    keeps_feet : bool
        Whether the feet stay where they are while the nearest feasible plan is sought.
    probes : bool
        Whether places of the feet are compared by one run at the nodes, and each step of the
        search is repeated until no place is better.
    feet_moves : int
        Places in one step of the search of the feet.
    grid : TimeGrid
        Sizes of the problem.
    library : NodeLibrary
        Compiled functions.
    method : SolveMethod
        Settings of the solution.
    """

    name: ClassVar[str]
    task_constraints: ClassVar[tuple[str, ...]] = ()
    plan_starts_limit: ClassVar[int | None]
    probe_starts: ClassVar[int]
    technique_is_constraint: ClassVar[bool]
    keeps_feet: ClassVar[bool]
    probes: ClassVar[bool]
    feet_moves: ClassVar[int]
    grid: TimeGrid
    library: NodeLibrary
    method: SolveMethod

    # The problem.

    @abstractmethod
    def nlp(self, task: T) -> SplineNlp:
        """Return the NLP of a task."""

    @abstractmethod
    def variables(self, task: T, start: Start) -> Array:
        """Return the variables of an initial guess."""

    @abstractmethod
    def duration(self, task: T, x: Array) -> float:
        """Duration of a solution [s]."""

    def finer(self, factor: int) -> LiftModel[T]:
        """Return the same model with more nodes."""
        raise NotImplementedError(f'{self.name}: no finer grids')

    def displacement(self, task: T, shift: Array) -> Array:
        """Return a random displacement of control values as this task needs it."""
        return shift

    # Tasks and initial guesses.

    @abstractmethod
    def person(self, subject: Subject) -> object:
        """Return the subject in the numbers of the model; the last one is kept.

        Raises
        ------
        TaskError
            The subject does not fit the model; names field and value.
        """

    @abstractmethod
    def recorded_task(self, subject: Subject, lift: Lift, box: Box, fraction: float = 1.0) -> T:
        """Return the task of a recorded lift.

        Parameters
        ----------
        subject : Subject
            Person.
        lift : Lift
            The recorded lift.
        box : Box
            What was lifted.
        fraction : float
            Of the way from the recorded places of the box to those asked for.

        Raises
        ------
        TaskError
            The recording has no usable feet, postures or samples, or does not fit the model.
        UnreachableError
            A hand target cannot be met.
        """

    @abstractmethod
    def maximum_weight_task(self, subject: Subject, lift: Lift, box: Box) -> T:
        """Return the task of a recorded lift whose mass is open up to `LARGEST_WEIGHT`."""

    @abstractmethod
    def starts(self, task: T) -> tuple[Start, ...]:
        """Return the initial guesses of a recorded task."""

    def library_starts(self, task: T) -> tuple[Start, ...]:
        """Return initial guesses from solved lifts of other persons."""
        return ()

    def heaviest_starts(self, task: T, starts: Iterable[Start]) -> tuple[Start, ...]:
        """Return the initial guesses where the weight alone is maximised."""
        return tuple(starts)

    def weighted_starts(self, task: T, starts: Iterable[Start]) -> tuple[Start, ...]:
        """Return the initial guesses beside the heaviest lift where effort counts as well."""
        return tuple(starts)

    def with_other_mass(self, task: T) -> T:
        """Return the task without what was recorded with its mass."""
        return task

    def recorded_ways(self, subject: Subject, lift: Lift, box: Box) -> Mapping[str, Way]:
        """Ways of the box from the recorded places to those asked for; empty: not relaxed."""
        return {}

    # Results.

    @abstractmethod
    def loads(self, task: T, coordinates: Coordinates, box_mass: float) -> Loads:
        """Return the loads of n instants."""

    @abstractmethod
    def effort_rule(self) -> tuple[Array, Array]:
        """Normalised times and weights of the rule that integrates the effort."""

    @abstractmethod
    def verify(self, task: T, run: SolverRun) -> Verification:
        """Check a solution between the nodes."""

    @abstractmethod
    def tightened(self, task: T, check: Verification, factor: float) -> T:
        """Return the task with a margin of a factor times the excess of a check."""

    def active_constraints(self, task: T, run: SolverRun) -> tuple[str, ...]:
        """Names of the limits that hold the objective back, the strongest first."""
        return tuple(dict.fromkeys(name for name, _ in run.active_constraints))

    @abstractmethod
    def result(self, task: T, run: SolverRun, time: Array) -> LiftResult:
        """Return a solution as forces and motion at times from its start [s]."""

    def effort(self, task: T, run: SolverRun) -> float:
        """First term of equations 2.11 and 3.9 [s]: integral of the squared normalised torques."""
        times, weights = self.effort_rule()
        coordinates = self.grid.spline.sample(run.control, times, run.duration)
        loads = self.loads(task, coordinates, run.box_mass)
        return float(run.duration * weights @ loads.effort)

    # Planned lifts.

    @abstractmethod
    def plan(
        self, subject: Subject, task: PlanTask, feet: Feet, narrowing: float = 1.0
    ) -> Plan[T]:
        """Build the task of a planned lift for feet at a place.

        Parameters
        ----------
        subject : Subject
            Person.
        task : PlanTask
            What is lifted.
        feet : Feet
            Place of the feet.
        narrowing : float
            Factor of the windows on postures.

        Raises
        ------
        TaskError
            The task does not fit the model.
        UnreachableError
            A place of the box is out of reach, or only out of balance, or only inside the body.
        """

    @abstractmethod
    def plan_starts(self, plan: Plan[T], limit: int | None = None) -> tuple[Start, ...]:
        """Return generated initial guesses of a plan, at most `limit`."""

    @abstractmethod
    def squat_index(self, subject: Subject, task: T, control: Array) -> float:
        """Stoop-Squat-Index of the first posture; NaN where C7 is not lowered."""

    @abstractmethod
    def first_feet(self, task: PlanTask) -> tuple[Feet, ...]:
        """Return places of the feet to begin the search with."""

    @abstractmethod
    def feet_rounds(self) -> tuple[float, ...]:
        """Scales of the steps from the best place, round by round."""

    @abstractmethod
    def feet_around(self, task: PlanTask, feet: Feet, scale: float) -> tuple[Feet, ...]:
        """Return places one step from the best."""

    @abstractmethod
    def plan_ways(self, task: PlanTask, feet: Feet) -> Iterable[Mapping[str, Way]]:
        """Yield ways of the box from the standard location of the revised NIOSH equation."""


def trapezoid_weights(n: int) -> Array:
    """Weights of the trapezoidal rule on [0, 1] at n even points."""
    weights = np.full(n, 1.0 / (n - 1))
    weights[[0, -1]] *= 0.5
    return weights
