# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figures of prediction_2d.md and print its tables: `python -m docs.draw_prediction_2d`.

Everything is computed anew from simulated lifts (bags.simulate); nobody was measured. With
`--no-group` the study of twelve men, which takes minutes, is left out.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, replace
from typing import Final

import matplotlib as mpl
import numpy as np
from bags.simulate.group import AGE, MASS, STATURE, lifting_task, simulated_lift
from benchmarks.predictor_pareto import OPTIONS, TASK, Study, study, task_box
from docs.draw_figures import BLUE, GREY, ORANGE, STYLE, save
from matplotlib.figure import Figure

from human_model.motion import Lift
from human_model.subject import Subject
from lift_predictor.core.models.sagittal.lift_model import COMPARED_JOINTS, SagittalModel
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.pareto import weightings
from lift_predictor.core.percentile import (
    Percentile,
    percentile_by_enumeration,
    percentile_by_root,
)
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import (
    MaximumWeight,
    Weighting,
    heaviest_box,
    maximum_weight,
)

CHAIN: Final = ('toe_r', 'ankle_r', 'knee_r', 'hip_r', 'l5_s1', 'shoulder_r', 'elbow_r', 'hand_r')
SNAPSHOTS: Final = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
RECORDED: Final = 'simulated recording'
WITH, WITHOUT = 'with MOO', 'without MOO'


@dataclass(frozen=True, eq=False)
class Validation:
    """The man outside of the group: his recorded lift, his strength, both predictions."""

    lift: Lift
    root: Percentile
    enumeration: Percentile | None
    results: dict[str, MaximumWeight]


def average_man() -> Subject:
    """Return the man who stands beside the group: the means of section 2.4."""
    return Subject('average man', 'male', MASS[0], STATURE[0], AGE[0])


def validate(enumerate_too: bool) -> Validation:
    """Find the strength of the average man and predict his heaviest box."""
    subject = average_man()
    predictor = LiftPredictor(OPTIONS)
    lift = simulated_lift(subject, lifting_task(TASK))
    box = task_box()
    found, seconds = {}, {}
    methods = {'root': percentile_by_root}
    if enumerate_too:
        methods['enumeration'] = percentile_by_enumeration
    for name, method in methods.items():
        begin = time.perf_counter()
        found[name] = method(predictor, subject, lift, box)
        seconds[name] = time.perf_counter() - begin
        print(
            f'z_score by {name}: {found[name].z_score:.4f}, {len(found[name].tried)} '
            f'predictions, {seconds[name]:.2f} s'
        )
    solver = predictor.sagittal
    strong = replace(subject, strength_z=found['root'].z_score)
    task = solver.model.maximum_weight_task(strong, lift, box)
    starts = solver.model.starts(task)
    heaviest = heaviest_box(solver, task, starts)
    moo = maximum_weight(solver, task, starts, Weighting(), heaviest)
    return Validation(
        lift, found['root'], found.get('enumeration'), {WITH: moo, WITHOUT: heaviest}
    )


def print_tables(known: Validation) -> None:
    """Print tables 2.4 and 2.5, and the table of the maximum weight."""
    print('| | measured | predicted | error |\n|---|---|---|---|')
    rows = {
        f'{name}, z = {known.root.z_score:.3f}': result.weight
        for name, result in known.results.items()
    }
    if known.enumeration is not None:
        rows[f'with MOO, z = {known.enumeration.z_score:.2f} by enumeration'] = (
            known.enumeration.predicted
        )
    for name, weight in rows.items():
        measured = known.root.measured
        print(f'| {name} | {measured:.2f} N | {weight:.2f} N | {weight - measured:+.2f} N |')
    print('| | RMSE w/ | RMSE w/o | r w/ | r w/o |\n|---|---|---|---|---|')
    both = [c for result in known.results.values() if (c := result.comparison) is not None]
    lines: list[tuple[str, list[float], list[float] | None]] = [
        (f'{joint} [deg]', [c.joint_rmse[j] for c in both], [c.joint_pearson[j] for c in both])
        for j, joint in enumerate(COMPARED_JOINTS)
    ]
    lines.append(('sum of joints [deg]', [c.joint_rmse.sum() for c in both], None))
    for name in ('vertical', 'horizontal'):
        lines.append(
            (
                f'{name} GRF [N]',
                [getattr(c, f'{name}_force_rmse') for c in both],
                [getattr(c, f'{name}_force_pearson') for c in both],
            )
        )
    lines.append(
        (
            'box weight [N]',
            [abs(r.weight - known.root.measured) for r in known.results.values()],
            None,
        )
    )
    for name, rmse, r in lines:
        ends = ['', ''] if r is None else [f'{value:.3f}' for value in r]
        print(f'| {name} | {rmse[0]:.2f} | {rmse[1]:.2f} | {ends[0]} | {ends[1]} |')
    for name, result in known.results.items():
        limits = result.active_constraints[:5]
        print(f'{name}: effort {result.effort:.4f} s; active constraints: {limits}')


def curves(found: Study) -> Figure:
    """Pareto curves in the criterion space (figure 2.4)."""
    figure = Figure(figsize=(7.6, 6.0))
    grid = figure.subplots(3, 4, sharex=True, sharey=True)
    for axes, case, number in zip(grid.ravel(), found.cases, range(1, 13), strict=True):
        axes.plot(*case.criteria.T, 'o-', color=BLUE, markersize=2.5, linewidth=0.8)
        axes.plot(*case.criteria[3], 'o', color=ORANGE, markersize=5)
        axes.set_title(f'{number}: z = {case.subject.strength_z:.2f}', fontsize=8)
    figure.supxlabel('normalised effort', fontsize=9)
    figure.supylabel('normalised -log(W + 10)', fontsize=9)
    figure.tight_layout()
    return figure


def errors(found: Study) -> Figure:
    """Total error of each case (figure 2.5)."""
    figure = Figure(figsize=(7.2, 3.2))
    axes = figure.subplots()
    shares = [weighting.effort for weighting in weightings()]
    for case in found.cases:
        axes.plot(shares, case.error.total, color=GREY, linewidth=0.6, alpha=0.6)
    axes.plot(shares, found.mean_error, 'o-', color=BLUE, markersize=4, label='mean of 12 men')
    axes.axvline(found.best.effort, color=ORANGE, linestyle='--', linewidth=1.0)
    axes.text(
        found.best.effort + 0.01,
        axes.get_ylim()[0],
        f'least at {found.best.effort:.2f}',
        color=ORANGE,
        fontsize=8,
        va='bottom',
    )
    axes.set_xlabel('weighting of the effort, w1')
    axes.set_ylabel('total error (2.24)')
    axes.legend(frameon=False, fontsize=8)
    return figure


def snapshots(known: Validation) -> Figure:
    """Postures of the recorded lift and both predictions (figure 2.6)."""
    lifts = {
        RECORDED: known.lift.window,
        **{
            f'{name}: {result.weight:.0f} N': result.prediction.lift.motion
            for name, result in known.results.items()
            if result.prediction.lift is not None
        },
    }
    figure = Figure(figsize=(7.6, 6.6))
    rows = figure.subplots(len(lifts), 1, sharex=True)
    for axes, (name, motion), colour in zip(
        rows, lifts.items(), (GREY, BLUE, ORANGE), strict=True
    ):
        for k, share in enumerate(SNAPSHOTS):
            sample = round(share * (len(motion) - 1))
            shift = 0.95 * k
            body = np.array([motion.point(point)[sample] for point in CHAIN])
            axes.plot(
                body[:, 0] + shift, body[:, 2], '.-', color=colour, linewidth=1.6, markersize=4
            )
            axes.plot(
                *(motion.point('head')[sample][[0, 2]] + (shift, 0.0)),
                'o',
                color=colour,
                markersize=9,
            )
            box = motion.box_position[sample]
            depth, _, height = lifting_task(TASK).box_size
            axes.add_patch(
                mpl.patches.Rectangle(
                    (box[0] - depth / 2 + shift, box[2] - height / 2),
                    depth,
                    height,
                    fill=False,
                    edgecolor='black',
                    linewidth=0.9,
                )
            )
        axes.axhline(0.0, color='black', linewidth=0.8)
        axes.set_aspect('equal')
        axes.set_title(name, fontsize=9, loc='left')
        axes.set_yticks([])
        axes.set_xticks(
            [0.95 * k for k in range(len(SNAPSHOTS))],
            [f'{100 * share:.0f} %' for share in SNAPSHOTS],
            fontsize=8,
        )
        axes.grid(visible=False)
    figure.tight_layout()
    return figure


def profiles(known: Validation) -> Figure:
    """Joint angles and ground reaction against the recorded lift (figure 2.7)."""
    figure = Figure(figsize=(7.6, 8.2))
    grid = figure.subplots(4, 2, sharex=True).ravel()
    measured = maximum_task(known).measured
    assert measured is not None
    share = 100.0 * measured.time / measured.time[-1]
    for j, joint in enumerate(COMPARED_JOINTS):
        grid[j].plot(share, np.degrees(measured.q[:, j]), color=GREY, label=RECORDED)
        grid[j].set_ylabel(f'{joint} [deg]', fontsize=8)
    for axes, column, name in ((grid[6], 1, 'vertical'), (grid[7], 0, 'horizontal')):
        axes.plot(share, measured.ground_force[:, column], color=GREY)
        axes.set_ylabel(f'{name} GRF [N]', fontsize=8)
        axes.set_xlabel('part of the lift [%]', fontsize=8)
    for (name, result), colour in zip(known.results.items(), (BLUE, ORANGE), strict=True):
        assert result.prediction.lift is not None
        motion = result.prediction.lift.motion
        at = np.linspace(0.0, 100.0, len(motion))
        for j, joint in enumerate(JOINTS):
            grid[j].plot(at, np.degrees(motion.coordinate(joint)), color=colour, label=name)
        total = motion.ground_force.sum(axis=1)
        grid[6].plot(at, total[:, 2], color=colour)
        grid[7].plot(at, total[:, 0], color=colour)
    figure.legend(
        *grid[0].get_legend_handles_labels(),
        frameon=False,
        fontsize=8,
        ncols=3,
        loc='upper center',
    )
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.97))
    return figure


def maximum_task(known: Validation) -> SagittalTask:
    """Return the task of the man's lift, which holds the recorded angles."""
    return SagittalModel().maximum_weight_task(average_man(), known.lift, task_box())


def print_group(found: Study) -> None:
    """Print the men and the errors of the cases."""
    print('| man | mass kg | stature m | z | N at w1 = 0, 0.15, 1 | least error at w1 |')
    for number, case in enumerate(found.cases, 1):
        who = case.subject
        best = weightings()[int(np.nanargmin(case.error.total))].effort
        ends = ', '.join(f'{case.weight[k]:.0f}' for k in (0, 3, 20))
        print(
            f'| {number} | {who.mass:.1f} | {who.stature:.3f} | {who.strength_z:.2f} | {ends} | '
            f'{best:.2f} |'
        )
    print('mean total error', np.round(found.mean_error, 3))
    solved = sum(case.solved for case in found.cases)
    print(f'best w1 = {found.best.effort:.2f}; {solved} of 252 solved in {found.seconds:.2f} s')


def main() -> None:
    """Draw the figures and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--no-group', action='store_true', help='leave out the study of 12 men')
    parser.add_argument(
        '--no-enumeration', action='store_true', help='find the strength by the root search only'
    )
    options = parser.parse_args()
    mpl.use('Agg')
    with mpl.rc_context(STYLE):
        known = validate(not options.no_enumeration)
        print_tables(known)
        save(snapshots(known), 'prediction_2d_snapshots')
        save(profiles(known), 'prediction_2d_profiles')
        if not options.no_group:
            found = study()
            print_group(found)
            save(curves(found), 'prediction_2d_pareto')
            save(errors(found), 'prediction_2d_total_error')


if __name__ == '__main__':
    main()
