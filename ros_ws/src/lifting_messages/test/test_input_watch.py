# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Missing inputs are named in time, and no longer when they are back."""

import pytest

from lifting_messages.input_watch import InputWatch
from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

MARKERS = Topic('markers', 'lifting_interfaces/Markers', Quality.FRAMES)
PLATE = Topic('plate', 'geometry_msgs/WrenchStamped', Quality.PLATES)
LIFT = Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS)


class Clock:
    """A clock that is set by hand."""

    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def watch(clock):
    return InputWatch((SUBJECT, TASK, MARKERS, PLATE, LIFT), clock, patience=1.5)


def test_nothing_is_missing_at_the_beginning(watch, clock):
    clock.now += 1.4
    assert watch.problems() == []


def test_everything_is_missing_after_a_while(watch, clock):
    clock.now += 1.5
    assert watch.problems() == ['no subject yet', 'no task yet', 'no markers or plate yet']
    watch.note('subject')
    watch.note('markers')
    assert watch.problems() == ['no task yet']


def test_stream_that_stops_is_named_and_cleared_when_it_is_back(watch, clock):
    for name in ('subject', 'task', 'markers', 'plate'):
        watch.note(name)
    clock.now += 5.0
    watch.note('plate')
    assert watch.problems() == ['no markers for 5 s']
    watch.note('markers')
    assert watch.problems() == []


def test_stream_that_never_came_is_not_needed(watch, clock):
    for name in ('subject', 'task', 'markers'):
        watch.note(name)
    clock.now += 1.6
    watch.note('markers')
    assert watch.problems() == []


def test_activation_gives_time_again(watch, clock):
    for name in ('subject', 'task', 'markers'):
        watch.note(name)
    clock.now += 60.0
    watch.begin()
    assert watch.problems() == []
    clock.now += 2.0
    assert watch.problems() == ['no markers for 2 s']
