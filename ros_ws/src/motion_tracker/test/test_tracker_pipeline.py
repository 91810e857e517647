# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The whole tracker on a made-up lift: order of arrival, bad input, live against lift."""

import numpy as np
import pytest
import yaml

from human_model.report import SolveStatus
from motion_tracker.core.configuration import settings_from, tracker_from
from motion_tracker.core.exceptions import MotionTrackerError, TrackerError
from motion_tracker.core.lifts.lift_events import LiftPhase
from motion_tracker.core.markers.marker_set import DATA
from motion_tracker.core.tracked import (
    FROM_BOX,
    FROM_HANDS,
    DetectedEvent,
    MeasuredLift,
    Notice,
    TrackedFrame,
    TrackerSettings,
)
from motion_tracker.core.tracker import MotionTracker

# Of the lift in conftest.
START = 1.7e9
MASS, SIZE = 10.0, (0.3, 0.3, 0.2)
GRAVITY = 9.80665


def default_parameters():
    """Return the parameters of the node with their default values."""
    table = yaml.safe_load((DATA / 'parameters.yaml').read_text(encoding='utf-8'))
    return {name: row['default'] for name, row in table.items()}


def feed_one(tracker, message, names):
    if message[0] == 'markers':
        return tracker.push_markers(message[1], names, message[2])
    if message[0] == 'box':
        return tracker.push_box(*message[1:])
    return tracker.push_wrench(*message)


def feed(tracker, messages, names):
    outputs = [output for message in messages for output in feed_one(tracker, message, names)]
    return outputs + tracker.flush()


def in_order(*streams):
    return sorted((m for stream in streams for m in stream), key=lambda m: m[1])


def shuffled(seed, *streams):
    """Another interleaving: every stream in its own order, up to half a second ahead."""
    rng = np.random.default_rng(seed)
    ahead = rng.uniform(0.0, 0.5, len(streams))
    return [
        message
        for _, message in sorted(
            (
                (m[1] - lead + rng.uniform(0.0, 1e-9), m)
                for stream, lead in zip(streams, ahead, strict=True)
                for m in stream
            ),
            key=lambda pair: pair[0],
        )
    ]


@pytest.fixture
def tracker(person, marker_set):
    return MotionTracker(person, marker_set, MASS, SIZE)


@pytest.fixture(scope='module')
def outputs(lift, person, marker_set, solver):
    return feed(MotionTracker(person, marker_set, MASS, SIZE), in_order(*lift), solver.model.names)


def of(kind, outputs):
    return [output for output in outputs if isinstance(output, kind)]


def test_one_lift_comes_out_with_its_events(outputs):
    events = of(DetectedEvent, outputs)
    assert [e.event.phase for e in events] == [LiftPhase.START, LiftPhase.END]
    assert {e.lift_id for e in events} == {'lift_001'}
    assert {e.detected_from for e in events} == {FROM_BOX}
    (measured,) = of(MeasuredLift, outputs)
    assert measured.lift.report.ok, measured.lift.report.message
    assert measured.lift.start == events[0].event.time
    window = measured.lift.window
    assert len(window) == len(measured.lift.motion) == len(measured.status)
    assert window.time[0] - measured.lift.start < 0.01
    assert measured.lift.end - window.time[-1] < 0.01


def test_plate_samples_in_blocks_give_the_same_bits(outputs, lift, tracker, solver):
    sides = {m[0] for stream in lift for m in stream} - {'markers', 'box'}
    messages = [m for stream in lift for m in stream if m[0] not in sides]
    for side in sides:
        plate = [m for stream in lift for m in stream if m[0] == side]
        messages += [(side, plate[k][1], plate[k : k + 7]) for k in range(0, len(plate), 7)]
    got = []
    for message in sorted(messages, key=lambda m: m[1]):
        if message[0] in sides:
            samples = message[2]
            rows = np.array([[*force, *moment] for _, _, force, moment in samples])
            got += tracker.push_wrenches(message[0], [m[1] for m in samples], rows)
        else:
            got += feed_one(tracker, message, solver.model.names)
    got += tracker.flush()
    for one, other in zip(of(TrackedFrame, outputs), of(TrackedFrame, got), strict=True):
        assert one.status == other.status
        for name in ('position', 'acceleration', 'ground_force', 'free_moment', 'hand_force'):
            np.testing.assert_array_equal(
                getattr(one.motion, name), getattr(other.motion, name), err_msg=name
            )
    (one,), (other,) = of(MeasuredLift, outputs), of(MeasuredLift, got)
    np.testing.assert_array_equal(one.lift.motion.ground_force, other.lift.motion.ground_force)


def test_live_samples_are_stamped_with_their_own_time(outputs, lift, tracker):
    frames = of(TrackedFrame, outputs)
    assert len(frames) == len(lift[0])
    delay = frames[-1].filter_delay
    assert delay == pytest.approx(0.0693, abs=1e-4)
    stamps = [frame.motion.time[0] for frame in frames]
    assert stamps == pytest.approx([m[1] - delay for m in lift[0]], abs=1e-6)


def test_live_and_lift_agree_where_both_see_the_same_instant(outputs):
    """Causal and zero-phase filters differ in the transition band only."""
    (measured,) = of(MeasuredLift, outputs)
    frames = of(TrackedFrame, outputs)
    stamps = np.array([frame.motion.time[0] for frame in frames])
    live = np.array([frame.motion.position[0] for frame in frames])
    motion = measured.lift.motion
    for name in ('knee_angle_r', 'hip_flexion_l', 'pelvis_tilt', 'arm_flex_r'):
        column = motion.coordinates.index(name)
        at_same = np.interp(motion.time, stamps, live[:, column])
        assert np.degrees(np.abs(at_same - motion.position[:, column])).max() < 1.0, name


@pytest.mark.parametrize('seed', [0, 1, 2])
def test_results_do_not_depend_on_the_order_of_arrival(
    outputs, tracker, lift, sides, solver, seed
):
    """Same input, same bits, whichever stream is ahead."""
    other = feed(tracker, shuffled(seed, lift[0], lift[1], *sides), solver.model.names)
    for kind in (TrackedFrame, MeasuredLift):
        for a, b in zip(of(kind, outputs), of(kind, other), strict=True):
            first = a.motion if kind is TrackedFrame else a.lift.motion
            second = b.motion if kind is TrackedFrame else b.lift.motion
            for name in (
                'time',
                'position',
                'velocity',
                'acceleration',
                'points',
                'frames',
                'ground_force',
                'centre_of_pressure',
                'free_moment',
                'hand_force',
                'box_position',
            ):
                assert np.array_equal(
                    getattr(first, name), getattr(second, name), equal_nan=True
                ), name
    assert of(DetectedEvent, outputs) == of(DetectedEvent, other)


def test_forces_add_up(outputs, person):
    (measured,) = of(MeasuredLift, outputs)
    motion = measured.lift.motion
    total = motion.ground_force.sum(axis=1)
    assert total[:, 2] == pytest.approx((person.mass + MASS) * GRAVITY, rel=0.01)
    acceleration = np.gradient(np.gradient(motion.box_position[:, 2], 0.01), 0.01)
    carried = motion.hand_force.sum(axis=1)[:, 2]
    # Well after lift-off, where the box is carried by the hands alone.
    high = slice(40, -5)
    assert carried[high] == pytest.approx(-MASS * (GRAVITY + acceleration[high]), abs=3.0)
    assert motion.centre_of_pressure[:, 0, 1] == pytest.approx(-0.15, abs=1e-3)


def test_missing_plate_is_a_status_and_not_the_end(tracker, lift, sides, solver):
    outputs = feed(tracker, in_order(lift[0], lift[1], sides[0]), solver.model.names)
    frames = of(TrackedFrame, outputs)
    assert len(frames) == len(lift[0])
    assert {frame.status for frame in frames} == {SolveStatus.TRACKER_NO_GROUND_FORCE}
    assert 'left plate' in frames[50].message
    assert not frames[50].motion.ground_force.any()
    assert any('left plate: no samples at all' in n.text for n in of(Notice, outputs))
    (measured,) = of(MeasuredLift, outputs)
    assert measured.lift.report.status is SolveStatus.TRACKER_NO_GROUND_FORCE
    assert 'no complete ground reaction' in measured.lift.report.message


def test_box_never_seen_means_events_from_the_hands(tracker, lift, sides, solver):
    outputs = feed(tracker, in_order(lift[0], *sides), solver.model.names)
    events = of(DetectedEvent, outputs)
    assert {e.detected_from for e in events} == {FROM_HANDS}
    (measured,) = of(MeasuredLift, outputs)
    assert np.isnan(measured.lift.motion.box_position).all()
    assert any(n.text.startswith('box: no samples') for n in of(Notice, outputs))


def test_a_short_gap_is_bridged_and_a_long_one_is_not(tracker, lift, sides, solver):
    markers = lift[0][:140] + lift[0][145:150] + lift[0][175:]
    outputs = feed(tracker, in_order(markers, lift[1], *sides), solver.model.names)
    assert tracker.counts['markers: lost frames'] == 30
    (measured,) = of(MeasuredLift, outputs)
    assert measured.lift.report.status is SolveStatus.TRACKER_MARKERS_MISSING
    assert '5 bad frames bridged' in measured.lift.report.message
    bad = measured.lift.motion.time[measured.status != 0] - START
    # The gap, and as far as the zero-phase filter carries it.
    assert bad.min() == pytest.approx(1.50 - 0.11, abs=0.012)
    assert bad.max() == pytest.approx(1.74 + 0.10, abs=0.012)


def test_bad_stamps_are_counted_and_change_nothing(outputs, tracker, lift, solver):
    messages = []
    for i, message in enumerate(in_order(*lift)):
        messages.append(message)
        if i % 50 == 49:
            messages.append(message)
            messages.append((message[0], message[1] - 0.2, *message[2:]))
    other = feed(tracker, messages, solver.model.names)
    assert sum(tracker.counts.values()) == 2 * (len(in_order(*lift)) // 50)
    assert any(kind.endswith('duplicate stamps') for kind in tracker.counts)
    assert any(kind.endswith('unsorted stamps') for kind in tracker.counts)
    last = [of(TrackedFrame, some)[-1].motion.position for some in (outputs, other)]
    assert np.array_equal(*last)


def test_nan_markers_and_samples_are_done_without(tracker, lift, solver):
    names = solver.model.names
    markers = []
    for kind, stamp, positions in lift[0]:
        holed = positions.copy()
        holed[names.index('LKNE')] = np.nan
        markers.append((kind, stamp, holed))
    wrench = [
        (m[0], m[1], m[2] * (np.nan if i == 100 else 1.0), m[3]) for i, m in enumerate(lift[2])
    ]
    outputs = feed(tracker, in_order(markers, lift[1], wrench), names)
    (measured,) = of(MeasuredLift, outputs)
    assert measured.lift.report.ok
    assert sum(v for k, v in tracker.counts.items() if k.endswith('not finite')) == 1


def test_millimetres_are_refused_by_name(tracker, lift, solver):
    with pytest.raises(TrackerError, match='millimetres'):
        tracker.push_markers(START, solver.model.names, 1000.0 * lift[0][0][2])
    with pytest.raises(TrackerError, match='54 names, 3 positions'):
        tracker.push_markers(START, solver.model.names, np.zeros((3, 3)))
    with pytest.raises(TrackerError, match="'rigth'"):
        tracker.push_wrench('rigth', START, np.zeros(3), np.zeros(3))


def test_unknown_and_doubled_markers_are_told(tracker, lift, solver):
    names = (*solver.model.names, 'HAT', 'LKNE')
    messages = [('markers', m[1], np.vstack([m[2], np.ones((2, 3))])) for m in lift[0][:30]]
    outputs = feed(tracker, messages, names)
    told = [n.text for n in of(Notice, outputs) if 'HAT' in n.text]
    assert len(told) == 1
    assert tracker.counts['markers: name twice in a frame'] == 30


def heavier(samples, factor):
    return [
        (side, stamp, factor * force, factor * moment) for side, stamp, force, moment in samples
    ]


def test_masses_in_doubt_are_a_status_until_the_plates_agree_again(
    marker_set, lift, solver, person
):
    """The plates carry person and box: without a task they weigh too much, at the end not."""
    right = (person.mass + MASS) / person.mass
    plates = [m for m in lift[2] if m[1] < START + 2.2]
    plates += heavier([m for m in lift[2] if m[1] >= START + 2.2], 1.0 / right)
    tracker = MotionTracker(person, marker_set)
    outputs = feed(tracker, in_order(lift[0], plates), solver.model.names)
    first, second = (n for n in of(Notice, outputs) if 'subject.mass' in n.text)
    assert not first.information
    assert second.information
    assert 'subject.mass: 72.0 kg, deviation +13.9 %' in first.text
    frames = of(TrackedFrame, outputs)
    doubted = [f for f in frames if f.status is SolveStatus.TRACKER_MASS_MISMATCH]
    assert doubted[0].message == first.text
    assert all('subject.mass: 72.0 kg, deviation +13.' in f.message for f in doubted)
    times = [f.motion.time[0] - START for f in doubted]
    assert times[0] == pytest.approx(0.5, abs=0.1)
    assert times[-1] == pytest.approx(2.75, abs=0.1)
    assert all(f.status is SolveStatus.OK for f in frames[-5:])
    (measured,) = of(MeasuredLift, outputs)
    assert set(measured.status) == {SolveStatus.TRACKER_MASS_MISMATCH}
    assert measured.lift.report.status is SolveStatus.TRACKER_MASS_MISMATCH
    assert 'subject.mass: 72.0 kg, deviation +13.' in measured.lift.report.message


def test_box_that_is_heavier_than_its_task_says_is_found_while_it_is_held(
    marker_set, lift, solver, person
):
    heavy = MASS + 0.1 * (person.mass + MASS)
    tracker = MotionTracker(person, marker_set, heavy, SIZE)
    outputs = feed(tracker, in_order(*lift), solver.model.names)
    (told,) = (n.text for n in of(Notice, outputs) if 'subject.mass' in n.text)
    assert f'task.box_mass: {heavy:.1f} kg' in told
    assert 'deviation -9.1 %' in told
    (measured,) = of(MeasuredLift, outputs)
    assert measured.lift.report.status is SolveStatus.TRACKER_MASS_MISMATCH


def moving_start(skeleton, solver, crouch, speed):
    """One second in which the body goes straight up [m/s]; nothing else moves."""
    rng = np.random.default_rng(7)
    up = np.array([0.0, 0.0, 1.0])
    places = solver.predict(crouch)
    return [
        ('markers', START + t, places + speed * t * up + rng.normal(0.0, 5e-4, (54, 3)))
        for t in np.arange(100) / 100.0
    ]


@pytest.mark.parametrize(('speed', 'settling'), [(0.0, 0), (0.3, 48)])
def test_filters_settle_where_a_recording_begins_in_motion(
    marker_set, lift, solver, skeleton, crouch, person, speed, settling
):
    tracker = MotionTracker(person, marker_set)
    frames = of(
        TrackedFrame,
        feed(
            tracker,
            in_order(moving_start(skeleton, solver, crouch, speed), lift[2]),
            solver.model.names,
        ),
    )
    marked = [f for f in frames if f.status is SolveStatus.TRACKER_FILTER_SETTLING]
    silent = [f for f in frames if f.status is SolveStatus.TRACKER_NO_GROUND_FORCE]
    assert len(marked) + len(silent) == max(settling, len(silent))
    assert all('begins in motion, its markers move at 0.30 m/s' in f.message for f in marked)
    # What is not marked any more has the speed that the body has.
    up = skeleton.coordinates.index('pelvis_ty')
    good = [f.motion.velocity[0, up] for f in frames[48:]]
    assert good == pytest.approx([speed] * len(good), abs=0.02)


def test_several_recordings_count_on(person, marker_set, lift, solver):
    values = default_parameters()
    second = tracker_from(values, person, marker_set.name, MASS, SIZE, first_lift=5)
    outputs = feed(second, in_order(*lift), solver.model.names)
    assert {e.lift_id for e in of(DetectedEvent, outputs)} == {'lift_005'}
    assert second.lifts == 5
    with pytest.raises(MotionTrackerError, match='margin'):
        settings_from(values | {'margin': -1.0})


def test_default_parameters_are_the_default_settings():
    assert settings_from(default_parameters()) == TrackerSettings()


def test_recording_without_a_rise_has_no_lift(tracker, lift, solver):
    still = [('markers', m[1], lift[0][0][2]) for m in lift[0]]
    box = [('box', m[1], lift[1][0][2]) for m in lift[1]]
    outputs = feed(tracker, in_order(still, box, lift[2]), solver.model.names)
    assert not of(MeasuredLift, outputs)
    assert not of(DetectedEvent, outputs)
    assert len(of(TrackedFrame, outputs)) == len(still)


def test_settings_must_be_positive():
    with pytest.raises(TrackerError, match=r'tracker\.wait'):
        TrackerSettings(wait=0.0)
