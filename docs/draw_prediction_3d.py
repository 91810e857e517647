# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figures of prediction_3d.md and print its numbers: `python -m docs.draw_prediction_3d`.

Everything is computed anew from the simulated recordings in `bags/`; nobody was measured.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import matplotlib as mpl
import numpy as np
from benchmarks.predictor_spatial import recorded_lift
from docs.draw_figures import BLUE, GREY, ORANGE, STYLE, save
from matplotlib.figure import Figure

from human_model.motion import BodyMotion, Lift
from human_model.named_subjects import named_subject
from human_model.task import Box
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.comparison import LiftComparison
from lift_predictor.core.problem.maximum_weight import maximum_weight
from lift_predictor.core.problem.prediction import Prediction

SUBJECT: Final = 'thesis_ch4'
LIFT: Final = 'asymmetric_7kg'
SIZE: Final = (0.238, 0.305, 0.127)
SNAPSHOTS: Final = (0.0, 0.25, 0.5, 0.75, 1.0)
CHAINS: Final = (
    *(tuple(f'{point}_{side}' for point in ('toe', 'heel', 'ankle', 'knee', 'hip'))
      for side in 'rl'),
    *(tuple(f'{point}_{side}' for point in ('shoulder', 'elbow', 'wrist', 'hand'))
      for side in 'rl'),
    ('hip_r', 'hip_l'), ('pelvis', 'l5_s1', 'c7', 'head'), ('shoulder_r', 'c7', 'shoulder_l'),
    ('hand_r', 'hand_l'),
)  # fmt: skip
ANGLES: Final = (
    'hip_flexion_r', 'hip_flexion_l', 'knee_angle_r', 'knee_angle_l', 'ankle_angle_r',
    'ankle_angle_l', 'arm_flex_r', 'arm_flex_l', 'elbow_flex_r', 'elbow_flex_l',
    'lumbar_extension', 'lumbar_rotation',
)  # fmt: skip


def both(recorded: BodyMotion, predicted: BodyMotion) -> tuple[tuple[BodyMotion, str, str], ...]:
    """Return both motions with colour and name."""
    return (recorded, GREY, 'recorded'), (predicted, BLUE, 'predicted')


def snapshots(recorded: BodyMotion, predicted: BodyMotion) -> Figure:
    """Both lifts from the side and from the front (figures 3.5, 5.2)."""
    figure = Figure(figsize=(10.0, 6.4), layout='constrained')
    axes = figure.subplots(4, len(SNAPSHOTS), sharex='row', sharey=True)
    rows = both(recorded, predicted)
    for view, (axis, label) in enumerate(((0, 'from the side'), (1, 'from the front'))):
        for which, (motion, colour, name) in enumerate(rows):
            line = axes[2 * view + which]
            for part, panel in zip(SNAPSHOTS, line, strict=True):
                at = round(part * (len(motion) - 1))
                for chain in CHAINS:
                    points = np.array([motion.point(point)[at] for point in chain])
                    across = points[:, 0] if axis == 0 else -points[:, 1]
                    panel.plot(across, points[:, 2], color=colour, lw=1.2)
                box = motion.box_position[at]
                panel.plot(box[0] if axis == 0 else -box[1], box[2], 's', color=ORANGE, ms=7)
                panel.set_aspect('equal')
                panel.locator_params(axis='x', nbins=3)
                if view == 0 and which == 0:
                    panel.set_title(f'{100 * part:.0f} %')
            line[0].set_ylabel(f'{name}\n{label}\n[m]')
    return figure


def angles(recorded: BodyMotion, predicted: BodyMotion) -> Figure:
    """Joint angles over the lift (figures 3.4, 5.3, 5.4)."""
    figure = Figure(figsize=(10.0, 6.0), layout='constrained')
    for panel, name in zip(figure.subplots(3, 4, sharex=True).flat, ANGLES, strict=True):
        for motion, colour, label in both(recorded, predicted):
            percent = np.linspace(0.0, 100.0, len(motion))
            panel.plot(percent, np.degrees(motion.coordinate(name)), color=colour, label=label)
        panel.set_title(name, fontsize=8)
    figure.axes[0].legend(fontsize=7)
    figure.supxlabel('lift [%]')
    figure.supylabel('[deg]')
    return figure


def forces(recorded: BodyMotion, predicted: BodyMotion) -> Figure:
    """Vertical ground reaction of each foot (figure 5.5) and the centres of pressure."""
    figure = Figure(figsize=(10.0, 3.2), layout='constrained')
    panels = figure.subplots(1, 3)
    for k, side in ((1, 'left'), (0, 'right')):
        panel = panels[1 - k]
        for motion, colour, label in both(recorded, predicted):
            percent = np.linspace(0.0, 100.0, len(motion))
            panel.plot(percent, motion.ground_force[:, k, 2], color=colour, label=label)
            panels[2].plot(
                -motion.centre_of_pressure[:, k, 1],
                motion.centre_of_pressure[:, k, 0],
                color=colour,
            )
        foot = [motion.point(f'{p}_{"rl"[k]}')[0] for p in ('heel', 'toe')]
        panels[2].plot([-p[1] for p in foot], [p[0] for p in foot], color=ORANGE, lw=0.6)
        panel.set_title(f'vertical force, {side} foot')
        panel.set_xlabel('lift [%]')
        panel.set_ylabel('[N]')
    panels[0].legend(fontsize=7)
    panels[2].set_title('centres of pressure, heel to toe')
    panels[2].set_xlabel('right [m]')
    panels[2].set_ylabel('forward [m]')
    panels[2].set_aspect('equal')
    return figure


def report(predicted: Prediction, comparison: LiftComparison) -> None:
    """Print what the page says of the given weight."""
    best = predicted.runs[0].solution
    print(f'{predicted.report.message}: effort {comparison.predicted_effort:.3f} s, recorded '
          f'{comparison.measured_effort:.3f} s')  # fmt: skip
    print(f'KKT: primal {best.primal:.1e}, dual {best.dual:.1e}, '
          f'complementarity {best.complementarity:.1e}')  # fmt: skip
    for name, rmse, r in zip(
        comparison.joint_names, comparison.joint_rmse, comparison.joint_pearson, strict=True
    ):
        print(f'| {name} | {rmse:.1f} | {r:.2f} |')
    for k, side in enumerate(('right', 'left')):
        print(f'| {side} foot | {comparison.foot_force_rmse[k]:.0f} N | '
              f'{comparison.foot_force_pearson[k]:.2f} |')  # fmt: skip
    assert predicted.verification is not None
    print({k: float(f'{v:.2g}') for k, v in predicted.verification.violation.items()})


def maximum(lift: Lift, z: float) -> None:
    """Print the maximum weight of the asymmetric lift for a z-score."""
    subject = replace(named_subject(SUBJECT), strength_z=z)
    solver = LiftPredictor(PredictorOptions(dimension='3d', refinements=5)).spatial
    task = solver.model.maximum_weight_task(subject, lift, Box(lift.box_mass, SIZE))
    found = maximum_weight(solver, task, solver.model.starts(task)[:1])
    print(f'z = {z:g}: {found.weight:.1f} N, effort {found.effort:.2f} s; heaviest '
          f'{found.normalisation}; {found.prediction.report.message}')  # fmt: skip
    if found.prediction.lift is not None:
        held = -found.prediction.lift.motion.hand_force[:, :, 2].mean(axis=0)
        print(f'mean vertical force of right and left hand: {held.round(1)} N')


def main() -> None:
    """Compute, draw, print."""
    mpl.rcParams.update(STYLE)
    lift = recorded_lift(LIFT)
    predictor = LiftPredictor(PredictorOptions(dimension='3d', refinements=5))
    predicted = predictor.predict(named_subject(SUBJECT), lift, Box(lift.box_mass, SIZE))
    comparison = predicted.comparison
    assert predicted.lift is not None and comparison is not None, predicted.report.message
    report(predicted, comparison)
    motions = lift.window, predicted.lift.motion
    save(snapshots(*motions), 'prediction_3d_snapshots')
    save(angles(*motions), 'prediction_3d_angles')
    save(forces(*motions), 'prediction_3d_forces')
    for z in (0.0, 1.05):
        maximum(lift, z)


if __name__ == '__main__':
    main()
