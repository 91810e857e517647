# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figure of planning.md and print its table: `python -m docs.draw_planning`.

The two symmetric recordings of bags/ (simulated) are predicted with their recorded postures, and
planned from the task alone: the same person, feet, places of the box and time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import matplotlib as mpl
import numpy as np
from docs.draw_figures import BLUE, GREY, ORANGE, ROOT, STYLE, save
from matplotlib.figure import Figure

from human_model.motion import BodyMotion
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.planning.technique import stoop_squat_index
from lift_predictor.core.sagittal.comparison import COMPARED_JOINTS
from lift_predictor.core.sagittal.parameters import JOINTS
from lift_predictor.core.sagittal.task import Box, LiftTask2D, build_task
from lifting_bringup.bags.reader import BagReader
from lifting_bringup.recorded_lifts import recorded_lifts
from muscle_analyzer.core.analyzer import MuscleAnalyzer

BAGS: Final = ('symmetric_7kg', 'symmetric_12kg')
RECORDED: Final = 'recorded postures'
PLANS: Final = {
    'planned, free': ('free', 'free'),
    'planned, free, upright end': ('free', 'upright'),
    'planned, {technique}, upright end': ('{technique}', 'upright'),
}
"""Name in the table: technique and posture at the end; {technique}: that of the recording."""
COLOURS: Final = (GREY, BLUE, '#6aa84f', ORANGE)


@dataclass(frozen=True, eq=False)
class Curve:
    """One optimal lift: its motion, effort [s], technique and peak loads of L5-S1 [N]."""

    name: str
    motion: BodyMotion
    effort: float
    index: float
    compression: float
    shear: float

    def angles(self, share: np.ndarray) -> np.ndarray:
        """Joint angles over the share of the lift (n, 6) [deg]."""
        own = (self.motion.time - self.motion.time[0]) / np.ptp(self.motion.time)
        columns = [self.motion.coordinates.index(joint) for joint in JOINTS]
        q = self.motion.position[:, columns]
        return np.degrees(np.stack([np.interp(share, own, column) for column in q.T], axis=1))


def box_of(bag: str) -> tuple[float, tuple[float, float, float]]:
    """Mass [kg] and size [m] of a recording's box."""
    with BagReader(ROOT / 'bags' / bag) as reader:
        topics = [name for name in reader.topics if name.strip('/') == 'task']
        (message,) = (message for _, _, message in reader.messages(topics))
    depth, width, height = (float(length) for length in message.box_size)
    return message.box_mass, (depth, width, height)


def same_task(
    recorded: LiftTask2D, size: tuple[float, float, float], styles: tuple[str, str]
) -> PlanTask:
    """Describe a recorded task without its postures; the floor of a plan is at 0."""
    parameters = recorded.parameters
    grips = recorded.bounds.hand - np.array([0.0, parameters.ground_height])
    places = grips + parameters.box_from_hand
    # The tracked box may stand a millimetre or two in the floor.
    lowest = 0.5 * size[2]
    start, end = ((float(x), 0.0, max(float(up), lowest)) for x, up in places)
    forward, up = (float(value) for value in parameters.box_from_hand)
    return PlanTask(
        recorded.lift_id, parameters.box_mass, size, start, end,
        (float(parameters.ankle[0]), 0.0), parameters.duration, *styles, (forward, up),
    )  # fmt: skip


def curves(bag: str) -> list[Curve]:
    """Solve one recording in all ways."""
    mass, size = box_of(bag)
    recording = recorded_lifts(ROOT / 'bags' / bag)
    lift, subject = recording.lift(1).lift, recording.subject
    planner = LiftPlanner()
    planner.predictor.configure(subject)
    box = Box(mass=mass, depth=size[0])
    task = build_task(planner.predictor.person, lift, box)
    predicted = planner.predictor.predict(lift, box)
    best = predicted.optima[0].control[:1]
    index = float(stoop_squat_index(best, task.person, task.parameters)[0])
    analyzer = MuscleAnalyzer()
    analyzer.configure(subject)
    found = [_curve(RECORDED, predicted, index, analyzer)]
    own = technique_of(index)
    for name, styles in PLANS.items():
        technique, end = (style.format(technique=own) for style in styles)
        planned = planner.plan(subject, same_task(task, size, (technique, end)))
        if not planned.report.ok:
            raise SystemExit(f'{bag}, {name}: {planned.report.message}')
        words = name.format(technique=own.replace('_', '-'))
        found.append(_curve(words, planned.prediction, planned.index, analyzer))
    return found


def technique_of(index: float) -> str:
    """Name of the technique that an index belongs to (Schmid 2022)."""
    return 'squat' if index < 30.0 else 'stoop' if index > 90.0 else 'semi_squat'


def _curve(name: str, prediction: object, index: float, analyzer: MuscleAnalyzer) -> Curve:
    motion = prediction.lift.motion
    analysis = analyzer.analyze(motion, 'lift', 'predicted')
    good = analysis.spine_status == 0
    return Curve(
        name, motion, prediction.report.objective, index,
        float(analysis.compression[good].max()), float(analysis.anterior_shear[good].max()),
    )  # fmt: skip


def main() -> None:
    """Print the table and draw the figure."""
    mpl.rcParams.update(STYLE)
    share = np.linspace(0.0, 1.0, 101)
    figure = Figure(figsize=(10.0, 5.4))
    axes = figure.subplots(len(BAGS), len(JOINTS), sharex=True)
    joints = ' | '.join(COMPARED_JOINTS)
    print(f'| recording | lift | effort s | index | {joints} | compression N | shear N |')
    print('|---' * (6 + len(JOINTS)) + '|')
    for row, bag in zip(axes, BAGS, strict=True):
        found = curves(bag)
        reference = found[0].angles(share)
        for curve, colour in zip(found, COLOURS, strict=True):
            angles = curve.angles(share)
            rmse = np.sqrt(((angles - reference) ** 2).mean(axis=0))
            distances = ' | '.join(f'{value:.0f}' for value in rmse)
            print(f'| {bag} | {curve.name} | {curve.effort:.3f} | {curve.index:.0f} | {distances} '
                  f'| {curve.compression:.0f} | {curve.shear:.0f} |', flush=True)
            for axis, column in zip(row, angles.T, strict=True):
                axis.plot(100.0 * share, column, color=colour, label=curve.name)
        row[0].set_ylabel(f'{bag}\n[deg]')
    for axis, joint in zip(axes[0], COMPARED_JOINTS, strict=True):
        axis.set_title(joint)
    for axis in axes[-1]:
        axis.set_xlabel('% of the lift')
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='lower center', ncols=4, frameon=False)
    figure.tight_layout(rect=(0.0, 0.07, 1.0, 1.0))
    save(figure, 'planning_angles')


if __name__ == '__main__':
    main()
