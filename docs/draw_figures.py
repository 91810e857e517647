# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the figures of the documents from the project's own code and recordings.

The recordings in bags/ are run offline into out/figures. With `--squats` and the folder of the
public squats and their OpenSim reference, these are imported, run and compared too.
"""

from __future__ import annotations

import argparse
import math
import shutil
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from lifting.importing import import_recording
from lifting_cli.offline import run_offline
from lifting_recordings.importer import ImportOptions
from lifting_recordings.reader import BagReader
from muscle_analyzer.core.loads.disc_frame import (
    DiscOption,
    disc_load,
    disc_parameters,
    disc_rotation,
)

ROOT = Path(__file__).resolve().parents[1]
FIGURES = Path(__file__).parent / 'figures'
RESULTS = ROOT / 'out' / 'figures'
LIFTS = ('symmetric_7kg', 'symmetric_12kg', 'symmetric_max', 'asymmetric_7kg')
ANGLE_LIMIT = 2.0
"""Agreed error of a joint angle in the sagittal plane [deg]."""
JOINTS = {
    'pelvis_tilt': 'pelvis tilt', 'lumbar_extension': 'lower spine',
    'thorax_extension': 'upper spine', 'arm_flex': 'shoulder', 'elbow_flex': 'elbow',
    'hip_flexion': 'hip', 'knee_angle': 'knee', 'ankle_angle': 'ankle',
}  # fmt: skip
LIVE = 1
RESULTANT = 2500.0
"""Force whose components are shown [N]."""

# Drawn on their own white card, so that they can be read on a light and on a dark page; the
# same input gives the same file.
STYLE: dict[Any, Any] = {
    'svg.hashsalt': 'lift monitor', 'svg.fonttype': 'path', 'font.size': 10,
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.grid': True,
    'grid.alpha': 0.35, 'figure.facecolor': 'white', 'savefig.facecolor': 'white',
}  # fmt: skip
BLUE, ORANGE, GREY = '#1f5fa8', '#b7541b', '#52606d'


def save(figure: Figure, name: str) -> None:
    """Write a figure as SVG without the date."""
    FIGURES.mkdir(exist_ok=True)
    figure.savefig(FIGURES / f'{name}.svg', metadata={'Date': None}, bbox_inches='tight')
    print(FIGURES / f'{name}.svg')


def leant(degrees: float) -> np.ndarray:
    """Return OpenSim body axes (forward, up, right) leant forward."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def disc_frame() -> Figure:
    """Compression and shear of one reaction in frames that lean more or less."""
    default = disc_parameters(DiscOption.BRUNO2015)['forward_tilt']
    normal = leant(default)[:, 1]
    reaction = np.concatenate([np.zeros(3), RESULTANT * normal])
    lean = np.arange(default - 30.0, default + 30.5, 0.5)
    loads = [
        disc_load(reaction, disc_rotation(DiscOption.VERTEBRAL, leant(angle), np.eye(3), 0.0))
        for angle in lean
    ]
    figure = Figure(figsize=(7.2, 3.4))
    axes = figure.subplots()
    for name, colour in (('compression', BLUE), ('anterior_shear', ORANGE)):
        values = [getattr(load, name) for load in loads]
        axes.plot(lean, values, color=colour)
        axes.text(lean[-1] + 0.8, values[-1], name.replace('_', ' '), color=colour, va='center')
    for limit, words in (
        (1000.0, 'shear limit, up to 100 loads a day'),
        (700.0, 'shear limit, above 100 loads a day'),
    ):
        axes.axhline(limit, color=ORANGE, linestyle='--', linewidth=0.9)
        axes.text(lean[0], limit + 30.0, words, color=ORANGE, fontsize=8)
    options = {
        default: 'bruno2015',
        disc_parameters(DiscOption.VERTEBRAL)['forward_tilt']: 'vertebral',
    }
    for angle, name in options.items():
        axes.axvline(angle, color=GREY, linestyle=':', linewidth=1.0)
        axes.text(angle + 0.5, -1250.0, name, color=GREY, fontsize=8)
    axes.set_xlabel('lean of the disc normal forward of the long axis of L5 [deg]')
    axes.set_ylabel(f'part of {RESULTANT:.0f} N [N]')
    return figure


def results_of(bag: Path) -> Path:
    """Run a recording offline and return its results file."""
    return run_offline(bag, RESULTS / bag.name)


def messages(results: Path, topic: str) -> list[Any]:
    """Return all messages of a topic."""
    with BagReader(results) as bag:
        names = [name for name in bag.topics if name.endswith(f'/{topic}')]
        return [message for _, _, message in bag.messages(names)]


def stamp(message: Any) -> float:
    """Return the stamp of a message [s]."""
    return float(message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec)


def angle_errors(name: str) -> dict[str, float]:
    """Return the rms error of each joint of a measured lift [deg], the worse side."""
    (lift,) = messages(results_of(ROOT / 'bags' / name), 'measured_lift')
    with np.load(ROOT / 'bags' / name / 'truth.npz') as truth:
        with BagReader(ROOT / 'bags' / name) as bag:
            start = bag.start_ns * 1e-9
        motion = lift.motion
        time = stamp(motion) - start + motion.time_from_start
        found = motion.position.reshape(len(time), -1)
        error = {
            str(coordinate): np.degrees(
                np.sqrt(
                    np.mean(
                        np.square(
                            found[:, motion.coordinate_names.index(coordinate)]
                            - np.interp(time, truth['time'], truth['position'][:, i])
                        )
                    )
                )
            )
            for i, coordinate in enumerate(truth['coordinates'])
        }
    return {
        joint: max(value for key, value in error.items() if key.startswith(joint))
        for joint in JOINTS
    }


def tracker_error() -> Figure:
    """Angle errors of the tracker against the stored truth."""
    figure = Figure(figsize=(7.2, 2.9))
    axes = figure.subplots()
    for k, name in enumerate(LIFTS):
        errors = angle_errors(name)
        print(name, {joint: round(float(value), 2) for joint, value in errors.items()})
        axes.bar(
            np.arange(len(JOINTS)) + 0.2 * (k - 1.5),
            list(errors.values()),
            0.18,
            label=name.replace('_', ' '),
            color=(BLUE, '#5b93d1', '#9dbfe4', ORANGE)[k],
        )
    axes.axhline(ANGLE_LIMIT, color=GREY, linestyle='--', linewidth=0.9)
    axes.text(
        len(JOINTS) - 0.5, ANGLE_LIMIT + 0.03, 'agreed limit', color=GREY, ha='right', fontsize=8
    )
    axes.set_xticks(np.arange(len(JOINTS)), list(JOINTS.values()), fontsize=8)
    axes.set_ylabel('rms error [deg]')
    axes.set_ylim(0.0, 1.25 * ANGLE_LIMIT)
    axes.grid(axis='x', visible=False)
    axes.legend(frameon=False, ncols=4, fontsize=8, loc='upper left')
    return figure


def reference_loads(folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time [s], compression and shear [N] of OpenSim in the default disc frame."""
    lines = (folder / 'joint_reaction_loads.sto').read_text(encoding='utf-8').splitlines()
    first = lines.index('endheader') + 1
    names = lines[first].split('\t')
    rows = np.array([[float(word) for word in line.split()] for line in lines[first + 1 :]])
    columns = [names.index(f'L5_S1_IVDjnt_on_lumbar5_in_lumbar5_f{axis}') for axis in 'xyz']
    frame = disc_rotation(DiscOption.BRUNO2015, np.eye(3), np.eye(3), 0.0)
    loads = [disc_load(np.concatenate([np.zeros(3), force]), frame) for force in rows[:, columns]]
    return (
        rows[:, 0],
        np.array([load.compression for load in loads]),
        np.array([load.anterior_shear for load in loads]),
    )


def squats(folder: Path) -> Figure:
    """Live L5-S1 load of the real squats from markers, against OpenSim's."""
    bag = RESULTS / 'squats_bag'
    shutil.rmtree(bag, ignore_errors=True)
    import_recording(
        ImportOptions(
            markers=folder / 'squats1.trc',
            forces=folder / 'squats1_grf.mot',
            static=folder / 'static1.trc',
            output=bag,
            subject=ROOT / 'bags' / 'subjects' / 'squats_bodyweight.yaml',
        )
    )
    results = results_of(bag)
    start = stamp(messages(results, 'subject')[0])
    live = [load for load in messages(results, 'spine_load') if load.source == LIVE]
    time = np.array([stamp(load) - start for load in live])
    figure = Figure(figsize=(7.2, 4.2))
    rows = figure.subplots(2, 1, sharex=True)
    reference = reference_loads(folder / 'opensim46_reference')
    for axes, name, known in zip(
        rows, ('compression', 'anterior_shear'), reference[1:], strict=True
    ):
        values = np.array([getattr(load, name)[0] for load in live])
        axes.plot(time, values, color=BLUE, linewidth=1.2, label='from the markers, live')
        axes.plot(
            reference[0],
            known,
            'o',
            color=ORANGE,
            markersize=4,
            label='OpenSim 4.6, its own inverse kinematics',
        )
        axes.set_ylabel(f'{name.replace("_", " ")} [N]')
        at = np.interp(reference[0], time, values)
        print(f'{name}: peak {at.max():.0f} N against {known.max():.0f} N at its instants')
    figure.legend(
        *rows[0].get_legend_handles_labels(),
        frameon=False,
        fontsize=8,
        ncols=2,
        loc='upper center',
    )
    rows[1].set_xlabel('time [s]')
    rows[0].set_xlim(0.0, 6.0)
    return figure


def main() -> None:
    """Draw all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--squats', type=Path, help='folder of the public squats')
    options = parser.parse_args()
    mpl.use('Agg')
    with mpl.rc_context(STYLE):
        save(disc_frame(), 'disc_frame')
        save(tracker_error(), 'tracker_error')
        if options.squats:
            save(squats(options.squats), 'squats')


if __name__ == '__main__':
    main()
