# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings are told apart although their streams overtake each other."""

from hypothesis import given
from hypothesis import strategies as st

from motion_tracker.core.recording_segmenter import RecordingSegmenter


def test_one_recording_passes_at_once():
    """No sample waits while stamps only go on, slightly unsorted ones included."""
    segmenter = RecordingSegmenter()
    for stamp in (0.0, 0.02, 0.01, 5.0):
        assert segmenter.push('markers', stamp, stamp) == [(0, stamp)]


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
    assert segmenter.push('markers', 0.0, 'new marker') == []
    assert segmenter.push('plate', 7.1, 'old plate') == [(0, 'old plate')]
    assert segmenter.push('plate', 0.0, 'new plate') == [(1, 'new marker'), (1, 'new plate')]


def test_the_end_releases_what_waits_in_order():
    """A stream that never comes back does not swallow the others."""
    segmenter = RecordingSegmenter()
    for name in ('markers', 'plate'):
        segmenter.push(name, 7.0, name)
    segmenter.push('markers', 0.0, 'a')
    assert segmenter.end() == [(1, 'a')]
    assert segmenter.push('markers', 3.0, 'later') == [(segmenter.current, 'later')]


@given(st.lists(st.sampled_from(['a', 'b', 'c']), min_size=60, max_size=120), st.integers(2, 4))
def test_any_interleaving_keeps_recordings_apart_and_loses_nothing(order, plays):
    """Each stream sends its stamps `plays` times; arrival order between streams is arbitrary."""
    sent = {name: [(k, i) for k in range(plays) for i in range(5)] for name in 'abc'}
    queues = {name: list(samples) for name, samples in sent.items()}
    segmenter = RecordingSegmenter()
    segmenter.expect('abc')
    passed = []
    for name in [*order, *'abc' * (5 * plays)]:
        if queues[name]:
            play, i = queues[name].pop(0)
            passed += segmenter.push(name, float(i), (name, play, i))
    passed += segmenter.end()
    assert len(passed) == 3 * 5 * plays
    assert [recording for recording, _ in passed] == sorted(play for _, (_, play, _) in passed)
    assert all(recording == play for recording, (_, play, _) in passed)
    by_stream = {name: [s for _, s in passed if s[0] == name] for name in 'abc'}
    for name, samples in by_stream.items():
        assert [(play, i) for _, play, i in samples] == sent[name]
