# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What stops a run from outside, and that the clearing up after it is not stopped, too."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

#: Signals that ask a run to stop: Ctrl-C, a supervisor, a terminal that is closed.
STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Have SIGTERM and SIGHUP raise KeyboardInterrupt here, as Ctrl-C does.

    A signal that is ignored stays ignored (`nohup`). Only the main thread can do this.
    """

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    chosen = [number for number in STOPPING[1:] if signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, stop) for number in chosen}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class Deafness:
    """Ignores what would stop the clearing up half-way; does nothing outside the main thread."""

    def __init__(self) -> None:
        self._before: dict[signal.Signals, Any] = {}

    def begin(self) -> None:
        """Ignore the signals from now on."""
        if threading.current_thread() is threading.main_thread() and not self._before:
            self._before = {number: signal.signal(number, signal.SIG_IGN) for number in STOPPING}

    def end(self) -> None:
        """Heed the signals as before."""
        for number, handler in self._before.items():
            signal.signal(number, handler)
        self._before = {}
