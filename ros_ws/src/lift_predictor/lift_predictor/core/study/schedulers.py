# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where cases are solved: processes of this machine, or the workers of a Dask cluster.

Both give a row for each case, in the order in which they come; a worker that dies costs its case a
row with the reason, not the study.
"""

from __future__ import annotations

import importlib
import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Final, Protocol

from lift_predictor.core.exceptions import StudyError
from lift_predictor.core.study.cases import Case
from lift_predictor.core.study.rows import crashed, empty_row, solve_case

Row = dict[str, Any]
Solve = Callable[[dict[str, Any]], Row]

AHEAD: Final = 4
"""Cases handed out per worker and not answered yet: enough to keep it busy."""


class Scheduler(Protocol):
    """Solves cases somewhere."""

    @property
    def described(self) -> str:
        """Where, in words."""

    def solve(self, cases: Sequence[Case]) -> Iterator[Row]:
        """Give one row for each case, as they come."""


class LocalScheduler:
    """A pool of processes on this machine.

    Parameters
    ----------
    processes : int, optional
        Default: the processors this process may use.
    function : callable
        Solves the plain data of one case.
    """

    def __init__(self, processes: int | None = None, function: Solve = solve_case) -> None:
        self.processes = processes or len(os.sched_getaffinity(0))
        self._function = function

    @property
    def described(self) -> str:
        """Where, in words."""
        return f'{self.processes} processes of this machine'

    def solve(self, cases: Sequence[Case]) -> Iterator[Row]:
        """Give one row for each case; where a process dies, its cases are tried one by one."""
        suspects: list[Case] = []
        remaining = list(reversed(cases))
        while remaining:
            yield from self._pool(remaining, suspects)
        for case in suspects:
            try:
                with self._executor(1) as pool:
                    yield pool.submit(self._function, case.to_dict()).result()
            except BrokenProcessPool as error:
                yield empty_row(case) | crashed(f'its process ended: {error}')

    def _pool(self, remaining: list[Case], suspects: list[Case]) -> Iterator[Row]:
        """Take cases off the end of `remaining` until all are done or a process dies."""
        with self._executor(self.processes) as pool:
            running: dict[Future[Row], Case] = {}
            while remaining or running:
                while remaining and len(running) < AHEAD * self.processes:
                    case = remaining.pop()
                    try:
                        running[pool.submit(self._function, case.to_dict())] = case
                    except BrokenProcessPool:
                        remaining.append(case)
                        suspects += running.values()
                        return
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in done:
                    case = running.pop(future)
                    try:
                        yield future.result()
                    except BrokenProcessPool:
                        suspects += [case, *running.values()]
                        return

    @staticmethod
    def _executor(processes: int) -> ProcessPoolExecutor:
        # A fresh interpreter for each: nothing of the caller's threads and locks is inherited.
        spawn = multiprocessing.get_context('spawn')
        return ProcessPoolExecutor(processes, mp_context=spawn, initializer=_one_thread)


def _one_thread() -> None:
    """Cases are spread over processes; the libraries inside need no threads of their own."""
    for name in ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS'):
        os.environ[name] = '1'


def _distributed() -> Any:
    """Return the module of Dask, which loads for long and is only partly typed."""
    return importlib.import_module('distributed')


class DaskScheduler:
    """The workers of a running Dask cluster; they need this package installed.

    Parameters
    ----------
    address : str
        Of the scheduler, such as tcp://10.0.0.1:8786.
    timeout : float
        Time to reach it, and to find a first worker [s].
    function : callable
        Solves the plain data of one case; importable on the workers.

    Raises
    ------
    StudyError
        The scheduler does not answer or has no worker.
    """

    def __init__(self, address: str, timeout: float = 10.0, function: Solve = solve_case) -> None:
        self._address, self._function = address, function
        try:
            self._client = _distributed().Client(address, timeout=timeout, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise StudyError(f'scheduler {address}: does not answer: {error}') from error
        try:
            self._client.wait_for_workers(1, timeout=timeout)
        except TimeoutError as error:
            self._client.close()
            raise StudyError(f'scheduler {address}: no worker within {timeout:g} s') from error

    @property
    def workers(self) -> int:
        """Threads of all workers."""
        return int(max(sum(self._client.nthreads().values()), 1))

    @property
    def described(self) -> str:
        """Where, in words."""
        return f'{len(self._client.nthreads())} workers of {self._address}'

    def solve(self, cases: Sequence[Case]) -> Iterator[Row]:
        """Give one row for each case; the scheduler moves those of a lost worker to another."""
        waiting = iter(cases)
        by_key: dict[str, Case] = {}

        def submit() -> Any:
            case = next(waiting, None)
            if case is None:
                return None
            future = self._client.submit(
                self._function, case.to_dict(), key=f'lift-{case.case_id}', pure=False
            )
            by_key[future.key] = case
            return future

        first = [future for _ in range(AHEAD * self.workers) if (future := submit())]
        stream = _distributed().as_completed(first, loop=self._client.loop)
        for future in stream:
            case = by_key.pop(future.key)
            if future.status == 'finished':
                yield future.result()
            else:
                error = future.exception() if future.status == 'error' else future.status
                yield empty_row(case) | crashed(f'{type(error).__name__}: {error}')
            following = submit()
            if following is not None:
                stream.add(following)

    def close(self) -> None:
        """Leave the cluster."""
        self._client.close()
