# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Python's search for reference cycles, kept out of the way of live samples.

Left to itself the search begins in the middle of whatever allocates, which in a node is a live
sample: 1 ms twice a second, and tens of milliseconds where it goes over all that was loaded.
"""

from __future__ import annotations

import gc
from typing import Final

#: Short searches between two that go over all that has been made since the beginning.
SHORT_SEARCHES: Final = 60


class TimedSearch:
    """Searches when it is told to, not when something is allocated.

    What there is at the beginning stays for good and is not searched again. Objects outside of
    cycles, nearly all there are, are freed at once as ever.
    """

    def __init__(self) -> None:
        self._turns = 0

    def begin(self) -> None:
        """Take over: from here on only `step` searches."""
        gc.collect()
        gc.freeze()
        gc.disable()

    def step(self) -> None:
        """Search among what is new since the last turn; now and then among all that is newer."""
        self._turns += 1
        gc.collect(2 if self._turns % SHORT_SEARCHES == 0 else 0)

    def end(self) -> None:
        """Leave it to Python again."""
        gc.enable()
