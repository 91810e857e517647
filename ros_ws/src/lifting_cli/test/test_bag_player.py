# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Player and recorder as processes of their own over Fast DDS, each with a hard end."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from rosbags.interfaces import QosDurability
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from lifting_cli.transport.play_options import PlayOptions
from lifting_recordings.bag_writer import START_TIME_NS, BagWriter, in_order
from lifting_recordings.exceptions import PlaybackError, UnreadableBagError
from lifting_recordings.importer import plate_stream
from lifting_recordings.reader import BagReader
from lifting_recordings.recording import Plate

pytest.importorskip('rclpy', reason='playing needs rclpy')

PLATES = ('/force_plates/left/wrench', '/force_plates/right/wrench')
HARD_END = 60.0
PLAY = """
import dataclasses, json, sys
from pathlib import Path
from lifting_cli.transport.play_options import PlayControl, PlayOptions
from lifting_cli.transport.player import play
options = json.loads(sys.argv[1])
options['bag'] = Path(options['bag'])
said = []
try:
    report = play(PlayOptions(**options), PlayControl(paused=options.get('start_paused', False)),
                  said.append)
    print(json.dumps({**dataclasses.asdict(report), 'said': said}))
except Exception as error:
    print(json.dumps({'error': type(error).__name__, 'message': str(error)}))
"""
HELD = """
import lifting_cli.transport.player
lifting_cli.transport.player._HELD_IN_MEMORY = 0
"""
RECORD = """
import json, sys, threading
from pathlib import Path
from lifting_cli.transport.recorder import RecordControl, RecordOptions, record
control = RecordControl()
threading.Thread(target=lambda: (sys.stdin.readline(), control.stop()), daemon=True).start()
report = record(RecordOptions(Path(sys.argv[1]), tuple(sys.argv[2:])), control)
print(json.dumps({'messages': report.messages, 'skipped': report.skipped}))
"""
PAUSE = """
import sys, time
import rclpy
from rclpy.node import Node
from std_srvs.srv import SetBool
rclpy.init()
node = Node('pauser')
client = node.create_client(SetBool, '/player/pause')
assert client.wait_for_service(timeout_sec=20.0)
for value, seconds in ((False, 0.2), (True, 1.0), (False, 0.0)):
    future = client.call_async(SetBool.Request(data=value))
    rclpy.spin_until_future_complete(node, future, timeout_sec=20.0)
    print(future.result().message, flush=True)
    time.sleep(seconds)
"""


@pytest.fixture
def domain(monkeypatch):
    """Give the test a ROS domain of its own, on this machine only."""
    monkeypatch.setenv('ROS_DOMAIN_ID', str(100 + os.getpid() % 100))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Write two plates at 1000 Hz for 3 s, and latched and unknown messages."""
    path = tmp_path_factory.mktemp('play') / 'bag'
    time_s = np.arange(3000) / 1000.0
    force = np.stack((time_s, 2.0 * time_s, 300.0 + time_s), axis=1)
    with BagWriter(path, compress=False) as writer:
        writer.topic('note', 'std_msgs/msg/String', transient_local=True)
        streams = [
            plate_stream(writer, START_TIME_NS, side, Plate(side, time_s, force, force))
            for side in ('right', 'left')
        ]
        note = writer.make('std_msgs/msg/String', data='hello')
        writer.write('note', START_TIME_NS, note)
        for stamp, topic, message in in_order(*streams):
            writer.write(topic, stamp, message)
    return path


def start(script: str, *arguments: object) -> subprocess.Popen:
    return subprocess.Popen(
        [sys.executable, '-c', script, *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, 'OMP_NUM_THREADS': '1'},
    )


def finish(process: subprocess.Popen, text: str | None = None) -> dict:
    """Return the last line a process prints; kill it when it does not end."""
    try:
        out, _ = process.communicate(text, timeout=HARD_END)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    assert process.returncode == 0, out
    return json.loads(out.splitlines()[-1])


def play(bag: Path, **options: object) -> dict:
    return finish(start(PLAY, json.dumps({'bag': str(bag), **options})))


def contents(bag: Path) -> dict[str, list[tuple[int, bytes]]]:
    found: dict[str, list[tuple[int, bytes]]] = {}
    with BagReader(bag) as reader:
        for topic, stamp, data in reader.raw_messages():
            found.setdefault(topic, []).append((stamp, data))
    return found


@pytest.mark.parametrize('rate', [1.0, 10.0])
def test_what_is_played_is_recorded_to_the_last_byte(domain, bag, tmp_path, rate):
    recorder = start(RECORD, tmp_path / 'out', *PLATES, '/note')
    report = play(bag, rate=rate, wait_for=dict.fromkeys((*PLATES, '/note'), 1))
    recorded = finish(recorder, '\n')
    assert report['acknowledged']
    assert report['messages'] == {**dict.fromkeys(PLATES, 3000), '/note': 1}
    assert recorded['messages'] == report['messages']
    before, after = contents(bag), contents(tmp_path / 'out')
    for topic in PLATES:
        assert after[topic] == before[topic]
    with BagReader(tmp_path / 'out') as reader:
        assert reader.topics['/note'].qos[0].durability == QosDurability.TRANSIENT_LOCAL
        assert reader.topics[PLATES[0]].qos[0].durability == QosDurability.VOLATILE


def test_real_time_takes_the_time_of_the_bag(domain, bag):
    report = play(bag)
    assert 2.99 < report['wall_time'] < 3.5
    # Half of the messages within half a period of the plates; a busy machine may delay the rest.
    assert report['lateness_p50'] < 0.5e-3


def test_loop_and_start_offset_repeat_latched_messages(domain, bag):
    report = play(bag, rate=10.0, loop=2, start=2.0)
    assert report['messages'] == {**dict.fromkeys(PLATES, 2000), '/note': 2}


def test_big_bags_are_read_while_they_play(domain, bag):
    report = finish(start(HELD + PLAY, json.dumps({'bag': str(bag), 'rate': 10.0, 'loop': 2})))
    assert report['messages'] == {**dict.fromkeys(PLATES, 6000), '/note': 2}


def test_pause_by_service_holds_the_player(domain, bag):
    player = start(PLAY, json.dumps({'bag': str(bag), 'start_paused': True}))
    pauser = start(PAUSE)
    try:
        out, _ = pauser.communicate(timeout=HARD_END)
    except subprocess.TimeoutExpired:
        pauser.kill()
        player.kill()
        raise
    report = finish(player)
    assert out.split() == ['playing', 'paused', 'playing']
    assert report['wall_time'] > 3.9
    assert report['messages'][PLATES[0]] == 3000


def test_missing_subscribers_are_named(domain, bag):
    report = play(bag, wait_for={'note': 1}, wait_timeout=0.5)
    assert report['error'] == 'PlaybackError'
    assert "'/note': '0 of 1'" in report['message']


def test_types_that_are_not_installed_are_skipped_by_name(domain, tmp_path):
    name = 'nowhere_msgs/msg/Thing'
    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg('float64 x', name))
    with Writer(tmp_path / 'bag', version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        thing = writer.add_connection('/thing', name, typestore=store)
        text = writer.add_connection('/text', 'std_msgs/msg/String', typestore=store)
        for i in range(3):
            message = store.types[name](x=1.0)
            writer.write(thing, i + 1, store.serialize_cdr(message, name))
            word = store.types['std_msgs/msg/String'](data='a')
            writer.write(text, i + 1, store.serialize_cdr(word, 'std_msgs/msg/String'))
    report = play(tmp_path / 'bag')
    assert report['messages'] == {'/text': 3}
    assert 'nowhere_msgs/msg/Thing is not installed' in report['skipped']['/thing']
    assert any('/thing is not played' in text for text in report['said'])


def test_cut_off_bag_is_played_as_far_as_it_goes(domain, bag, tmp_path):
    whole = (bag / 'bag.mcap').read_bytes()
    (tmp_path / 'bag.mcap').write_bytes(whole[: len(whole) // 2])
    report = play(tmp_path / 'bag.mcap', rate=10.0)
    assert 0 < report['messages'][PLATES[0]] < 3000
    assert any('cut off' in text for text in report['said'])


def test_killed_recorder_leaves_a_bag_that_can_be_read(domain, bag, tmp_path):
    recorder = start(RECORD, tmp_path / 'out', *PLATES)
    report = play(bag, rate=2.0, loop=4, wait_for=dict.fromkeys(PLATES, 1))
    assert report['messages'][PLATES[0]] == 12000
    time.sleep(0.5)
    recorder.kill()
    recorder.wait(HARD_END)
    with BagReader(tmp_path / 'out') as reader:
        assert reader.loss is not None
        assert len(list(reader.messages())) > 5000


@pytest.mark.parametrize(
    ('options', 'message'),
    [({'rate': 0.0}, 'rate'), ({'loop': -1}, 'loop'), ({'start': -1.0}, 'start')],
)
def test_impossible_options(options, message):
    with pytest.raises(PlaybackError, match=f'option {message}'):
        PlayOptions(Path('x'), **options)


def test_start_after_the_end_and_missing_bag(domain, bag, tmp_path):
    assert 'no message after 10' in play(bag, start=10.0)['message']
    assert play(tmp_path / 'no')['error'] == UnreadableBagError.__name__
