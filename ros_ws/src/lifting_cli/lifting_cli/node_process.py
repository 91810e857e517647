# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node processes of the graph, started from the Python environment (no `launch` needed)."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from lifting_cli.graph_errors import NodeDiedError
from lifting_cli.interruption import SignalMask
from lifting_node.discovery import STAY_ON_MACHINE

#: Order of start: what computes longest before it is ready comes first.
NODES = ('muscle_analyzer', 'lift_predictor', 'motion_tracker', 'injury_monitor')

#: Shows what the others publish; started where somebody looks.
VISUALIZATION = 'lifting_visualization'

#: Parameters of the nodes of a graph that plays a recording. A stream that the recording has will
#: come, however busy the machine is: the tracker waits for it longer than for a live one.
PARAMETERS: dict[str, dict[str, object]] = {'motion_tracker': {'wait': 60.0}}

#: Profile of Fast DDS with which processes that start together find each other at once.
DISCOVERY_PROFILE = Path(__file__).with_name('data') / 'fast_dds.xml'

#: Variables that name a profile of the user's own, which goes before ours.
PROFILE_VARIABLES = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')

_LIBC = ctypes.CDLL(None)
#: From <linux/prctl.h>: the signal a process gets when its parent dies.
_PR_SET_PDEATHSIG = 1

#: Time [s] after SIGTERM until a process gets SIGINT: one that computes in a callback heeds the
#: first when that is done; for the second Python breaks it off.
BREAK_OFF = 3.0

#: Time [s] after SIGTERM until a process is killed.
STOP_TIMEOUT = 15.0


@dataclass
class NodeProcess:
    """One running node process.

    Parameters
    ----------
    name : str
        Node name, equal to its package's name.
    process : subprocess.Popen
        The process.
    log : Path
        File that takes its standard output and error.
    """

    name: str
    process: subprocess.Popen[bytes]
    log: Path

    def check(self) -> None:
        """Raise NodeDiedError if the process has ended."""
        code = self.process.poll()
        if code is not None:
            tail = self.log.read_text(encoding='utf-8', errors='replace')[-2000:]
            raise NodeDiedError(self.name, code, self.log, tail)

    def terminate(self) -> None:
        """Ask the process to end, if it still runs."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)

    def ended_within(self, timeout: float) -> bool:
        """Wait so long [s]; return whether the process has ended."""
        try:
            self.process.wait(max(timeout, 0.0))
        except subprocess.TimeoutExpired:
            return False
        return True

    def stop(self) -> int:
        """End the process, first gently; return its exit code."""
        return stop_all([self])[self.name]


def stop_all(processes: list[NodeProcess]) -> dict[str, int]:
    """End processes side by side, first gently; return their exit codes by name."""
    began = time.monotonic()
    for process in processes:
        process.terminate()
    for patience, number in ((BREAK_OFF, signal.SIGINT), (STOP_TIMEOUT, signal.SIGKILL)):
        for process in processes:
            if not process.ended_within(began + patience - time.monotonic()):
                process.process.send_signal(number)
    return {process.name: process.process.wait() for process in processes}


def discovery() -> dict[str, str]:
    """Return the variables that say how nodes find each other, without those the user has set.

    Discovery stays on this machine: a worker's data do not leave the station by default. All
    processes of a graph need the same, as a node that looks farther than its partner is found
    late. Variables count when ROS starts in a process.
    """
    values = {}
    name, default = STAY_ON_MACHINE
    if name not in os.environ:
        values[name] = default
    if not any(name in os.environ for name in PROFILE_VARIABLES):
        values[PROFILE_VARIABLES[0]] = str(DISCOVERY_PROFILE)
    return values


def environment() -> dict[str, str]:
    """Return the environment of a node process.

    Numerical libraries get one thread, as one frame's matrices are too small to share.
    """
    values = os.environ | discovery()
    values.setdefault('OMP_NUM_THREADS', '1')
    values.setdefault('OPENBLAS_NUM_THREADS', '1')
    values['PYTHONUNBUFFERED'] = '1'
    return values


def _end_with_parent() -> None:
    # A command that is killed cannot stop its nodes any more: the kernel does (Linux).
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def _own_signals() -> None:
    _end_with_parent()
    # A shell starts commands in the background with SIGINT ignored, which is inherited; `stop_all`
    # needs it to be heard.
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start_module(
    name: str,
    module: str,
    log_folder: Path,
    station: str = '',
    arguments: tuple[str, ...] = (),
    parameters: dict[str, object] | None = None,
    terminal: bool = False,
) -> NodeProcess:
    """Start a Python module as a process, in the namespace of a station if one is named.

    Parameters
    ----------
    name : str
        Name of the log file.
    module : str
        Module with a `main`, run as `python -m`.
    log_folder : Path
        Where its output goes.
    station : str
        Namespace, for example `station_1`.
    arguments : tuple of str
        Command line before `--ros-args`.
    parameters : dict, optional
        Parameter overrides.
    terminal : bool
        Whether the process belongs to the terminal: reads its keys, gets its Ctrl-C. Another one
        is stopped by its `NodeProcess` alone, in the order of the one who started it.

    Returns
    -------
    NodeProcess
    """
    log_folder.mkdir(parents=True, exist_ok=True)
    log = log_folder / f'{name}.log'
    command = [sys.executable, '-m', module, *arguments]
    if station:
        command += ['--ros-args', '-r', f'__ns:=/{station}']
    for key, value in (parameters or {}).items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        command += ['-p', f'{key}:={text}']
    with log.open('wb') as output:
        process = subprocess.Popen(
            command,
            stdin=None if terminal else subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=environment(),
            process_group=None if terminal else 0,
            # System calls, no locks.
            preexec_fn=_end_with_parent if terminal else _own_signals,  # noqa: PLW1509
        )
    return NodeProcess(name, process, log)


@contextmanager
def node_processes(
    log_folder: Path, station: str, visualize: bool = False
) -> Iterator[list[NodeProcess]]:
    """Start all nodes of a graph, which load their models side by side; end them at the end.

    Needs nothing of ROS, so that a command can do it before it loads what it needs itself.

    Parameters
    ----------
    log_folder : Path
        Where the nodes' output goes.
    station : str
        Namespace of the graph.
    visualize : bool
        Also start the node that draws for RViz and Foxglove.

    Yields
    ------
    list of NodeProcess
    """
    processes: list[NodeProcess] = []
    mask = SignalMask()
    try:
        for name in (*NODES, VISUALIZATION) if visualize else NODES:
            module = f'{name}.{name}_node'
            values = PARAMETERS.get(name)
            processes.append(start_module(name, module, log_folder, station, parameters=values))
        yield processes
    finally:
        mask.begin()
        stop_all(processes)
        mask.end()
