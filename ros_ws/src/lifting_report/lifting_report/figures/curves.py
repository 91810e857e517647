# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Figures over the course of a lift: joint angles, ground reaction, torques, torque index."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from human_model.strength import LARGE
from human_model.typing import Array
from injury_monitor.core.torque_index import torque_index
from lifting_report.figures.style import (
    COLOURS,
    DASHES,
    LABELS,
    LIMIT,
    SERIES,
    SOFT,
    figure_legend,
    figure_style,
    new_figure,
    percent_axis,
    to_svg,
)
from lifting_report.report_data import JOINTS, GroundForces, JointAngles, Pair, Torques

_ANGLE_TITLES = {
    'spine': 'Spine (flexion +)',
    'shoulder': 'Shoulder (forward +)',
    'elbow': 'Elbow (flexion +)',
    'hip': 'Hip (flexion +)',
    'knee': 'Knee (flexion +)',
    'ankle': 'Ankle (dorsiflexion +)',
}
_TORQUE_TITLES = {
    'lumbar_extension': 'Spine (extension +)',
    'arm_flex': 'Shoulder (forward +)',
    'elbow_flex': 'Elbow (flexion +)',
    'hip_flexion': 'Hip (flexion +)',
    'knee_angle': 'Knee (flexion +)',
    'ankle_angle': 'Ankle (dorsiflexion +)',
    'mtp_angle': 'Toes (dorsiflexion +)',
}
_COLUMNS = 3


def percent(time: Array) -> Array:
    """Return time as the course of the lift [%]."""
    span = float(time[-1] - time[0])
    return np.zeros_like(time) if span == 0.0 else 100.0 * (time - time[0]) / span


def joint_angles(pair: Pair[JointAngles], name: str) -> str:
    """Draw the six joint angles, recorded against optimal (figures 4.10, 4.11 of the thesis)."""
    with figure_style():
        figure, panels = new_figure(4.7, 2, _COLUMNS)
        for k, joint in enumerate(JOINTS):
            axes = panels[k]
            axes.set_title(_ANGLE_TITLES[joint])
            for source, angles in pair.present().items():
                x = percent(angles.time)
                sides = np.degrees(np.stack([angles.right[:, k], angles.left[:, k]]))
                if not np.allclose(sides[0], sides[1], equal_nan=True):
                    axes.fill_between(
                        x,
                        sides.min(axis=0),
                        sides.max(axis=0),
                        alpha=0.18,
                        color=COLOURS[source],
                        linewidth=0.0,
                    )
                axes.plot(
                    x,
                    sides.mean(axis=0),
                    color=COLOURS[source],
                    ls=DASHES[source],
                    label=LABELS[source],
                )
            percent_axis(axes, k >= _COLUMNS)
            if k % _COLUMNS == 0:
                axes.set_ylabel('angle [deg]')
        figure_legend(figure, panels[0])
        return to_svg(figure, name, 'Joint angles of the recorded and of the optimal lift')


def ground_forces(pair: Pair[GroundForces], name: str, body_weight: float) -> str:
    """Draw vertical and forward ground reaction; the feet one by one where they were recorded.

    Parameters
    ----------
    pair : Pair of GroundForces
    name : str
    body_weight : float
        [N], drawn for scale.
    """
    with figure_style():
        figure, (vertical, forward) = new_figure(3.1, 1, 2)
        vertical.set_title('Vertical, on the person')
        forward.set_title('Forward, on the person')
        for source, ground in pair.present().items():
            x = percent(ground.time)
            for axes, axis in ((vertical, 2), (forward, 0)):
                axes.plot(
                    x,
                    ground.force[:, :, axis].sum(axis=1),
                    color=COLOURS[source],
                    ls=DASHES[source],
                    label=f'{LABELS[source]}, both feet',
                )
            if source == 'measured':
                for side, style in ((0, '-.'), (1, ':')):
                    vertical.plot(
                        x,
                        ground.force[:, side, 2],
                        color=COLOURS[source],
                        ls=style,
                        lw=1.1,
                        label=f'recorded, {("right", "left")[side]} foot',
                    )
        vertical.axhline(body_weight, color=SOFT, lw=1.0, ls=(0, (1, 2)), label='body weight')
        vertical.set_ylim(bottom=min(0.0, vertical.get_ylim()[0]))
        for axes in (vertical, forward):
            percent_axis(axes)
        vertical.set_ylabel('force [N]')
        figure_legend(figure, vertical)
        return to_svg(figure, name, 'Ground reaction of the recorded and of the optimal lift')


def joint_torques(pair: Pair[Torques], name: str) -> str:
    """Draw joint torques with their dynamic limits (figure 4.13 of the thesis)."""
    joints = _joints(pair)
    lines = -(-len(joints) // _COLUMNS)
    with figure_style():
        figure, panels = new_figure(0.7 + 2.0 * lines, lines, _COLUMNS)
        for k, joint in enumerate(joints):
            axes = panels[k]
            axes.set_title(_title(joint))
            for source, torques in pair.present().items():
                if joint not in torques.joints:
                    continue
                column = torques.joints.index(joint)
                x = percent(torques.time)
                for bound, label in (
                    (_known(torques.lower), '_'),
                    (_known(torques.upper), f'{LABELS[source]}, dynamic strength limit'),
                ):
                    axes.plot(
                        x,
                        bound[:, column],
                        color=COLOURS[source],
                        lw=1.0,
                        alpha=0.75,
                        ls=(0, (1, 1.5)),
                        label=label,
                    )
                axes.plot(
                    x,
                    torques.torque[:, column],
                    color=COLOURS[source],
                    ls=DASHES[source],
                    label=f'{LABELS[source]}, torque',
                )
            axes.axhline(0.0, color=SOFT, lw=0.8)
            percent_axis(axes, k >= len(joints) - _COLUMNS)
            if k % _COLUMNS == 0:
                axes.set_ylabel('torque [N m]')
        for axes in panels[len(joints) :]:
            axes.set_visible(False)
        figure_legend(figure, panels[0])
        return to_svg(figure, name, 'Joint torques with dynamic strength limits')


def torque_indices(pair: Pair[Torques], name: str) -> str:
    """Draw the torque index of every joint over the lift (figure 4.18 of the thesis)."""
    present = pair.present()
    with figure_style():
        figure, panels = new_figure(3.1, 1, len(present), share_y=True)
        for axes, (source, torques) in zip(panels, present.items(), strict=True):
            index = _index(torques)
            axes.set_title(f'{LABELS[source].capitalize()} lift')
            _index_lines(axes, torques, index)
            axes.axhline(1.0, color=LIMIT, ls=(0, (6, 3)), lw=1.3)
            axes.text(
                99.0,
                1.0,
                'whole dynamic strength (index 1)',
                ha='right',
                va='bottom',
                color=LIMIT,
                fontsize=8,
            )
            percent_axis(axes)
            axes.set_ylim(0.0, max(1.15, axes.get_ylim()[1]))
        panels[0].set_ylabel('torque index [1]')
        figure_legend(figure, panels[0], columns=8)
        return to_svg(figure, name, 'Joint torque index over the lift')


def _index_lines(axes: Axes, torques: Torques, index: Array) -> None:
    """Draw one line a joint, told apart by colour and by dashes."""
    x = percent(torques.time)
    dashes: tuple[str | tuple[int, tuple[int, ...]], ...] = ('-', (0, (5, 2)), '-.', (0, (1, 1)))
    for k, joint in enumerate(torques.joints):
        if np.any(np.isfinite(index[:, k])):
            axes.plot(
                x,
                index[:, k],
                color=SERIES[k % len(SERIES)],
                ls=dashes[k % len(dashes)],
                lw=1.6,
                label=_title(joint).split(' (')[0],
            )


def _title(joint: str) -> str:
    return _TORQUE_TITLES.get(joint, joint.replace('_', ' ').capitalize())


def _known(bound: Array) -> Array:
    """Return a strength limit with NaN where no strength is published for the joint."""
    return np.where(np.abs(bound) < LARGE, bound, np.nan)


def _index(torques: Torques) -> Array:
    """Return the torque index; NaN without published strength or where a fit changes its sign."""
    lower, upper = _known(torques.lower), _known(torques.upper)
    index = torque_index(
        torques.torque, np.where(lower > 0.0, np.nan, lower), np.where(upper < 0.0, np.nan, upper)
    )
    return np.where(np.isfinite(index), index, np.nan)


def _joints(pair: Pair[Torques]) -> list[str]:
    return list(
        dict.fromkeys(joint for torques in pair.present().values() for joint in torques.joints)
    )
