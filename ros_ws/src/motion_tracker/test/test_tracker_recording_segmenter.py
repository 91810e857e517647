# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings are told apart although their streams overtake each other."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from motion_tracker.core.recording_segmenter import CONFIRM, MOST, RecordingSegmenter


def push_all(segmenter, stream, stamps):
    """Push stamps as samples of themselves; return what passes."""
    return [entry for stamp in stamps for entry in segmenter.push(stream, stamp, stamp)]


def test_one_recording_passes_at_once():
    """No sample waits while stamps only go on, slightly unsorted ones included."""
    segmenter = RecordingSegmenter()
    for stamp in (0.0, 0.02, 0.01, 0.25):
        assert segmenter.push('markers', stamp, stamp) == [(0, stamp)]


@pytest.mark.parametrize('stray', [1e6, 10.0, 0.99, -1e6, -0.5])
@pytest.mark.parametrize('count', [1, CONFIRM - 1])
def test_wrong_stamps_are_dropped_and_counted(stray, count):
    """A driver that stamps a few samples wrong loses these samples, and no other stream waits."""
    segmenter = RecordingSegmenter()
    good = [0.01 * k for k in range(50)]
    wrong = [stray + 0.01 * k for k in range(count)]
    assert push_all(segmenter, 'plate', good) == [(0, stamp) for stamp in good]
    assert push_all(segmenter, 'markers', good) == [(0, stamp) for stamp in good]
    assert push_all(segmenter, 'markers', wrong) == []
    later = [0.5 + 0.01 * k for k in range(50)]
    assert push_all(segmenter, 'markers', later) == [(0, stamp) for stamp in later]
    assert push_all(segmenter, 'plate', later) == [(0, stamp) for stamp in later]
    assert segmenter.counts == {'markers: stamps far from those around them': count}


def test_a_pause_is_confirmed_by_the_next_stamps():
    """Stamps that go on after a pause pass, all of them, with a notice."""
    segmenter = RecordingSegmenter()
    push_all(segmenter, 'markers', [0.0, 0.01])
    after = [60.0 + 0.01 * k for k in range(CONFIRM)]
    assert push_all(segmenter, 'markers', after[:-1]) == []
    assert push_all(segmenter, 'markers', after[-1:]) == [(0, stamp) for stamp in after]
    assert segmenter.notices == [
        'markers: stamps leap forward by 59.990 s: a pause, or a clock that was set'
    ]


def test_a_stream_far_ahead_is_no_new_recording():
    """Markers that are five seconds ahead of a plate belong to the same recording."""
    segmenter = RecordingSegmenter()
    segmenter.push('markers', 7.0, 'm')
    assert segmenter.push('plate', 0.0, 'p') == [(0, 'p')]


def test_samples_of_the_next_recording_wait_for_the_last_of_this_one():
    """Markers begin anew, plate samples of the old recording still pass before them."""
    segmenter = RecordingSegmenter()
    for name in ('markers', 'plate'):
        segmenter.push(name, 7.0, name)
    new = [0.01 * k for k in range(CONFIRM)]
    assert push_all(segmenter, 'markers', new) == []
    assert segmenter.push('plate', 7.1, 'old plate') == [(0, 'old plate')]
    assert push_all(segmenter, 'plate', new) == [(1, stamp) for stamp in new * 2]


def test_a_clock_set_back_alone_holds_the_others_for_a_bounded_time():
    """Within two seconds of the clock all streams are in one recording again, with a notice."""
    now = [0.0]
    segmenter = RecordingSegmenter(clock=lambda: now[0])
    for name in ('markers', 'plate'):
        segmenter.push(name, 7.0, 7.0)
    passed = 0
    while not passed and now[0] < 10.0:
        now[0] += 0.01
        passed = len(segmenter.push('markers', 2.0 + now[0], 'set back'))
        assert segmenter.push('plate', 7.0 + now[0], 'right') or passed
    assert now[0] <= 2.0
    assert (
        'clocks differ: the stamps of markers went back, those of plate did not'
        in (segmenter.notices[-1])
    )
    assert segmenter.push('markers', 2.01 + now[0], 'm') == [(1, 'm')]
    assert segmenter.push('plate', 7.01 + now[0], 'p') == [(1, 'p')]


def test_what_waits_is_bounded_without_a_clock():
    """Of files no clock counts: the number of samples ends the wait."""
    segmenter = RecordingSegmenter()
    for name in ('markers', 'plate'):
        segmenter.push(name, 7.0, 7.0)
    passed = push_all(segmenter, 'markers', (1e-5 * k for k in range(MOST)))
    assert [stamp for _, stamp in passed] == [1e-5 * k for k in range(MOST)]


def test_the_end_releases_what_waits_in_order():
    """A stream that never comes back does not swallow the others."""
    segmenter = RecordingSegmenter()
    for name in ('markers', 'plate'):
        segmenter.push(name, 7.0, name)
    new = [0.01 * k for k in range(CONFIRM)]
    push_all(segmenter, 'markers', new)
    assert segmenter.end() == [(1, stamp) for stamp in new]
    assert segmenter.push('markers', 3.0, 'later') == [(segmenter.current, 'later')]


@given(st.lists(st.sampled_from(['a', 'b', 'c']), min_size=60, max_size=120), st.integers(2, 4))
def test_any_interleaving_keeps_recordings_apart_and_loses_nothing(order, plays):
    """Each stream sends its stamps `plays` times; arrival order between streams is arbitrary."""
    sent = {name: [(k, i) for k in range(plays) for i in range(9)] for name in 'abc'}
    queues = {name: list(samples) for name, samples in sent.items()}
    segmenter = RecordingSegmenter()
    segmenter.expect('abc')
    passed = []
    for name in [*order, *'abc' * (9 * plays)]:
        if queues[name]:
            play, i = queues[name].pop(0)
            passed += segmenter.push(name, 0.25 * i, (name, play, i))
    passed += segmenter.end()
    assert len(passed) == 3 * 9 * plays
    assert [recording for recording, _ in passed] == sorted(play for _, (_, play, _) in passed)
    assert all(recording == play for recording, (_, play, _) in passed)
    by_stream = {name: [s for _, s in passed if s[0] == name] for name in 'abc'}
    for name, samples in by_stream.items():
        assert [(play, i) for _, play, i in samples] == sent[name]
