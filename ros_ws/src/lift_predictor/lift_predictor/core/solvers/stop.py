# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A flag by which another thread ends the work of the solvers, between two of their iterations."""

from __future__ import annotations

import ctypes

from lift_predictor.core.exceptions import CancelledError


class StopFlag:
    """Set by one thread, read by the solvers of another; the compiled method reads it in place."""

    def __init__(self) -> None:
        self._flag = ctypes.c_int(0)
        self._why = ''

    def set(self, why: str) -> None:
        """Have the work end.

        Parameters
        ----------
        why : str
            For the error that ends it.
        """
        self._why = why
        self._flag.value = 1

    def clear(self) -> None:
        """Let work go on that begins now."""
        self._flag.value = 0

    def check(self) -> None:
        """End the work here if the flag is set.

        Raises
        ------
        CancelledError
            With the reason that was given.
        """
        if self._flag.value:
            raise CancelledError(self._why)

    @property
    def address(self) -> int:
        """Where the flag is, for compiled code: an int that is not 0 when it is set."""
        return ctypes.addressof(self._flag)
