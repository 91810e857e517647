# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The space bar, pressed in a pseudo-terminal."""

import os
import pty
import sys
import time

from lifting_cli.transport.keyboard import space_bar_pauses
from lifting_cli.transport.play_options import PlayControl


def wait_until(wanted: bool, control: PlayControl) -> None:
    end = time.monotonic() + 5.0
    while control.paused is not wanted and time.monotonic() < end:
        time.sleep(0.01)
    assert control.paused is wanted


def test_space_pauses_and_resumes(monkeypatch):
    master, slave = pty.openpty()
    control = PlayControl()
    with os.fdopen(slave, 'r') as terminal:
        monkeypatch.setattr(sys, 'stdin', terminal)
        with space_bar_pauses(control) as listening:
            assert listening
            os.write(master, b'x ')
            wait_until(True, control)
            os.write(master, b' ')
            wait_until(False, control)
    os.close(master)


def test_no_terminal_no_listener(monkeypatch):
    read, write = os.pipe()
    with os.fdopen(read) as pipe:
        monkeypatch.setattr(sys, 'stdin', pipe)
        with space_bar_pauses(PlayControl()) as listening:
            assert not listening
    os.close(write)
