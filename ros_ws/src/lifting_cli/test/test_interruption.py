# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Signals stop a run once, and leave its clearing up alone."""

import os
import signal
import subprocess
import sys
import threading

import pytest

from lifting_cli.interruption import STOPPING, SignalMask, stopped_by_signals
from lifting_cli.node_process import start_module


@pytest.fixture(autouse=True)
def as_in_a_terminal():
    """Handlers as Python has them in a terminal, wherever the tests run."""
    plain = (signal.default_int_handler, signal.SIG_DFL, signal.SIG_DFL)
    before = [signal.signal(*pair) for pair in zip(STOPPING, plain, strict=True)]
    yield
    for pair in zip(STOPPING, before, strict=True):
        signal.signal(*pair)


def handlers():
    return [signal.getsignal(number) for number in STOPPING]


@pytest.mark.parametrize('number', STOPPING)
def test_each_signal_is_an_interrupt_from_the_keyboard(number):
    before = handlers()
    with pytest.raises(KeyboardInterrupt), stopped_by_signals():
        os.kill(os.getpid(), number)
    assert handlers() == before


def test_what_the_caller_ignores_stays_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stopped_by_signals():
            os.kill(os.getpid(), signal.SIGHUP)
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_clearing_up_is_not_stopped():
    before = handlers()
    mask = SignalMask()
    mask.begin()
    mask.begin()
    for number in STOPPING:
        os.kill(os.getpid(), number)
    mask.end()
    assert handlers() == before


def test_another_thread_changes_nothing():
    before = handlers()
    mask = SignalMask()
    thread = threading.Thread(target=lambda: (mask.begin(), mask.end()))
    thread.start()
    thread.join()
    assert handlers() == before


@pytest.mark.parametrize('terminal', [True, False])
def test_processes_of_a_graph_are_out_of_reach_of_the_terminal(tmp_path, terminal):
    process = start_module('helper', 'http.server', tmp_path, arguments=('0',), terminal=terminal)
    try:
        same = os.getpgid(process.process.pid) == os.getpgid(0)
    finally:
        process.stop()
    assert same == terminal


def test_stop_signals_end_a_process_that_waits(tmp_path):
    """As the command does it: the interrupt unwinds, the clearing up runs to its end."""
    script = tmp_path / 'run.py'
    script.write_text(
        'import sys, time\n'
        'from lifting_cli.interruption import SignalMask, stopped_by_signals\n'
        'mask = SignalMask()\n'
        'try:\n'
        '    with stopped_by_signals():\n'
        '        try:\n'
        '            print("ready", flush=True)\n'
        '            time.sleep(60)\n'
        '        finally:\n'
        '            mask.begin()\n'
        '            print("clearing up", flush=True)\n'
        '            time.sleep(0.5)\n'
        '            print("done", flush=True)\n'
        '            mask.end()\n'
        'except KeyboardInterrupt:\n'
        '    sys.exit(130)\n'
    )
    process = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == 'ready\n'
    process.send_signal(signal.SIGTERM)
    assert process.stdout.readline() == 'clearing up\n'
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=30)
    assert (rest, process.returncode) == ('done\n', 130)
