# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The four lifting tasks, read from `tasks.yaml`, in laboratory axes.

Origin: floor, half way between the ankles; x forward, y left, z up.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml


@dataclass(frozen=True)
class Task:
    """One lift.

    Attributes
    ----------
    name, description : str
        As in the bag's task message.
    box_mass : float
        [kg].
    box_size : tuple of 3 float
        Depth, width between the hands, height [m].
    grip_height : float
        Height of the hands' grip over the box centre [m].
    floor_gap : float
        Height of the box's bottom over the floor before the lift [m].
    gap_to_plates : float
        From the front edge of the plates to the box [m].
    end : tuple of 3 float
        Box centre when it is held over the platform [m].
    end_yaw : float
        Turn of the box about the vertical at the end [rad].
    durations : dict
        Phases [s]: stand, descend, grasp, lift, lower, hold.
    seed : int
        Of sway, timing and noise.
    """

    name: str
    description: str
    box_mass: float
    box_size: tuple[float, float, float]
    grip_height: float
    floor_gap: float
    gap_to_plates: float
    end: tuple[float, float, float]
    end_yaw: float
    durations: dict[str, float]
    seed: int


@dataclass(frozen=True)
class Stage:
    """What is the same for all tasks; see `tasks.yaml` for the meaning and source of each."""

    subject: str
    marker_set: str
    stance_width: float
    toe_out: float
    toes_to_plate_edge: float
    clearance: float
    peak_deceleration: float
    settings: dict[str, Any]


def load_tasks() -> tuple[Stage, tuple[Task, ...]]:
    """Read `tasks.yaml`."""
    data = yaml.safe_load((Path(__file__).parent / 'tasks.yaml').read_text(encoding='utf-8'))
    stage = dict(data['stage'])
    toe_out = np.radians(stage.pop('toe_out_degrees'))
    settings = data['settings']
    tasks = []
    for entry in data['tasks']:
        task = {key: value for key, value in entry.items() if key != 'source'}
        task['box_size'] = tuple(task['box_size'])
        task['end'] = tuple(task['end'])
        task['end_yaw'] = float(np.radians(task.pop('end_yaw_degrees')))
        tasks.append(Task(**task))
    return Stage(toe_out=float(toe_out), settings=settings, **stage), tuple(tasks)
