# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The real recording: five squats without load, from the files to the load on L5-S1.

Compared with OpenSim 4.6 is the resultant force on L5-S1: it does not depend on the choice of
the disc's orientation, in which this project and the reference (the L5 body's own axes) differ.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from human_model.frames import matrix_from_quaternion
from human_model.skeletons import Skeleton3D
from lifting.importing import import_recording
from lifting_recordings.importer import ImportOptions
from motion_tracker.core.filters import derivatives, zero_phase
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

#: Agreed limits.
MARKER_LIMIT = 15e-3
MOMENT_LIMIT = 15.0
DISTANCE_LIMIT = 5e-3
ANGLE_LIMIT = np.radians(1.0)
PEAK_LIMIT = 0.10
#: What the plates carry [kg]; the reference was computed with it, and the subject file has it.
PLATE_MASS = 60.1


def storage(path):
    """Return the columns of an OpenSim storage file by name."""
    lines = path.read_text(encoding='utf-8').splitlines()
    end = lines.index('endheader')
    rows = [[float(x) for x in line.split()] for line in lines[end + 2 :] if line.strip()]
    return dict(zip(lines[end + 1].split(), np.array(rows).T, strict=True))


def recording(found):
    """Return the whole recording as one zero-phase filtered block; forces from the live ones."""
    rate = 100.0
    q = zero_phase(np.array([f.solution.q for f in found.frames]), rate, 6.0)
    qd, qdd = derivatives(q, rate)
    time = np.array([f.motion.time[0] + f.filter_delay for f in found.frames])
    live = np.array([f.motion.time[0] for f in found.frames])
    forces = {}
    for name in ('ground_force', 'centre_of_pressure', 'free_moment'):
        rows = found.live(name)
        columns = rows.reshape(len(rows), -1).T
        known = np.isfinite(columns[0])
        at = [np.interp(time, live[known], column[known]) for column in columns]
        forces[name] = np.stack(at, axis=1).reshape(rows.shape)
    return Skeleton3D.of(found.calibrated).body_motion(time, q, qd, qdd, **forces)


@pytest.fixture(scope='module')
def squats(squats_files, bags, tracked, tmp_path_factory):
    """Import, track, and analyse each squat and the whole recording."""
    folder = tmp_path_factory.mktemp('squats')
    import_recording(
        ImportOptions(
            markers=squats_files / 'squats1.trc',
            forces=squats_files / 'squats1_grf.mot',
            static=squats_files / 'static1.trc',
            subject=bags / 'subjects' / 'squats_bodyweight.yaml',
            output=folder / 'squats',
        )
    )
    found = tracked(folder / 'squats')
    analyzer = MuscleAnalyzer(found.calibrated)
    analyses = [
        analyzer.analyze(lift.lift.motion, lift.lift.lift_id, 'measured', lift.status)
        for lift in found.lifts
    ]
    motion = recording(found)
    whole = analyzer.analyze(motion, '', 'measured')
    live = [analyzer.analyze(frame.motion) for frame in found.frames]
    return SimpleNamespace(
        found=found, analyses=analyses, motion=motion, whole=whole, live=live, files=squats_files
    )


def test_mass_is_that_of_the_plates_as_in_the_reference(squats):
    assert squats.found.calibrated.mass == pytest.approx(PLATE_MASS, abs=0.05)


def test_five_squats_are_found_from_the_hands(squats):
    kinds = [event.event.phase.name for event in squats.found.events]
    assert kinds == ['START', 'END'] * 5
    assert {event.detected_from for event in squats.found.events} == {'hands'}
    assert len(squats.found.lifts) == 5
    for lift in squats.found.lifts:
        assert not lift.status.any()


def test_markers_fit(squats):
    rms = np.array([frame.solution.rms for frame in squats.found.frames])
    assert np.isfinite(rms).all()
    assert np.sqrt(np.mean(rms**2)) <= MARKER_LIMIT


def test_hands_feet_and_trunk_after_the_transfer(squats):
    """In the squats, in the whole recording and in every live frame, the first ones included."""
    assert len(squats.live) == len(squats.found.frames)
    for analysis in (*squats.analyses, squats.whole, *squats.live):
        assert analysis.hand_distance.max() <= DISTANCE_LIMIT
        assert analysis.foot_distance.max() <= DISTANCE_LIMIT
        for angle in (analysis.trunk_angle, analysis.hand_angle, analysis.foot_angle):
            assert angle.max() <= ANGLE_LIMIT


def test_net_l5_s1_moment_from_above_against_below(squats):
    """Over the whole recording, five squats and the standing between them."""
    difference = squats.whole.net_moment_top_down - squats.whole.net_moment_bottom_up
    assert np.sqrt(np.mean(np.sum(difference**2, axis=1))) <= MOMENT_LIMIT


def test_net_l5_s1_moment_while_rising(squats):
    """The same limit in each of the five rises alone, without the standing between them.

    The plates' place was taken from standing (`plate_registration` of the subject file), so the
    rises, from the deepest posture on, are a test of it.
    """
    for analysis in squats.analyses:
        difference = analysis.net_moment_top_down - analysis.net_moment_bottom_up
        assert np.sqrt(np.mean(np.sum(difference**2, axis=1))) <= MOMENT_LIMIT


def test_what_was_missing_belongs_to_the_plates_not_to_the_trunk(squats):
    """It stays what it is in standing where the trunk leans by 45 degrees and more.

    Some 21 mm were missing in standing. Had they been those of the trunk's centre of mass, they
    would turn with the trunk, and 21 (1 - cos 50) = 8 mm and what is missing now would be left.
    """
    motion, whole = squats.motion, squats.whole
    upwards = matrix_from_quaternion(motion.frame('thorax'))[:, 2, 2]
    difference = whole.net_moment_top_down - whole.net_moment_bottom_up
    missing = -difference[:, 1] / motion.ground_force[:, :, 2].sum(axis=1)
    leaning = upwards <= np.cos(np.radians(45.0))
    assert leaning.sum() > 100
    assert abs(missing[leaning].mean()) < 6e-3


def test_peak_force_on_l5_s1_against_opensim(squats):
    """At the reference's instants, 1.15 to 3.55 s, all of the first squat and half the second."""
    loads = storage(squats.files / 'opensim46_reference' / 'joint_reaction_loads.sto')
    theirs = np.linalg.norm(
        [loads[f'L5_S1_IVDjnt_on_lumbar5_in_lumbar5_f{axis}'] for axis in 'xyz'], axis=0
    )
    analysis = squats.whole
    good = np.array([report.status == 0 for report in analysis.spine_reports])
    force = np.linalg.norm(analysis.l5_s1_force, axis=1)
    ours = np.interp(loads['time'], analysis.time[good] - squats.found.start, force[good])
    assert ours.max() == pytest.approx(theirs.max(), rel=PEAK_LIMIT)
