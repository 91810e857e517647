# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The measured lifts of a recording, without graph."""

from pathlib import Path

import pytest

from lifting_cli.graph_errors import SessionError
from lifting_cli.recorded_lifts import recorded_lifts
from lifting_recordings.bag_writer import BagWriter
from lifting_recordings.reader import BagReader

BAG = Path(__file__).resolve().parents[4] / 'bags' / 'symmetric_7kg'


def part_of_bag(path, topics):
    """Copy the first messages of some topics of the recording of 7 kg."""
    with BagReader(BAG) as source, BagWriter(path) as writer:
        for name in topics:
            writer.topic(name, source.topics[f'/{name}'].msgtype)
        stored = [f'/{name}' for name in topics]
        for count, (topic, stamp, message) in enumerate(source.messages(stored)):
            if count == 50:
                break
            writer.write(topic.strip('/'), stamp, message)
    return path


def test_lifts_of_a_recording():
    found = recorded_lifts(BAG)
    assert [lift.lift.lift_id for lift in found.lifts] == ['lift_001']
    assert found.lift(1) is found.lifts[0]
    assert found.subject.mass == 63.5
    assert found.start <= found.lifts[0].lift.start
    for number in (0, 2, -1):
        with pytest.raises(SessionError, match=f'lift {number} is not there: .* has 1'):
            found.lift(number)


def test_a_recording_without_its_person_is_refused(tmp_path):
    bag = part_of_bag(tmp_path / 'nobody', ['markers', 'task'])
    with pytest.raises(SessionError, match=r'subject'):
        recorded_lifts(bag)


def test_a_recording_that_ends_early_has_no_lift(tmp_path):
    found = recorded_lifts(part_of_bag(tmp_path / 'short', ['markers', 'task', 'subject']))
    assert found.lifts == ()
    with pytest.raises(SessionError, match='lift 1 is not there: the recording has 0'):
        found.lift(1)
