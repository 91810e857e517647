# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The live view: gauges while the recording runs, a line for each thing that happens."""

from __future__ import annotations

import math
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from lifting_cli.live.state import Kind, Line, LiveState

_STYLE = {Kind.PLAIN: '', Kind.GOOD: 'green', Kind.WARNING: 'yellow', Kind.ALARM: 'bold red'}

#: Width of a gauge [characters].
_WIDTH = 40


class LiveView:
    """Show a LiveState: lines above, gauges below; lines alone where there is no terminal.

    Parameters
    ----------
    state : LiveState
        What to show.
    duration : float
        Length of the recording [s].
    limits : dict
        `compression` and `shear`: limits that end the gauges' green part [N].
    console : Console, optional
        Where to show it.
    """

    def __init__(
        self,
        state: LiveState,
        duration: float,
        limits: dict[str, float],
        console: Console | None = None,
    ) -> None:
        self._state = state
        self._duration = duration
        self._limits = limits
        self.console = console or Console(highlight=False, soft_wrap=True)
        self._live = Live(console=self.console, refresh_per_second=8, transient=True)

    def __enter__(self) -> Self:
        if self.console.is_terminal:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._live.stop()

    def add(self, lines: list[Line]) -> None:
        """Print new lines."""
        for line in lines:
            time = '       ' if math.isnan(line.time) else f'{line.time:6.2f}s'
            self.console.print(Text(f'{time}  ', style='dim') + Text(line.text, _STYLE[line.kind]))

    def warn(self, text: str) -> None:
        """Print a warning that belongs to no instant."""
        self.add([Line(math.nan, text, Kind.WARNING)])

    def refresh(self) -> None:
        """Draw the gauges anew."""
        if self.console.is_terminal:
            self._live.update(self._gauges())

    def _gauges(self) -> Table:
        table = Table.grid(padding=(0, 2))
        state = self._state
        table.add_row(
            'recording',
            _bar(state.now / self._duration, 'cyan'),
            f'{state.now:5.1f} of {self._duration:.1f} s',
        )
        rows = (
            ('L5-S1 compression', state.compression, self._limits['compression']),
            ('L5-S1 anterior shear', state.shear, self._limits['shear']),
        )
        for name, value, limit in rows:
            if math.isnan(value):
                table.add_row(name, _bar(0.0, 'green'), f'    - of {limit:.0f} N')
                continue
            colour = 'red' if value > limit else 'green'
            table.add_row(name, _bar(value / limit, colour), f'{value:5.0f} of {limit:.0f} N')
        return table


def _bar(fraction: float, style: str) -> Text:
    filled = round(_WIDTH * min(max(fraction, 0.0), 1.0))
    return Text('█' * filled, style) + Text('░' * (_WIDTH - filled), 'dim')
