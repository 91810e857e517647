# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plates moved so that quiet standing is balanced."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.skeletons import Skeleton3D
from lifting.plate_registration import moved, offset_of, register_plates
from lifting_recordings.exceptions import ConventionError, SubjectFileError
from lifting_recordings.recording import Plate, Recording, centre_of_pressure
from lifting_recordings.subject_file import read_subject_file
from motion_tracker.core.markers.marker_model import from_anthropometry
from motion_tracker.core.markers.marker_set import load_marker_set

FRAMES, RATE, GRAVITY = 120, 100.0, 9.80665
MARKER_SET = 'plug_in_gait_58'
SUBJECT_FILE = """
subject: {pseudonym: S1, sex: female, mass: 70.0, stature: 1.70, age: 30}
task: {task_id: standing, description: standing, box_mass: 0.0, coupling: good,
  lifts_per_minute: 1.0, lifts_per_day: 10, duration_hours: 1.0}
"""


@pytest.fixture
def entry(tmp_path):
    path = tmp_path / 'subject.yaml'
    path.write_text(
        SUBJECT_FILE
        + f'recording: {{marker_set: {MARKER_SET}, plate_registration: quiet_standing}}\n'
    )
    return read_subject_file(path)


@pytest.fixture
def recording(entry):
    """Return a person who stands like a statue over its centre of mass."""
    subject = entry.subject
    skeleton = Skeleton3D.of(subject)
    q = skeleton.standing()
    model = from_anthropometry(load_marker_set(MARKER_SET), subject)
    frames = skeleton.forward(q)[[skeleton.segments.index(name) for name in model.segments]]
    markers = np.einsum('nij,nj->ni', frames[:, :3, :3], model.offsets) + frames[:, :3, 3]
    time = np.arange(FRAMES) / RATE
    place = skeleton.centre_of_mass(q)
    plates = {}
    for side, y, share in (('right', -0.1, 0.5), ('left', 0.1, 0.5)):
        force = np.tile([0.0, 0.0, share * subject.mass * GRAVITY], (FRAMES, 1))
        plates[side] = Plate(side, time, force, np.cross([place[0], y, 0.0], force))
    return Recording(
        Path('still.trc'), model.names, time, np.tile(markers, (FRAMES, 1, 1)), plates
    )


def places(recording):
    """Return the mean centres of pressure of both feet on the floor."""
    return np.array(
        [centre_of_pressure(p.force, p.moment).mean(axis=0)[:2] for p in recording.plates.values()]
    )


def shifted(recording, offset):
    """Return the recording with plates elsewhere."""
    return replace(
        recording, plates={side: moved(p, offset) for side, p in recording.plates.items()}
    )


def test_moving_a_plate_moves_its_centre_of_pressure():
    force = np.array([[0.0, 0.0, 600.0], [10.0, -5.0, 700.0]])
    place = np.array([[0.1, 0.2, 0.0], [-0.1, 0.05, 0.0]])
    plate = Plate('p', np.arange(2.0), force, np.cross(place, force))
    there = moved(plate, (0.008, -0.003))
    assert there.moment == pytest.approx(np.cross(place + [0.008, -0.003, 0.0], force))


def test_offset_is_what_is_missing_over_the_vertical_force():
    """6 N m forwards (about the axis to the left) of 600 N: the plates are 10 mm too far front."""
    found = offset_of([[0.0, 6.0, 0.0], [3.0, 6.0, 0.0]], [[0.0, 0.0, 600.0]] * 2)
    assert found.offset == pytest.approx([-0.01, 0.0025])
    assert found.spread == pytest.approx([0.0, 0.0025])


def test_plates_end_at_the_same_place_wherever_they_were(recording, entry):
    first = register_plates(recording, entry, None)
    (said,) = first.statements
    assert 's of quiet standing' in said
    # The ground was made to push under the centre of mass of the skeleton.
    assert 'skeleton alone would move them by +0 mm forward and +0 mm to the left' in said
    second = register_plates(shifted(recording, (0.012, -0.006)), entry, None)
    assert places(second) == pytest.approx(places(first), abs=1e-6)
    # Moving forth and back leaves the forces alone.
    for side, plate in second.plates.items():
        assert plate.force == pytest.approx(recording.plates[side].force)
    again = register_plates(first, entry, None)
    assert places(again) == pytest.approx(places(first), abs=1e-6)


def test_offset_that_no_plate_has_is_refused(recording, entry):
    with pytest.raises(ConventionError, match=r'quiet_standing: .* moved by \d+ mm, more than 30'):
        register_plates(shifted(recording, (-0.06, 0.0)), entry, None)


def test_what_is_needed_is_named(recording, entry):
    one = replace(recording, plates={'left': recording.plates['left']})
    with pytest.raises(ConventionError, match='no plate is under the right foot'):
        register_plates(one, entry, None)
    nameless = replace(entry, recording=replace(entry.recording, marker_set=''))
    with pytest.raises(ConventionError, match=r'recording\.marker_set is needed'):
        register_plates(recording, nameless, None)
    short = replace(recording, time=recording.time[:40], markers=recording.markers[:40])
    with pytest.raises(ConventionError, match=r'quiet standing: 0\.00 s found'):
        register_plates(short, entry, None)


def test_unknown_registration_is_refused(tmp_path):
    path = tmp_path / 'subject.yaml'
    path.write_text(SUBJECT_FILE + 'recording: {plate_registration: by_eye}\n')
    with pytest.raises(SubjectFileError, match="plate_registration: 'by_eye' is neither"):
        read_subject_file(path)
