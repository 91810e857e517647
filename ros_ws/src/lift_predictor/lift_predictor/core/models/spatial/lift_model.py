# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The spatial model of the lift problem: the 3D skeleton on fixed feet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from human_model.motion import BodyMotion, Lift
from human_model.subject import Subject
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.spatial.active_constraints import active_limits
from lift_predictor.core.models.spatial.assembly import (
    spatial_assembler,
    spatial_library,
    spatial_nlp,
)
from lift_predictor.core.models.spatial.evaluation import SpatialLoads, evaluate, lowering
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.lift_motion import body_motion, feet_moved, joint_torques
from lift_predictor.core.models.spatial.parameters import STRONG
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.planned import feet as places
from lift_predictor.core.models.spatial.planned.plan import place_plan
from lift_predictor.core.models.spatial.postures import GUESSES, PostureFinder
from lift_predictor.core.models.spatial.recorded_task import recorded_task
from lift_predictor.core.models.spatial.starts import (
    leads_right,
    mirrored,
    recorded_starts,
    through,
)
from lift_predictor.core.models.spatial.task import (
    KEY_JOINTS,
    SpatialTask,
    without_ground_windows,
)
from lift_predictor.core.models.spatial.verify import tightened, verify
from lift_predictor.core.models.spatial.way import standard_ways
from lift_predictor.core.options import SPATIAL, PredictorOptions
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.planning.technique import squat_index
from lift_predictor.core.problem.comparison import ComparedCurves, Pair
from lift_predictor.core.problem.loads import Coordinates
from lift_predictor.core.problem.maximum_weight import open_mass
from lift_predictor.core.problem.model import (
    LiftModel,
    LiftResult,
    Plan,
    SolveMethod,
    trapezoid_weights,
)
from lift_predictor.core.problem.nearest_lift import Way
from lift_predictor.core.problem.run import SolverRun, Start
from lift_predictor.core.problem.verification import Verification
from lift_predictor.core.solvers.solution import InteriorPointOptions
from lift_predictor.core.solvers.spline_nlp import Assembler, SplineNlp
from lift_predictor.core.solvers.stop import StopFlag

SOLVER_OPTIONS: Final = InteriorPointOptions(
    max_iterations=400, barrier=1e-3, warm_barrier=1e-7, warm_bound_push=1e-3
)
"""A larger first barrier parameter leaves the start. Warm starts: found on lifts whose box changed
by up to 1 kg and 4 cm; smaller barrier parameters save steps for small changes only."""
FOOT_TOLERANCE: Final = 1e-6
"""Distance of the feet from their place above which a solution is refused [m]."""
FAR: Final = 0.1
"""First barrier parameter of the starts that are to find other minima."""
_DENSE: Final = 401
_DERIVATIVE_DEGREE: Final = 5


class SpatialModel(LiftModel[SpatialTask]):
    """The spatial model.

    Parameters
    ----------
    options : PredictorOptions
        Settings.
    stop : StopFlag, optional
        Not needed here: runs of the solver are ended by theirs.

    Notes
    -----
    Building loads the compiled functions, or compiles them (half a minute, once per machine).
    """

    name = SPATIAL
    task_constraints = ('(3.11)', '(3.12)', '(3.13)')
    plan_starts_limit = None
    probe_starts = 1
    technique_is_constraint = True
    keeps_feet = True
    feet_moves = 6
    probes = True
    grid: SpatialGrid

    def __init__(
        self, options: PredictorOptions | None = None, stop: StopFlag | None = None
    ) -> None:
        self.options = options = options or PredictorOptions()
        self.grid = SpatialGrid(options.spline_control, options.n_nodes, options.static_ends)
        self.library = spatial_library()
        self.method = SolveMethod(
            cold=SOLVER_OPTIONS, near=SOLVER_OPTIONS,
            time_limit=max(options.time_limit, options.SPATIAL_TIME_LIMIT),
            refinements=options.refinements, margin=1.2, warm_margins=True,
            basin_hops=options.basin_hops,
        )  # fmt: skip
        self._assemblers: dict[bool, Assembler] = {}
        self._person: SpatialPerson | None = None

    def person(self, subject: Subject) -> SpatialPerson:
        """Return the person of a subject; the last one is kept."""
        if self._person is None or self._person.subject is not subject:
            self._person = SpatialPerson.of(subject, self.options.coefficient_set)
        return self._person

    def nlp(self, task: SpatialTask) -> SplineNlp:
        """Return the NLP of a task."""
        technique = task.bounds.technique
        if technique not in self._assemblers:
            self._assemblers[technique] = spatial_assembler(self.library, self.grid, technique)
        assembler = self._assemblers[technique]
        return spatial_nlp(assembler, self.grid, task.parameters.pack(), task.bounds)

    def variables(self, task: SpatialTask, start: Start) -> Array:
        """Return the variables of an initial guess."""
        mass = np.clip(start.box_mass, *task.bounds.box_mass)
        duration = task.duration if start.duration is None else start.duration
        duration = np.clip(duration, *task.bounds.duration)
        return np.concatenate((start.control.ravel(), (mass, duration)))

    def duration(self, task: SpatialTask, x: Array) -> float:
        """Duration of a solution [s]."""
        return float(x[-1])

    def displacement(self, task: SpatialTask, shift: Array) -> Array:
        """Return a random displacement, mirrored for lifts to the right."""
        return mirrored(shift) if leads_right(task) else shift

    def recorded_task(
        self, subject: Subject, lift: Lift, box: Box, fraction: float = 1.0
    ) -> SpatialTask:
        """Return the task of a recorded lift."""
        return recorded_task(self.person(subject), lift, box, self.grid, self.options.windows)

    def maximum_weight_task(self, subject: Subject, lift: Lift, box: Box) -> SpatialTask:
        """Return the task of a recorded lift whose mass is open, without ground windows."""
        return open_mass(self.with_other_mass(self.recorded_task(subject, lift, box)))

    def starts(self, task: SpatialTask) -> tuple[Start, ...]:
        """Return the initial guesses of a recorded task."""
        return recorded_starts(task, self.grid)

    def heaviest_starts(self, task: SpatialTask, starts: Iterable[Start]) -> tuple[Start, ...]:
        """Return the initial guesses where the weight alone is maximised."""
        starts = tuple(starts)
        return (*starts, *self.weighted_starts(task, starts))

    def weighted_starts(self, task: SpatialTask, starts: Iterable[Start]) -> tuple[Start, ...]:
        """Return the same starts with a barrier parameter that leads far from them."""
        return tuple(replace(s, name=f'{s.name}, far', barrier=FAR) for s in starts)

    def with_other_mass(self, task: SpatialTask) -> SpatialTask:
        """Return the task without the ground reactions that were recorded with its mass."""
        return without_ground_windows(task)

    def loads(self, task: SpatialTask, coordinates: Coordinates, box_mass: float) -> SpatialLoads:
        """Return the loads of n instants."""
        return evaluate(self.library, *coordinates, box_mass, task.parameters)

    def effort_rule(self) -> tuple[Array, Array]:
        """Trapezoidal rule on a dense grid."""
        return np.linspace(0.0, 1.0, _DENSE), trapezoid_weights(_DENSE)

    def verify(self, task: SpatialTask, run: SolverRun) -> Verification:
        """Check a solution between the nodes."""
        return verify(self.library, self.grid, task, run.control, run.box_mass, run.duration)

    def tightened(self, task: SpatialTask, check: Verification, factor: float) -> SpatialTask:
        """Return the task with a margin of a factor times the excess of a check."""
        return replace(task, bounds=tightened(task.bounds, check.excess, factor))

    def active_constraints(self, task: SpatialTask, run: SolverRun) -> tuple[str, ...]:
        """Names of the limits that hold the objective back, the strongest first."""
        return active_limits(task, self.grid, run.solution)

    def result(self, task: SpatialTask, run: SolverRun, time: Array) -> LiftResult:
        """Return a solution as forces and motion in the laboratory."""
        duration = run.duration
        coordinates = self.grid.spline.sample(run.control, time / duration, duration)
        loads = self.loads(task, coordinates, run.box_mass)
        motion = body_motion(task, task.start + time, coordinates, loads, run.box_mass > 0.0)
        moved = feet_moved(task, motion)
        problem = ''
        if moved > FOOT_TOLERANCE:
            problem = f'the feet are {1e3 * moved:.3g} mm off their place'
        torque, lower, upper = joint_torques(task, motion)
        p = task.parameters
        ends = p.ankle[:, :1] + np.cos(p.foot_turn)[:, None] * p.sole
        return LiftResult(
            motion=motion,
            torque_names=task.person.skeleton.coordinates[-torque.shape[1] :],
            torque=torque,
            torque_lower=lower,
            torque_upper=upper,
            zmp=loads.zmp[:, 0],
            support=np.array([ends.min(), ends.max()]),
            ground_force=loads.ground_force,
            loads=loads,
            curves=self._compared_curves(task, run, motion, loads),
            problem=problem,
        )

    def _compared_curves(
        self, task: SpatialTask, run: SolverRun, motion: BodyMotion, loads: SpatialLoads
    ) -> ComparedCurves | None:
        """Return the curves of a recorded task and of its solution (figures 3.4, 5.3 to 5.5)."""
        recorded = task.recorded
        if recorded is None:
            return None
        # Loads for long, and a node that starts does not need it.
        from scipy.interpolate import make_interp_spline

        spline = make_interp_spline(recorded.time, recorded.q, k=_DERIVATIVE_DEGREE)
        velocity, acceleration = (spline(recorded.time, nu=order) for order in (1, 2))
        # Both from start to end: the duration may differ.
        at = recorded.time / recorded.time[-1] * run.duration + motion.time[0]

        def pair(own: Array, predicted: Array) -> Pair:
            return Pair(own, np.interp(at, motion.time, predicted))

        ground = loads.ground_force
        return ComparedCurves(
            joints={
                name: pair(recorded.key[name], motion.coordinate(name)) for name in KEY_JOINTS
            },
            feet=tuple(pair(recorded.vertical[:, k], ground[:, k, 2]) for k in range(2)),
            vertical=pair(recorded.vertical.sum(axis=1), ground[:, :, 2].sum(axis=1)),
            horizontal=pair(recorded.forward, ground[:, :, 0].sum(axis=1)),
            time=recorded.time,
            torque_names=STRONG,
            recorded_loads=self.loads(task, (recorded.q, velocity, acceleration), run.box_mass),
            predicted_effort=float(np.trapezoid(loads.effort, motion.time - motion.time[0])),
        )

    def plan(
        self, subject: Subject, task: PlanTask, feet: Feet, narrowing: float = 1.0
    ) -> Plan[SpatialTask]:
        """Build the task of a planned lift for feet at a place."""
        return place_plan(self.library, self.grid, self.person(subject), task, feet)

    def plan_starts(self, plan: Plan[SpatialTask], limit: int | None = None) -> tuple[Start, ...]:
        """Return initial guesses: by least effort at rest, if the box can be held so, and by ends.

        Where the person is too weak to hold the box, the last alone is left to begin with. With a
        limit, postures at rest are searched from one guess only.
        """
        mass = plan.task.mass[0]
        first, last = plan.ends[0]
        own = through(plan.task, self.grid, (first, None, last), 'between near postures', mass)
        guesses = GUESSES if limit is None else 1
        try:
            found = PostureFinder(self.library).starts(plan.task, self.grid, guesses)
        except UnreachableError:
            found = ()
        return (*found, own)[:limit]

    def squat_index(self, subject: Subject, task: SpatialTask, control: Array) -> float:
        """Stoop-Squat-Index of the first posture; NaN where C7 is not lowered."""
        return float(squat_index(*lowering(self.library, control[:1], task.parameters))[0])

    def first_feet(self, task: PlanTask) -> tuple[Feet, ...]:
        """Return places of the feet to begin the search with."""
        return places.candidates(task)

    def feet_rounds(self) -> tuple[float, ...]:
        """Scales of the steps from the best place, round by round."""
        return tuple(0.5**number for number in range(places.HALVINGS + 1))

    def feet_around(self, task: PlanTask, feet: Feet, scale: float) -> tuple[Feet, ...]:
        """Return places one step from the best."""
        return places.around(task, feet, scale)

    def plan_ways(self, task: PlanTask, feet: Feet) -> Iterable[Mapping[str, Way]]:
        """Yield ways of the box from the standard location of the revised NIOSH equation."""
        return standard_ways(task, feet)
