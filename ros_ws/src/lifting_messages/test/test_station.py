# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The base of all stations: handlers by topic, refused input, pending work."""

import pytest

from human_model.exceptions import LiftingError
from lifting_messages.exceptions import TopicError
from lifting_messages.station import Station
from lifting_messages.topics import TASK, Quality, Topic


class Doubler(Station):
    """A station that doubles numbers and refuses negative ones."""

    PACKAGE = 'motion_tracker'
    INPUTS = (TASK,)
    OUTPUTS = (Topic('double', 'std_msgs/Float64', Quality.FRAMES),)

    def __init__(self, log=None):
        super().__init__(name='/station_1/', log=log)
        self.handlers = {'task': self._double}
        self.left = 3

    def _double(self, message):
        yield 'double', 2 * message
        if message < 0:
            raise LiftingError('negative')

    @property
    def pending(self):
        return self.left > 0

    def work(self, duration):
        self.left -= 1
        yield 'double', self.left


class Lines(list):
    """A log in memory."""

    info = warning = error = list.append


def test_receive_raises_what_the_package_refuses():
    station = Doubler()
    assert list(station.receive('task', 2)) == [('double', 4)]
    with pytest.raises(LiftingError, match='negative'):
        list(station.receive('task', -1))
    with pytest.raises(TopicError, match='other: motion_tracker') as error:
        station.receive('other', 1)
    assert (error.value.package, error.value.topic) == ('motion_tracker', 'other')


def test_guarded_input_is_counted_and_an_error_logged_once_in_a_row():
    log = Lines()
    station = Doubler(log)
    outputs = []
    for number in (1, -1, -1, 2):
        with station.guard('task'):
            outputs += station.receive('task', number)
    assert outputs == [('double', 2), ('double', -2), ('double', -2), ('double', 4)]
    assert station.counts == {'task': 4, 'errors': 2}
    assert log == ['task: negative'] == [station.last_error]


def test_an_unknown_exception_is_a_defect():
    station = Doubler()
    with pytest.raises(TypeError), station.guard('task'):
        list(station.receive('task', None))


def test_finish_works_until_nothing_is_pending():
    assert [number for _, number in Doubler().finish()] == [2, 1, 0]


def test_values_are_the_defaults_of_the_package():
    station = Doubler()
    assert station.values['motion_cutoff'] == 6.0
    assert station.name == 'station_1'


def test_latched_topics_are_those_of_late_subscribers():
    assert {quality for quality in Quality if quality.latched} == {
        Quality.LATCHED, Quality.RESULTS,
    }  # fmt: skip
