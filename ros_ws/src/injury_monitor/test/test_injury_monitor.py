# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The monitor as a whole: scenarios, operator commands, replay, bad samples."""

import math
from dataclasses import replace

import numpy as np
import pytest

from human_model.task import Coupling, Work
from injury_monitor.core.alarm import AlarmState, Trigger
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import (
    AlarmCommandError,
    InjuryMonitorError,
    InvalidInputError,
    OperatorError,
    ShelveDurationError,
    UnknownAlarmError,
)
from injury_monitor.core.monitor import InjuryMonitor

HIGH = 'l5_s1_compression_high'
HIGH_HIGH = 'l5_s1_compression_high_high'
SHEAR = 'l5_s1_anterior_shear_high'
ASSIGNMENT = Assignment('bag_1', 'P01', 70.0, 12.0, Work(50.0, 1.0, 1.0, Coupling.FAIR))
FREQUENT = Work(500.0, 1.0, 1.0)
RATE = 100.0


def monitor(assignment=ASSIGNMENT, **options):
    return InjuryMonitor('cell_1', assignment=assignment, **options)


def lift(peak, duration=2.0, rest=600.0, before=1.0, after=2.0):
    """Return stamps and a compression that rises and falls like half a sine over one lift."""
    stamps = np.arange(round((before + duration + after) * RATE)) / RATE
    phase = np.clip((stamps - before) / duration, 0.0, 1.0)
    return stamps, rest + (peak - rest) * np.sin(np.pi * phase)


def feed(target, stamps, compression, shear=None, solved=None, lift_id='lift_001'):
    events = []
    for k, stamp in enumerate(stamps):
        events += target.update_spine_load(
            float(stamp),
            float(compression[k]),
            0.0 if shear is None else float(shear[k]),
            True if solved is None else bool(solved[k]),
            lift_id,
        )
    return events


def of(events, alarm):
    return [event for event in events if event.alarm == alarm]


def test_scenario_one_heavy_lift():
    """Time to alarm, hold, time to clear, against the crossings of the analytic curve."""
    stamps, load = lift(4500.0)
    raised, returned = of(feed(monitor(), stamps, load), HIGH)
    crossing = 1.0 + 2.0 / math.pi * math.asin((3400.0 - 600.0) / (4500.0 - 600.0))
    falling = 3.0 - 2.0 / math.pi * math.asin((3400.0 * 0.98 - 600.0) / (4500.0 - 600.0))
    assert raised.state is AlarmState.UNACKNOWLEDGED_ACTIVE
    assert 0.05 <= raised.stamp - crossing <= 0.05 + 1.5 / RATE
    assert raised.onset - crossing <= 1.0 / RATE
    assert returned.state is AlarmState.UNACKNOWLEDGED_RETURNED
    assert 0.5 <= returned.stamp - falling <= 0.5 + 1.5 / RATE
    assert raised.limit == 3400.0 and raised.margin == 3400.0 - raised.value < 0.0
    assert raised.stamp_raised == raised.stamp and math.isnan(raised.stamp_returned)
    assert returned.occurrence == raised.occurrence and returned.lift_id == 'lift_001'
    assert '3400' in raised.message() and 'margin' in raised.message()


def test_scenario_no_false_alarm_in_a_shift_of_light_lifts_with_outliers():
    """200 lifts at 3300 N with noise of 20 N and single-frame outliers of 9000 N: no alarm."""
    generator = np.random.default_rng(7)
    target = monitor()
    stamps, load = lift(3300.0, before=0.2, after=0.8)
    events = []
    for k in range(200):
        noisy = load + generator.normal(0.0, 20.0, len(load))
        noisy[generator.choice(len(load), 2, replace=False)] = 9000.0
        # Two neighbouring outliers are no single frames: keep them apart.
        outliers = np.flatnonzero(noisy == 9000.0)
        if outliers[1] - outliers[0] < 3:
            noisy[outliers[1]] = load[outliers[1]]
        events += feed(target, stamps + k * 3.0, noisy)
    assert events == []


def test_scenario_noise_at_the_limit_does_not_chatter():
    """Ten lifts with 50 N noise crossing the limit give ten occurrences and ten returns."""
    generator = np.random.default_rng(3)
    target = monitor()
    stamps, load = lift(4200.0, before=0.5, after=1.5)
    events = []
    for k in range(10):
        events += feed(target, stamps + k * 4.0, load + generator.normal(0.0, 50.0, len(load)))
    triggers = [event.trigger for event in of(events, HIGH)]
    assert triggers == [Trigger.RAISE, Trigger.CLEAR] * 10
    assert len({event.occurrence for event in of(events, HIGH)}) == 10


def test_beyond_the_maximum_permissible_limit_it_latches():
    target = monitor()
    events = feed(target, *lift(7000.0))
    assert [event.state for event in of(events, HIGH_HIGH)] == [
        AlarmState.UNACKNOWLEDGED_ACTIVE,
        AlarmState.LATCHED_UNACKNOWLEDGED,
    ]
    with pytest.raises(AlarmCommandError):
        target.command(Trigger.RESET, HIGH_HIGH, 'panel 1')
    (acknowledged,) = target.command(Trigger.ACKNOWLEDGE, HIGH_HIGH, 'panel 1')
    assert acknowledged.state is AlarmState.LATCHED_ACKNOWLEDGED
    assert acknowledged.operator == 'panel 1' and acknowledged.stamp_acknowledged == pytest.approx(
        4.99
    )
    (reset,) = target.command(Trigger.RESET, HIGH_HIGH, 'panel 1')
    assert reset.state is AlarmState.NORMAL
    assert len({event.occurrence for event in [*of(events, HIGH_HIGH), acknowledged, reset]}) == 1


def test_shear_limit_follows_the_loads_a_day():
    stamps, shear = lift(850.0, rest=100.0)
    assert feed(monitor(), stamps, np.zeros(len(stamps)), shear) == []
    frequent = monitor(replace(ASSIGNMENT, work=FREQUENT))
    raised = feed(frequent, stamps, np.zeros(len(stamps)), shear)[0]
    assert (raised.alarm, raised.limit) == (SHEAR, 700.0)


def test_unsolved_samples_never_raise_or_clear_and_are_counted():
    stamps, load = lift(7000.0)
    target = monitor()
    assert feed(target, stamps, load, solved=np.zeros(len(stamps), bool)) == []
    assert target.counts['spine_load'].unsolved == len(stamps)
    target = monitor()
    heavy = int(np.argmax(load))
    feed(target, stamps[:heavy], load[:heavy])
    assert target.states()[HIGH] is AlarmState.UNACKNOWLEDGED_ACTIVE
    later = stamps[heavy:] + 1.0
    assert feed(target, later, np.zeros(len(later)), solved=np.zeros(len(later), bool)) == []
    assert feed(target, later + 10.0, np.full(len(later), math.nan)) == []
    assert target.states()[HIGH] is AlarmState.UNACKNOWLEDGED_ACTIVE


def test_one_unsolved_frame_inside_a_lift_changes_one_frame_at_most():
    stamps, load = lift(4500.0)
    whole = of(feed(monitor(), stamps, load), HIGH)
    solved = np.ones(len(stamps), bool)
    solved[np.searchsorted(stamps, whole[0].onset) + 2] = False
    holed = of(feed(monitor(), stamps, np.where(solved, load, 1e6), solved=solved), HIGH)
    assert [event.trigger for event in holed] == [event.trigger for event in whole]
    assert 0.0 <= holed[0].stamp - whole[0].stamp <= 2.5 / RATE


def test_the_same_samples_give_the_same_events_in_any_block_size_and_order_of_streams():
    stamps, load = lift(7000.0)
    shear = 0.2 * load
    names, torque = ('hip', 'knee'), np.column_stack([load / 100.0, load / 200.0])
    low, high = np.full(2, -50.0), np.full(2, 60.0)

    def run(interleaved):
        target = monitor()
        spine, joints = [], []
        for k, stamp in enumerate(stamps):
            spine += target.update_spine_load(stamp, load[k], shear[k], True)
            if interleaved:
                joints += target.update_joint_torques(stamp, names, torque[k], low, high, True)
        if not interleaved:
            for k, stamp in enumerate(stamps):
                joints += target.update_joint_torques(stamp, names, torque[k], low, high, True)
        return [event.__dict__ for event in spine + joints]

    first, second = run(True), run(False)
    # NaN is not equal to itself: compare the representations.
    assert repr(first) == repr(second) and len(first) >= 6


def test_playing_a_recording_again_announces_nothing_again():
    stamps, load = lift(7000.0)
    target = monitor()
    first = feed(target, stamps, load)
    second = feed(target, stamps, load, lift_id='lift_002')
    third = feed(target, stamps, load, lift_id='lift_003')
    assert [event.trigger for event in first].count(Trigger.RAISE) == 3 - 1
    assert second == [] and third == []
    assert target.repeats_withheld() == 4
    assert target.counts['spine_load'].restarts == 2
    assert len(feed(target, stamps + 100.0, load)) == 4


def test_a_recording_cut_during_an_alarm_clears_on_the_next_play():
    stamps, load = lift(4500.0)
    cut = int(np.argmax(load))
    target = monitor()
    (raised,) = of(feed(target, stamps[:cut], load[:cut]), HIGH)
    second = of(feed(target, stamps[:cut], load[:cut]), HIGH)
    assert [event.trigger for event in second] == [Trigger.CLEAR]
    assert second[0].occurrence == raised.occurrence
    assert of(feed(target, stamps[:cut], load[:cut]), HIGH) == []


def test_another_recording_with_the_same_clock_is_new():
    stamps, load = lift(4500.0)
    target = monitor()
    first = of(feed(target, stamps, load), HIGH)
    target.configure(replace(ASSIGNMENT, recording='bag_2'))
    second = of(feed(target, stamps, load), HIGH)
    assert [event.trigger for event in second] == [event.trigger for event in first]
    assert not {event.occurrence for event in first} & {event.occurrence for event in second}


def test_known_occurrences_survive_the_process():
    stamps, load = lift(4500.0)
    first = monitor()
    events = feed(first, stamps, load)
    second = monitor(history=events)
    assert feed(second, stamps, load) == []
    assert second.repeats_withheld() == 1


def test_a_late_or_doubled_sample_is_left_out_and_counted():
    target = monitor()
    for stamp in (0.0, 0.01, 0.01, 0.005, 0.02):
        target.update_spine_load(stamp, 5000.0, 0.0, True)
    counts = target.counts['spine_load']
    assert (counts.used, counts.out_of_order, counts.restarts) == (3, 2, 0)


def test_shelving_is_silent_and_ends_by_the_clock_of_the_station():
    now = [100.0]
    target = monitor(clock=lambda: now[0])
    target.update_spine_load(0.0, 600.0, 0.0, True)
    (shelved,) = target.command(Trigger.SHELVE, HIGH, 'panel 1', 'known test', 3.0)
    assert shelved.state is AlarmState.SHELVED and shelved.reason == 'known test'
    load = np.full(500, 5000.0)
    assert of(feed(target, 0.01 + np.arange(500) / RATE, load), HIGH) == []
    now[0] = 102.9
    assert target.tick() == []
    # Also when no more samples come.
    now[0] = 103.0
    (event,) = target.tick()
    assert (event.trigger, event.state) == (Trigger.UNSHELVE, AlarmState.UNACKNOWLEDGED_ACTIVE)
    assert event.stamp == pytest.approx(5.0)
    assert math.isnan(event.shelved_until)
    assert shelved.shelved_until == pytest.approx(103.0)


def test_a_latching_alarm_is_not_lost_while_suppressed():
    target = monitor()
    target.update_spine_load(-1.0, 600.0, 0.0, True)
    target.command(Trigger.SUPPRESS, HIGH_HIGH, 'panel 1', 'commissioning')
    assert of(feed(target, *lift(7000.0)), HIGH_HIGH) == []
    (back,) = target.command(Trigger.UNSUPPRESS, HIGH_HIGH, 'panel 1')
    assert back.state is AlarmState.LATCHED_UNACKNOWLEDGED


def test_commands_that_do_not_apply_are_refused_and_change_nothing():
    target = monitor()
    before = target.states()
    with pytest.raises(UnknownAlarmError, match='no_such_alarm'):
        target.command(Trigger.ACKNOWLEDGE, 'no_such_alarm', 'panel 1')
    with pytest.raises(AlarmCommandError, match='NORMAL'):
        target.command(Trigger.ACKNOWLEDGE, HIGH, 'panel 1')
    for operator in ('', ' '):
        with pytest.raises(OperatorError, match='role or terminal'):
            target.command(Trigger.SUPPRESS, HIGH, operator)
    with pytest.raises(AlarmCommandError, match='samples'):
        target.command(Trigger.RAISE, HIGH, 'panel 1')
    for duration in (0.0, -1.0, math.nan, 8 * 3600.0 + 1.0):
        with pytest.raises(ShelveDurationError, match='duration'):
            target.command(Trigger.SHELVE, HIGH, 'panel 1', duration=duration)
    assert target.states() == before


def test_torque_index_alarm_names_the_joint():
    target = monitor()
    events = []
    for k in range(20):
        events += target.update_joint_torques(
            k / RATE, ('hip', 'knee'), [10.0, -90.0], [-50.0, -80.0], [50.0, 80.0], True
        )
    (raised,) = events
    assert (raised.alarm, raised.detail) == ('joint_torque_index_high', 'knee')
    assert raised.value == pytest.approx(90.0 / 80.0)
    assert raised.margin == pytest.approx(-0.125)


def test_a_joint_without_published_strength_raises_nothing():
    target = monitor()
    unknown = [math.nan, math.nan]
    for k in range(20):
        assert (
            target.update_joint_torques(
                k / RATE, ('wrist', 'neck'), [500.0, 500.0], unknown, unknown, True
            )
            == []
        )
    assert target.counts['joint_torques'].unsolved == 20
    for k in range(20, 40):
        assert (
            target.update_joint_torques(
                k / RATE,
                ('wrist', 'hip'),
                [500.0, 10.0],
                [math.nan, -20.0],
                [math.nan, 20.0],
                True,
            )
            == []
        )
    assert target.counts['joint_torques'].used == 20


def test_activation_alarm_needs_a_hold():
    target = monitor()
    events = []
    for k in range(100):
        held = 1.0 if k >= 20 else 0.1
        events += target.update_activations(k / RATE, ('multifidus', 'rectus'), [held, 0.2], True)
    (raised,) = events
    assert raised.detail == 'multifidus' and raised.value >= 0.95
    assert raised.stamp == pytest.approx(0.2 + 0.5, abs=0.06)


def test_stored_data_carry_the_mark():
    target = monitor()
    events = []
    for k in range(20):
        events += target.update_spine_load(k / RATE, 5000.0, 0.0, True, historical=True)
    assert [event.historical for event in events] == [True]


def test_limits_may_change_while_an_alarm_is_active():
    """A shear alarm active under 700 N stays until the data clear it under 1000 N."""
    target = monitor(replace(ASSIGNMENT, work=FREQUENT))
    stamps = np.arange(100) / RATE
    feed(target, stamps, np.zeros(100), np.full(100, 850.0))
    assert target.states()[SHEAR] is AlarmState.UNACKNOWLEDGED_ACTIVE
    target.configure(ASSIGNMENT)
    assert target.states()[SHEAR] is AlarmState.UNACKNOWLEDGED_ACTIVE
    (cleared,) = feed(target, stamps + 1.0, np.zeros(100), np.full(100, 850.0))
    assert cleared.trigger is Trigger.CLEAR and cleared.limit == 1000.0


def test_bad_input_is_refused():
    with pytest.raises(InjuryMonitorError, match='configure'):
        InjuryMonitor().update_spine_load(0.0, 0.0, 0.0, True)
    with pytest.raises(InvalidInputError, match=r'spine_load\.stamp'):
        monitor().update_spine_load(math.nan, 0.0, 0.0, True)
    with pytest.raises(InvalidInputError, match='torque'):
        monitor().update_joint_torques(0.0, ('hip',), [1.0, 2.0], [0.0], [0.0], True)
    for field, value in (('subject', ''), ('body_mass', 0.0), ('box_mass', -1.0)):
        with pytest.raises(InvalidInputError, match=field):
            replace(ASSIGNMENT, **{field: value})
    with pytest.raises(InvalidInputError, match='lifts_per_day'):
        replace(ASSIGNMENT, work=Work(lifts_per_day=math.nan))
