# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of person and box: key postures, smooth passage, feet and hands held in place."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from bags.simulate.body import SIDES, Body, Goal
from bags.simulate.profiles import minimum_jerk, quintic, slow_wander
from bags.simulate.tasks import Stage, Task
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial.transform import Rotation

from human_model.typing import Array

# Postures are solved at this rate and joined by quintic splines [Hz].
SOLVE_RATE = 100.0


@dataclass(frozen=True)
class Phases:
    """When what begins [s]."""

    descend: float
    grasp: float
    lift_off: float
    peak: float
    rest: float
    end: float


@dataclass(frozen=True)
class SimulatedMotion:
    """A lift as continuous functions of time.

    Attributes
    ----------
    task : Task
        Which.
    phases : Phases
        When; `lift_off` and `peak` are start and end of the lift as the thesis defines them.
    coordinates : BSpline
        Joint coordinates (n_q,) [rad], [m].
    box : BSpline
        Centre of the box (3,) [m] and its turn about the vertical [rad].
    """

    task: Task
    phases: Phases
    coordinates: BSpline
    box: BSpline


@dataclass(frozen=True)
class Plan:
    """What a motion is to follow, in n samples.

    Attributes
    ----------
    task, phases : Task, Phases
        Which and when.
    time : ndarray (n,)
        [s].
    box : ndarray (n, 4)
        Centre [m] and yaw [rad].
    reference : ndarray (n, n_q)
        Postures before feet and hands are held in place.
    hands : ndarray (n, 2, 3)
        Grip centres [m].
    """

    task: Task
    phases: Phases
    time: Array
    box: Array
    reference: Array
    hands: Array


def _postures() -> dict[str, Any]:
    path = Path(__file__).parent / 'postures.yaml'
    return dict(yaml.safe_load(path.read_text(encoding='utf-8')))


def _preferred(body: Body, entry: dict[str, float]) -> dict[str, float]:
    wishes = {}
    for name, value in entry.items():
        si = value if name in ('pelvis_tx', 'pelvis_ty', 'pelvis_tz') else np.radians(value)
        if name in body.skeleton.coordinates:
            wishes[name] = float(si)
        else:
            wishes.update({f'{name}_{side}': float(si) for side in SIDES})
    return wishes


def phases(task: Task) -> Phases:
    """Return the times of a task's phases."""
    d = task.durations
    descend = d['stand']
    grasp = descend + d['descend']
    lift_off = grasp + d['grasp']
    peak = lift_off + d['lift']
    rest = peak + d['lower']
    return Phases(descend, grasp, lift_off, peak, rest, rest + d['hold'])


def grips(task: Task, box: Array) -> Array:
    """Return the grip centres (..., 2, 3) right, left for boxes (..., 4): centre and yaw."""
    half = 0.5 * task.box_size[1]
    yaw = box[..., 3]
    side = np.stack((-np.sin(yaw), np.cos(yaw), np.zeros_like(yaw)), axis=-1)
    centre = box[..., :3] + np.array([0.0, 0.0, task.grip_height])
    return np.stack((centre - half * side, centre + half * side), axis=-2)


def box_path(stage: Stage, task: Task, front_edge: float, time: Array) -> Array:
    """Return centre and yaw (n, 4) of the box.

    The height begins with a ramp of force, rises to `clearance` over its final height, where it is
    slowed at `peak_deceleration`, and comes down to rest.
    """
    when = phases(task)
    depth, _, height = task.box_size
    start = np.array(
        [front_edge + task.gap_to_plates + depth / 2, 0.0, task.floor_gap + height / 2]
    )
    end = np.array(task.end)
    top = end[2] + stage.clearance
    deceleration = stage.peak_deceleration
    up = quintic(time, when.lift_off, when.peak, (start[2], 0.0, 0.0), (top, 0.0, -deceleration))
    down = quintic(time, when.peak, when.rest, (top, 0.0, -deceleration), (end[2], 0.0, 0.0))
    box = np.empty((time.size, 4))
    box[:, 2] = np.where(time < when.peak, up, down)
    # Up first, then out: the way forward and the turn begin a little after lift-off.
    out = minimum_jerk(time, when.lift_off + 0.15 * (when.peak - when.lift_off), when.rest)
    box[:, :2] = start[:2] + out[:, None] * (end[:2] - start[:2])
    box[:, 3] = out * task.end_yaw
    return box


class MotionBuilder:
    """Builds the motion of one task.

    Parameters
    ----------
    stage : Stage
        Subject and room.
    body : Body
        The person.
    """

    def __init__(self, stage: Stage, body: Body) -> None:
        self.stage, self.body = stage, body
        self._wishes = _postures()
        tips = body.sole(1.0)[:, 0]
        self.front_edge = float(tips.max()) + stage.toes_to_plate_edge

    def plan(self, task: Task) -> Plan:
        """Return what the motion of a task is to follow."""
        when = phases(task)
        time = np.arange(round(when.end * SOLVE_RATE) + 1) / SOLVE_RATE
        rng = np.random.default_rng(task.seed)
        box = box_path(self.stage, task, self.front_edge, time)
        reference = self._reference(task, time, box) + self._wander(time, rng)
        return Plan(task, when, time, box, reference, self._hand_path(task, time, box, reference))

    def solve(self, plan: Plan, centre: Array | None = None) -> SimulatedMotion:
        """Return the motion nearest to the plan with feet, hands (and centre of mass) in place.

        Parameters
        ----------
        plan : Plan
            What to follow.
        centre : ndarray (n, 2) or None
            Centre of mass, horizontally, in every sample [m]; None: free.

        Raises
        ------
        RuntimeError
            A joint limit or the reach is exceeded.
        """
        q = np.empty_like(plan.reference)
        last = plan.reference[0]
        for i in range(plan.time.size):
            at = None if centre is None else centre[i]
            q[i] = last = self.body.project(plan.reference[i], plan.hands[i], last, at)
        self._check_limits(plan.task, plan.time, q)
        return SimulatedMotion(
            plan.task,
            plan.phases,
            make_interp_spline(plan.time, q, k=5),
            make_interp_spline(plan.time, plan.box, k=5),
        )

    def key_postures(self, task: Task, time: Array, box: Array) -> dict[str, Array]:
        """Return the postures 'stand', 'grasp', 'middle', 'end'."""
        when = phases(task)
        share = self._wishes['middle_share']
        at = {
            'grasp': when.lift_off,
            'middle': when.lift_off + share * (when.peak - when.lift_off),
            'end': when.rest,
        }
        keys = {}
        for name in ('stand', 'grasp', 'middle', 'end'):
            point = self.body.sole(self._wishes['balance'][name])[:, :2].mean(axis=0)
            hands, axis, carried, mass = None, np.array([1.0, 0.0, 0.0]), None, 0.0
            if name in at:
                row = box[np.searchsorted(time, at[name])]
                hands = grips(task, row)
                axis = Rotation.from_euler('z', row[3]).apply(axis)
                if name != 'grasp':
                    carried, mass = row[:3], task.box_mass
            goal = Goal(hands, axis, point, mass, carried)
            wishes = _preferred(self.body, self._wishes[name])
            rough = self.body.posture(wishes, goal)
            # The toes lie flat.
            rough[[self.body.skeleton.index(f'mtp_angle_{side}') for side in SIDES]] = 0.0
            keys[name] = self.body.project(rough, hands)
        return keys

    def _reference(self, task: Task, time: Array, box: Array) -> Array:
        """Return the passage through the key postures before the hands are held in place."""
        when = phases(task)
        keys = self.key_postures(task, time, box)
        names = self.body.skeleton.coordinates
        share = self._wishes['middle_share']
        reference = np.empty((time.size, len(names)))
        for j, name in enumerate(names):
            stem = name[:-2] if name[-2:] in ('_r', '_l') else name
            lead = self._wishes['lead'].get(stem, 0.0)
            down = minimum_jerk(time, when.descend - lead, when.grasp - lead)
            up = minimum_jerk(time, when.lift_off - lead, when.rest - lead)
            first, middle, last = (keys[k][j] for k in ('grasp', 'middle', 'end'))
            # Parabola through grasp (0), middle (at the share of the way up) and end (1).
            s = float(
                minimum_jerk(
                    np.array([when.lift_off + share * (when.peak - when.lift_off)]),
                    when.lift_off,
                    when.rest,
                )[0]
            )
            bend = (middle - first - s * (last - first)) / (s * (s - 1.0))
            lifted = first + up * (last - first) + bend * up * (up - 1.0)
            reference[:, j] = keys['stand'][j] + down * (lifted - keys['stand'][j])
        return reference

    def _wander(self, time: Array, rng: np.random.Generator) -> Array:
        names = self.body.skeleton.coordinates
        amount = self._wishes['wander']
        columns = []
        for name in names:
            shift = name in ('pelvis_tx', 'pelvis_ty', 'pelvis_tz')
            size = amount['pelvis'] * 1e-3 if shift else np.radians(amount['angle'])
            columns.append(slow_wander(time, rng, 0.0 if name.startswith('mtp') else size))
        return np.stack(columns, axis=1)

    def _hand_path(self, task: Task, time: Array, box: Array, reference: Array) -> Array:
        """Return the grip centres (n, 2, 3): from hanging arms to the box, then with the box."""
        when = phases(task)
        body = self.body
        held = grips(task, box)
        begin = when.descend + 0.2 * (when.grasp - when.descend)
        reach = minimum_jerk(time, begin, when.grasp)[:, None, None]
        free = np.empty_like(held)
        last = reference[0]
        for i in range(time.size):
            last = body.project(reference[i], None, last)
            free[i] = body.hands(last)
        return np.asarray((1.0 - reach) * free + reach * held)

    def _check_limits(self, task: Task, time: Array, q: Array) -> None:
        low, high = self.body.skeleton.limits.T
        over = np.maximum(low - q, q - high)
        i, j = np.unravel_index(np.argmax(over), over.shape)
        if over[i, j] > 0.0:
            name = self.body.skeleton.coordinates[j]
            raise RuntimeError(
                f'{task.name}: {name} is {np.degrees(q[i, j]):.1f} degrees at {time[i]:.2f} s, '
                f'limits {np.degrees(low[j]):.1f} to {np.degrees(high[j]):.1f}'
            )
