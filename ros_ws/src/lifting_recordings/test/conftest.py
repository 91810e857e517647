# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A swaying stick figure on two plates, for the import tests: graph axes, exact values."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lifting_recordings.recording import Plate, RawRecording

STATURE, MASS, G = 1.70, 70.0, 9.80665
PLACES = {
    'C7': (-0.06, 0.0, 1.45),
    'CLAV': (0.08, 0.0, 1.38),
    'RSHO': (0.0, -0.19, 1.42),
    'LSHO': (0.0, 0.19, 1.42),
    'RASI': (0.10, -0.12, 0.98),
    'LASI': (0.10, 0.12, 0.98),
    'RPSI': (-0.09, -0.05, 1.00),
    'LPSI': (-0.09, 0.05, 1.00),
    'RHEE': (-0.06, -0.12, 0.05),
    'LHEE': (-0.06, 0.12, 0.05),
    'RTOE': (0.14, -0.13, 0.05),
    'LTOE': (0.14, 0.13, 0.05),
}
SUBJECT = """
subject: {pseudonym: S1, sex: female, mass: 70.0, stature: 1.70, age: 30}
task:
  task_id: standing
  description: standing
  box_mass: 0.0
  coupling: good
  lifts_per_minute: 1.0
  lifts_per_day: 10
  duration_hours: 1.0
"""


def person(n: int = 200, rate: float = 100.0) -> RawRecording:
    """Return the figure in metres, x forward, y left, z up; right plate 60 % of the weight."""
    time = np.arange(n) / rate
    sway = 0.01 * np.sin(2.0 * np.pi * 0.5 * time)
    places = np.array(list(PLACES.values()))
    positions = np.tile(places, (n, 1, 1))
    positions[:, :8, 0] += sway[:, None]
    plates = []
    for name, side, share in (('fp1', -0.125, 0.6), ('fp2', 0.125, 0.4)):
        force = np.stack(
            (2.0 * np.cos(time), np.full(n, -np.sign(side) * 5.0), np.full(n, share * MASS * G)),
            axis=1,
        )
        cop = np.stack((0.04 + sway, np.full(n, side), np.zeros(n)), axis=1)
        free = np.stack((np.zeros(n), np.zeros(n), 0.3 * np.sin(time)), axis=1)
        plates.append(Plate(name, time, force, np.cross(cop, force) + free))
    return RawRecording(Path('person.trc'), tuple(PLACES), time, positions, 'm', tuple(plates))


def turned(raw: RawRecording, matrix: np.ndarray, scale: float = 1.0) -> RawRecording:
    """Return the recording in other axes (rows of `matrix`: new axes in graph axes) and units."""
    plates = tuple(
        Plate(p.name, p.time, p.force @ matrix.T, p.moment @ matrix.T) for p in raw.plates
    )
    return RawRecording(
        raw.path, raw.names, raw.time, raw.positions @ matrix.T * scale, raw.units, plates
    )


@pytest.fixture(scope='session')
def standing() -> SimpleNamespace:
    """Return the figure, its stature [m] and mass [kg], a turner and its subject file's text."""
    return SimpleNamespace(
        raw=person(), stature=STATURE, mass=MASS, turned=turned, subject_file=SUBJECT
    )
