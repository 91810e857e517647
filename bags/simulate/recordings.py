# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write a simulated lift as a bag, with the truth beside it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from bags.simulate.balance import balanced_motion
from bags.simulate.body import Body
from bags.simulate.forces import SimulatedForces, simulate_forces
from bags.simulate.motion import MotionBuilder, Phases
from bags.simulate.profiles import slow_wander
from bags.simulate.sensors import (
    PlacedMarkers,
    box_readings,
    marker_places,
    place_markers,
    plate_readings,
)
from bags.simulate.tasks import Stage, Task

from human_model.subject import Calibration, Subject
from human_model.task import Box, Coupling, Work
from human_model.task import Task as RecordedTask
from human_model.typing import Array
from lifting_recordings.bag_writer import START_TIME_NS, BagWriter, in_order
from lifting_recordings.importer import marker_stream, plate_stream, pose_stream
from lifting_recordings.messages import MarkerCalibration, subject_message, task_message
from lifting_recordings.recording import Recording
from motion_tracker.core.calibration import calibrate
from motion_tracker.core.markers.marker_set import load_marker_set

_SOURCE = (
    'SIMULATED, not measured: bags/simulate. Person, task and box after Zaman 2022; motion by '
    'key postures and inverse kinematics, forces by inverse dynamics, with simulated noise, '
    'marker placement and soft-tissue movement (bags/README.md). Units m and N; x forward, '
    'y left, z up; right plate under the right foot.'
)
_STATIC_SECONDS = 2.0
_STATIC_SEED = 1000
_ALL = 'static_trial'


class Session:
    """One person, one set of markers, all recordings.

    Parameters
    ----------
    stage : Stage
        Subject, room and settings.
    """

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.body = Body(stage)
        self.builder = MotionBuilder(stage, self.body)
        self.markers: PlacedMarkers = place_markers(stage, self.body)
        self.rest = self.body.project(self.body.skeleton.standing(), None)
        static, self.static_time, self.static_q = self._static_trial()
        self.static = static
        self.calibrated = calibrate(
            load_marker_set(stage.marker_set), self.markers.names, static, self.body.subject
        )

    def _static_trial(self) -> tuple[Array, Array, Array]:
        """Return markers, time and postures of quiet upright standing with flat feet."""
        rng = np.random.default_rng(_STATIC_SEED)
        rate = float(self.stage.settings['marker_rate'])
        time = np.arange(round(_STATIC_SECONDS * rate) + 1) / rate
        sway = np.stack(
            [slow_wander(time, rng, np.radians(0.1)) for _ in self.body.skeleton.coordinates],
            axis=1,
        )
        sway[:, :3] = 0.0
        q = np.array([self.body.project(self.rest + row, None) for row in sway])
        seen = marker_places(self.stage, self.body, self.markers, q, self.rest, _STATIC_SEED)
        return seen, time, q

    def subject(self) -> Subject:
        """Return the person without the measured lengths, which the calibration has."""
        subject: Subject = self.body.subject
        return replace(subject, lengths={}, calibration=None)

    def calibration(self) -> MarkerCalibration:
        """Return the calibration of the static trial."""
        found: Calibration = self.calibrated.calibration
        return MarkerCalibration(
            marker_set=self.stage.marker_set,
            marker_names=found.marker_names,
            segments=found.segments,
            offsets=found.local_offsets,
            rms=found.residual_rms,
            segment_lengths=found.lengths,
        )

    def write_static(self, folder: Path) -> None:
        """Write the static trial as a bag without plates and box."""
        task = RecordedTask(
            _ALL, Box(0.0), Work(0.0, 0.0, 0.0, Coupling.GOOD),
            'quiet standing for the marker calibration', simulated=True,
        )  # fmt: skip
        recording = Recording(folder, self.markers.names, self.static_time, self.static, plates={})
        with BagWriter(folder / _ALL) as writer:
            streams = [
                self._latched(writer, task, None),
                marker_stream(writer, START_TIME_NS, recording),
            ]
            _write(writer, streams)
        q = self.static_q
        zero = np.zeros_like(q)
        motion = self.body.skeleton.body_motion(self.static_time, q, zero, zero)
        _save_truth(folder / _ALL, self._with_lengths(motion.to_dict()), self.markers)

    def write_lift(self, folder: Path, task: Task) -> None:
        """Simulate one task and write its bag and truth."""
        settings = self.stage.settings
        motion = balanced_motion(self.builder, task)
        frames = _stamps(motion.phases, settings['marker_rate'])
        samples = _stamps(motion.phases, settings['plate_rate'])
        truth = simulate_forces(self.stage, self.body, motion, frames)
        plates = plate_readings(
            self.stage, simulate_forces(self.stage, self.body, motion, samples), task.seed + 1
        )
        seen = marker_places(
            self.stage, self.body, self.markers, truth.position, self.rest, task.seed + 2
        )
        position, quaternion = box_readings(self.stage, truth.box, task.seed + 3)
        recording = Recording(folder, self.markers.names, frames, seen, plates)
        with BagWriter(folder / task.name) as writer:
            streams = [
                self._latched(writer, _recorded_task(task, truth.box[0, :3]), self.calibration()),
                marker_stream(writer, START_TIME_NS, recording),
                pose_stream(writer, START_TIME_NS, frames, position, quaternion),
                *(plate_stream(writer, START_TIME_NS, side, plates[side]) for side in plates),
            ]
            _write(writer, streams)
        block = self.body.skeleton.body_motion(
            frames, truth.position, truth.velocity, truth.acceleration,
            ground_force=truth.ground_force, centre_of_pressure=truth.centre_of_pressure,
            free_moment=truth.free_moment, hand_force=truth.hand_force,
            box_position=truth.box[:, :3],
        )  # fmt: skip
        _save_truth(
            folder / task.name,
            self._with_lengths({**block.to_dict(), **_extras(task, motion.phases, truth)}),
            self.markers,
        )

    def _with_lengths(self, fields: dict[str, Any]) -> dict[str, Any]:
        lengths = self.body.lengths
        return {
            **fields,
            'length_names': np.array(list(lengths)),
            'lengths': np.array(list(lengths.values())),
        }

    def _latched(
        self, writer: BagWriter, task: RecordedTask, calibration: MarkerCalibration | None
    ) -> Iterator[tuple[int, str, Any]]:
        writer.topic('subject', 'lifting_interfaces/msg/Subject', transient_local=True)
        writer.topic('task', 'lifting_interfaces/msg/Task', transient_local=True)
        subject = subject_message(
            writer, START_TIME_NS, self.subject(), _SOURCE, self.stage.marker_set, calibration
        )
        return iter(
            (
                (START_TIME_NS, 'subject', subject),
                (START_TIME_NS, 'task', task_message(writer, START_TIME_NS, task, _SOURCE)),
            )
        )


def _stamps(when: Phases, rate: float) -> Array:
    return np.asarray(np.arange(round(when.end * rate) + 1) / rate)


def _recorded_task(task: Task, start: Array) -> RecordedTask:
    # Cut-outs in the box are optimal handles; the big box is held from below (NIOSH 94-110).
    coupling = Coupling.GOOD if task.grip_height == 0.0 else Coupling.POOR
    place = (float(start[0]), float(start[1]), float(start[2]))
    return RecordedTask(
        task.name,
        Box(task.box_mass, task.box_size, place, task.end),
        Work(lifts_per_day=100.0, lifts_per_minute=0.2, duration_hours=1.0, coupling=coupling),
        f'{task.description} (simulated)',
        simulated=True,
    )


def _write(writer: BagWriter, streams: list[Iterator[tuple[int, str, Any]]]) -> None:
    for stamp, topic, message in in_order(*streams):
        writer.write(topic, stamp, message)


def _extras(task: Task, when: Phases, truth: SimulatedForces) -> dict[str, Any]:
    return {
        'torque': truth.torque,
        'hand_moment': truth.hand_moment,
        'box_yaw': truth.box[:, 3],
        'lift_start': np.array(when.lift_off),
        'lift_end': np.array(when.peak),
        'grasp': np.array(when.grasp),
        'box_mass': np.array(task.box_mass),
    }


def _save_truth(bag: Path, fields: dict[str, Any], markers: PlacedMarkers) -> None:
    """Write truth.npz; single precision for the big arrays, enough for 1e-6 m and rad."""
    small = {
        name: value.astype(np.float32) if value.dtype == np.float64 and value.ndim > 1 else value
        for name, value in fields.items()
    }
    np.savez_compressed(
        bag / 'truth.npz',
        **small,
        start_time_ns=np.array(START_TIME_NS),
        marker_names=np.array(markers.names),
        marker_segments=np.array(markers.segments),
        marker_local=markers.local,
    )
