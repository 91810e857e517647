# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The space bar pauses and resumes playing, where standard input is a terminal."""

from __future__ import annotations

import os
import select
import sys
import termios
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager

from lifting_cli.transport.play_options import PlayControl

_POLL_SECONDS = 0.1


@contextmanager
def space_bar_pauses(control: PlayControl) -> Iterator[bool]:
    """Listen for the space bar while the context lasts.

    Yields
    ------
    bool
        Whether anybody can press it: False when standard input is no terminal.
    """
    if not sys.stdin.isatty():
        yield False
        return
    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    over = threading.Event()
    # Single keys without Enter; Ctrl-C still raises its signal.
    tty.setcbreak(terminal)
    listener = threading.Thread(target=_listen, args=(control, over), daemon=True)
    listener.start()
    try:
        yield True
    finally:
        over.set()
        listener.join()
        termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def _listen(control: PlayControl, over: threading.Event) -> None:
    while not over.is_set():
        ready, _, _ = select.select([sys.stdin], [], [], _POLL_SECONDS)
        if not ready:
            continue
        # Past Python's own buffer, which would hide further keys from select.
        keys = os.read(sys.stdin.fileno(), 64)
        if not keys:
            return
        for _ in range(keys.count(b' ')):
            control.toggle()
