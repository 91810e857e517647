# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figure of planning.md and print its tables: `python -m docs.draw_planning`.

Three recordings of bags/ (simulated) are predicted with their recorded postures, and planned from
the task alone: the same person, middle of the feet, places of the box and time. The symmetric ones
are also planned in space.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import matplotlib as mpl
import numpy as np
from docs.draw_figures import BLUE, GREY, ORANGE, ROOT, STYLE, save
from matplotlib.figure import Figure

from human_model.motion import BodyMotion, Lift
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.models.sagittal.lift_model import COMPARED_JOINTS
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.prediction import Prediction
from lifting_cli.recorded_lifts import recorded_lifts
from lifting_recordings.reader import BagReader
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

BAGS: Final = ('symmetric_7kg', 'symmetric_12kg', 'asymmetric_7kg')
RECORDED: Final = 'recorded postures'
PLANS: Final = {
    'planned, free': ('free', 'free'),
    'planned, free, upright end': ('free', 'upright'),
    'planned, {technique}, upright end': ('{technique}', 'upright'),
}
"""Name in the table: technique and posture at the end; {technique}: that of the recording."""
COLOURS: Final = (GREY, BLUE, '#6aa84f', ORANGE)
COLUMNS: Final = (*COMPARED_JOINTS, 'spine turn')
SPINE: Final = ('lumbar_extension', 'thorax_extension')
TURN: Final = ('lumbar_rotation', 'thorax_rotation')


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
        """Joint angles over the share of the lift, right and left (n, 7, 2) [deg]."""
        motion = self.motion
        own = (motion.time - motion.time[0]) / np.ptp(motion.time)

        def total(*names: str) -> np.ndarray:
            known = [name for name in names if name in motion.coordinates]
            values = np.sum([motion.coordinate(name) for name in known], axis=0)
            return np.asarray(np.interp(share, own, np.broadcast_to(values, own.shape)))

        columns: list[tuple[np.ndarray, ...]] = [(total(*SPINE),) * 2]
        for joint in JOINTS[1:]:
            columns.append(tuple(total(joint, f'{joint}_{side}') for side in 'rl'))
        columns.append((total(*TURN),) * 2)
        return np.asarray(np.degrees(np.transpose(columns, (2, 0, 1))))

    def distance(self, other: Curve) -> str:
        """RMSE of the joint angles to another lift, both sides together, as cells [deg]."""
        share = np.linspace(0.0, 1.0, 101)
        apart = self.angles(share) - other.angles(share)
        rmse = np.sqrt((apart**2).mean(axis=(0, 2)))
        return ' | '.join(f'{value:.0f}' for value in rmse)


def box_of(bag: str) -> tuple[float, tuple[float, float, float]]:
    """Mass [kg] and size [m] of a recording's box."""
    with BagReader(ROOT / 'bags' / bag) as reader:
        topics = [name for name in reader.topics if name.strip('/') == 'task']
        (message,) = (message for _, _, message in reader.messages(topics))
    depth, width, height = (float(length) for length in message.box_size)
    return message.box_mass, (depth, width, height)


def same_task(
    recorded: SagittalTask, size: tuple[float, float, float], styles: tuple[str, str]
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


def same_task_in_space(
    recorded: SpatialTask, size: tuple[float, float, float], styles: tuple[str, str]
) -> PlanTask:
    """Describe a recorded task without its postures, seen from between its feet."""
    hands = recorded.bounds.hand.reshape(2, 2, 3)
    line = hands[:, 1] - hands[:, 0]
    turns = np.arctan2(-line[:, 0], line[:, 1])
    away, aside, up = recorded.parameters.box_from_hand
    c, s = np.cos(turns), np.sin(turns)
    offset = np.stack((c * away - s * aside, s * away + c * aside, np.full(2, up)), axis=1)
    centres = hands.mean(axis=1) + offset
    start, end = ((float(x), float(y), max(float(z), 0.5 * size[2])) for x, y, z in centres)
    return PlanTask(
        recorded.lift_id, float(recorded.bounds.box_mass[0]), size, start, end, (0.0, 0.0),
        recorded.duration, *styles, (float(away), float(up)),
    )  # fmt: skip


def curves(bag: str) -> tuple[list[Curve], list[Curve]]:
    """Solve one recording in all ways; and what was planned in the plane again in space."""
    mass, size = box_of(bag)
    recording = recorded_lifts(ROOT / 'bags' / bag)
    lift, subject = recording.lift(1).lift, recording.subject
    planner = LiftPlanner()
    box = Box(mass, size)
    predicted = planner.predictor.predict(subject, lift, box)
    if not predicted.report.ok:
        raise SystemExit(f'{bag}: {predicted.report.message}')
    in_space = predicted.model == 'spatial'

    def plain(styles: tuple[str, str]) -> PlanTask:
        if in_space:
            task = planner.predictor.spatial.model.recorded_task(subject, lift, box)
            return same_task_in_space(task, size, styles)
        flat = planner.predictor.sagittal.model.recorded_task(subject, lift, box)
        return same_task(flat, size, styles)

    analyzer = MuscleAnalyzer(subject)
    index = _index(planner, predicted, subject, lift, box)
    found, again = [_curve(RECORDED, predicted, index, analyzer)], list[Curve]()
    own = technique_of(index)
    other = LiftPlanner(LiftPredictor(PredictorOptions(dimension='3d')))
    for name, styles in PLANS.items():
        technique, end = (style.format(technique=own) for style in styles)
        words = name.format(technique=own.replace('_', '-'))
        for kept, used in ((found, planner), (again, other)):
            if used is other and in_space:
                continue
            planned = used.plan(subject, plain((technique, end)))
            if not planned.report.ok:
                raise SystemExit(f'{bag}, {name}: {planned.report.message}')
            effort = planned.report.objective
            if planned.prediction.model == 'spatial':
                effort = planned.prediction.effort
            kept.append(_curve(words, planned.prediction, planned.index, analyzer, effort))
    return found, again


def _index(
    planner: LiftPlanner, predicted: Prediction, subject: Subject, lift: Lift, box: Box
) -> float:
    """Stoop-Squat-Index of the first posture of a prediction."""
    control = predicted.runs[0].control
    if predicted.model == 'spatial':
        spatial = planner.predictor.spatial.model
        return spatial.squat_index(subject, spatial.recorded_task(subject, lift, box), control)
    sagittal = planner.predictor.sagittal.model
    return sagittal.squat_index(subject, sagittal.recorded_task(subject, lift, box), control)


def technique_of(index: float) -> str:
    """Name of the technique that an index belongs to (Schmid 2022)."""
    return 'squat' if index < 30.0 else 'stoop' if index > 90.0 else 'semi_squat'


def _curve(
    name: str,
    prediction: Prediction | Prediction,
    index: float,
    analyzer: MuscleAnalyzer,
    effort: float | None = None,
) -> Curve:
    assert prediction.lift is not None
    motion = prediction.lift.motion
    analysis = analyzer.analyze(motion, 'lift', 'predicted')
    good = analysis.spine_status == 0
    return Curve(
        name, motion, prediction.report.objective if effort is None else effort, index,
        float(analysis.compression[good].max()), float(analysis.anterior_shear[good].max()),
    )  # fmt: skip


def row_of(bag: str, curve: Curve, reference: Curve) -> str:
    """One row of a table: distance to a reference, then loads."""
    return (
        f'| {bag} | {curve.name} | {curve.effort:.3f} | {curve.index:.0f} '
        f'| {curve.distance(reference)} | {curve.compression:.0f} | {curve.shear:.0f} |'
    )


def main() -> None:
    """Print the tables and draw the figure."""
    mpl.rcParams.update(STYLE)
    share = np.linspace(0.0, 1.0, 101)
    figure = Figure(figsize=(11.0, 7.4))
    axes = figure.subplots(len(BAGS), len(COLUMNS), sharex=True)
    joints = ' | '.join(COLUMNS)
    head = (
        f'| recording | lift | effort s | index | {joints} | compression N | shear N |\n'
        f'{"|---" * (6 + len(COLUMNS))}|'
    )
    print(head)
    second = []
    for row, bag in zip(axes, BAGS, strict=True):
        found, again = curves(bag)
        for curve, colour in zip(found, COLOURS, strict=True):
            print(row_of(bag, curve, found[0]), flush=True)
            angles = curve.angles(share)
            for axis, joint in zip(row, np.transpose(angles, (1, 2, 0)), strict=True):
                axis.plot(100.0 * share, joint[0], color=colour, label=curve.name)
                if np.abs(joint[1] - joint[0]).max() > 0.1:
                    axis.plot(100.0 * share, joint[1], color=colour, linestyle='--')
        # The plan in the plane is the reference of the same plan in space.
        second += [row_of(bag, b, a) for a, b in zip(found[1:], again, strict=bool(again))]
        row[0].set_ylabel(f'{bag}\n[deg]')
    print(f'\nIn space against in the plane\n{head}', *second, sep='\n')
    for axis, joint in zip(axes[0], COLUMNS, strict=True):
        axis.set_title(joint)
    for axis in axes[-1]:
        axis.set_xlabel('% of the lift')
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='lower center', ncols=4, frameon=False)
    figure.tight_layout(rect=(0.0, 0.05, 1.0, 1.0))
    save(figure, 'planning_angles')


if __name__ == '__main__':
    main()
