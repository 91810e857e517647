# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Environment and end of the node processes; no ROS."""

import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from lifting_cli import node_process
from lifting_cli.graph_errors import NodeDiedError
from lifting_cli.node_process import (
    DISCOVERY_PROFILE,
    PROFILE_VARIABLES,
    discovery,
    environment,
    start_module,
    stop_all,
)


@pytest.fixture
def nothing_set(monkeypatch):
    for name in ('ROS_AUTOMATIC_DISCOVERY_RANGE', *PROFILE_VARIABLES):
        monkeypatch.delenv(name, raising=False)
    return monkeypatch


def test_discovery_stays_on_this_machine_and_is_quick(nothing_set):
    assert discovery() == {
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'FASTRTPS_DEFAULT_PROFILES_FILE': str(DISCOVERY_PROFILE),
    }
    assert discovery().items() <= environment().items()


def test_what_the_user_has_set_goes_first(nothing_set):
    nothing_set.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    assert list(discovery()) == ['FASTRTPS_DEFAULT_PROFILES_FILE']
    nothing_set.setenv('FASTDDS_DEFAULT_PROFILES_FILE', '/etc/plant/dds.xml')
    assert discovery() == {}
    assert 'FASTRTPS_DEFAULT_PROFILES_FILE' not in environment()
    assert environment()['ROS_AUTOMATIC_DISCOVERY_RANGE'] == 'SUBNET'


def test_profile_announces_for_as_long_as_a_start_may_take():
    space = {'dds': 'http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles'}
    (quick,) = ET.parse(DISCOVERY_PROFILE).getroot().iterfind('.//dds:initialAnnouncements', space)
    count = int(quick.findtext('dds:count', namespaces=space))
    period = 1e-9 * int(quick.findtext('dds:period/dds:nanosec', namespaces=space))
    assert count * period == pytest.approx(10.0)


def test_processes_end_with_a_parent_that_is_killed(tmp_path):
    script = (
        'import sys, time\n'
        'from pathlib import Path\n'
        'from lifting_cli.node_process import start_module\n'
        'helper = start_module("helper", "http.server", Path(sys.argv[1]), arguments=("0",))\n'
        'print(helper.process.pid, flush=True)\n'
        'time.sleep(60)\n'
    )
    command = [sys.executable, '-c', script, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as parent:
        helper = int(parent.stdout.readline())
        assert alive(helper)
        parent.kill()
    deadline = time.monotonic() + 30.0
    while alive(helper):
        assert time.monotonic() < deadline, 'the helper goes on without its parent'
        time.sleep(0.02)


def alive(process):
    """Return whether a process runs; one that has ended but was not asked for does not."""
    try:
        state = Path(f'/proc/{process}/stat').read_text().rpartition(')')[2].split()[0]
    except FileNotFoundError:
        return False
    return state not in 'ZX'


STUBBORN = """
import signal, sys, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
if sys.argv[1] == 'deaf':
    signal.signal(signal.SIGINT, signal.SIG_IGN)
print('ready', flush=True)
try:
    while True:
        time.sleep(0.01)
except KeyboardInterrupt:
    sys.exit(3)
"""


@pytest.mark.parametrize('inherited', [signal.default_int_handler, signal.SIG_IGN])
def test_processes_that_do_not_end_are_broken_off_then_killed_side_by_side(
    tmp_path, monkeypatch, inherited
):
    monkeypatch.setattr(node_process, 'BREAK_OFF', 0.2)
    monkeypatch.setattr(node_process, 'STOP_TIMEOUT', 1.0)
    (tmp_path / 'stubborn.py').write_text(STUBBORN)
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    kinds = {'busy': 'busy', 'deaf_1': 'deaf', 'deaf_2': 'deaf', 'deaf_3': 'deaf'}
    # Ignored: as in a command that a shell has started in the background.
    before = signal.signal(signal.SIGINT, inherited)
    try:
        processes = [
            start_module(name, 'stubborn', tmp_path, arguments=(kind,))
            for name, kind in kinds.items()
        ]
    finally:
        signal.signal(signal.SIGINT, before)
    deadline = time.monotonic() + 30.0
    while any('ready' not in process.log.read_text() for process in processes):
        assert time.monotonic() < deadline
        time.sleep(0.02)
    began = time.monotonic()
    codes = stop_all(processes)
    assert codes == {'busy': 3, 'deaf_1': -9, 'deaf_2': -9, 'deaf_3': -9}
    assert 1.0 <= time.monotonic() - began < 2.9


def test_end_of_a_process_is_told_with_its_last_words(tmp_path):
    process = start_module('helper', 'lifting_cli.cli', tmp_path, arguments=('no_command',))
    process.process.wait(30)
    with pytest.raises(NodeDiedError, match=r'helper ended with exit code 2(.|\n)*no_command'):
        process.check()
    assert process.stop() == 2
