# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The `lift` command and the parts of it that need no module of their own."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from human_model.exceptions import LiftingError
from lifting_cli import (
    compare_command,
    emg_command,
    import_command,
    journal_command,
    model_command,
    opensim_command,
    planning_command,
    study_command,
    urdf_command,
)
from lifting_cli.graph_errors import SessionError
from lifting_cli.interruption import stopped_by_signals
from lifting_cli.node_process import discovery, node_processes

#: The recording that `lift demo` plays.
DEMO_BAG = 'symmetric_12kg'

#: Missing without ROS 2, or without the built messages.
ROS_MODULES = {'ament_index_python', 'lifting_interfaces', 'rclpy', 'std_srvs'}

#: Exit code after an interrupt from the keyboard, as shells have it (128 + SIGINT).
STOPPED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    options = _parser().parse_args(import_command.with_axes(words))
    handler: Callable[[argparse.Namespace], int] = options.handler
    try:
        return handler(options)
    except LiftingError as error:
        print(f'lift {options.command}: {error}', file=sys.stderr)
        return 1
    except ModuleNotFoundError as error:
        if (error.name or '').split('.')[0] not in ROS_MODULES:
            raise
        print(
            f'lift {options.command}: needs ROS 2, and {error.name} is not installed; use the '
            'environment of `make setup` or a ROS 2 workspace. `lift run --offline` needs no ROS.',
            file=sys.stderr,
        )
        return 1
    except KeyboardInterrupt:
        print(f'lift {options.command}: stopped', file=sys.stderr)
        return STOPPED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='lift', description='Watch, predict and assess lifts from recordings.'
    )
    commands = parser.add_subparsers(dest='command', required=True)

    demo = commands.add_parser('demo', help='play a recorded lift through the whole graph')
    demo.add_argument('--bags', type=Path, default=Path('bags'), help='folder of the recordings')
    demo.add_argument('--output', type=Path, default=Path('out/demo'), help='where results go')
    demo.add_argument(
        '--visualize', action='store_true', help='also publish markers, /tf and the URDF'
    )
    demo.set_defaults(handler=_demo)

    run = commands.add_parser('run', help='run a recording through the graph and report')
    run.add_argument('bag', type=Path, help='rosbag2 recording (MCAP or SQLite)')
    run.add_argument('--output', type=Path, help='where results go (default: out/<name of bag>)')
    run.add_argument('--rate', type=float, default=1.0, help='times real time')
    run.add_argument('--station', default='station_1', help='namespace of the graph')
    run.add_argument(
        '--offline', action='store_true', help='same computation in this process, without ROS'
    )
    run.add_argument(
        '--visualize', action='store_true', help='also publish markers, /tf and the URDF'
    )
    run.add_argument(
        '--record-visualization',
        action='store_true',
        help='--visualize, and record it in results.mcap',
    )
    run.set_defaults(handler=_run)

    play = commands.add_parser('play', help='play a recording')
    play.add_argument('bag', type=Path)
    play.add_argument('--rate', type=float, default=1.0, help='times real time')
    play.add_argument('--loop', type=int, default=1, help='how often; 0: until stopped')
    play.add_argument('--start', type=float, default=0.0, help='offset [s]')
    play.add_argument('--station', default='', help='namespace of all topics')
    play.add_argument('--start-paused', action='store_true', help='wait for ~/pause false')
    play.add_argument(
        '--plate-blocks', action='store_true', help='send plate samples in blocks, one a frame'
    )
    play.add_argument(
        '--wait-for', nargs='+', default=(), metavar='TOPIC', help='wait for a subscriber of each'
    )
    play.add_argument(
        '--wait-timeout', type=float, default=20.0, help='how long to wait for them [s]'
    )
    play.set_defaults(handler=_play)

    record = commands.add_parser('record', help='record running topics to MCAP')
    record.add_argument('output', type=Path)
    record.add_argument('--topics', nargs='+', default=(), help='topics (default: all)')
    record.add_argument('--duration', type=float, help='end after so many seconds')
    record.set_defaults(handler=_record)

    report = commands.add_parser('report', help='write the report of a results file')
    report.add_argument('results', type=Path, help='results.mcap of a run')
    report.add_argument('--output', type=Path, help='HTML file (default: beside the results)')
    report.add_argument(
        '--recording', type=Path, help='the recording it came from; adds its EMG, if it has any'
    )
    report.set_defaults(handler=_report)

    import_command.add_to(commands)
    model_command.add_to(commands)
    compare_command.add_to(commands)
    opensim_command.add_to(commands)
    emg_command.add_to(commands)
    journal_command.add_to(commands)
    planning_command.add_to(commands)
    study_command.add_to(commands)
    urdf_command.add_to(commands)
    return parser


def _demo(options: argparse.Namespace) -> int:
    return _run(
        argparse.Namespace(
            bag=options.bags / DEMO_BAG,
            output=options.output,
            rate=1.0,
            station='station_1',
            offline=False,
            visualize=options.visualize,
            record_visualization=False,
        )
    )


def _run(options: argparse.Namespace) -> int:
    began = time.monotonic()
    output = options.output or Path('out') / options.bag.stem
    visualize = options.visualize or options.record_visualization
    if options.offline and visualize:
        raise SessionError('--offline starts no node, hence there is nothing to visualize')
    if options.offline:
        from lifting_cli.offline import run_offline

        results = run_offline(options.bag, output, options.station)
        run = 'offline'
    else:
        with (
            stopped_by_signals(),
            node_processes(output / 'logs', options.station, visualize) as processes,
        ):
            # Loads while the nodes do.
            from lifting_cli.session import RunOptions, run_online

            outcome = run_online(
                RunOptions(
                    options.bag,
                    output,
                    rate=options.rate,
                    station=options.station,
                    visualize=visualize,
                    record_visualization=options.record_visualization,
                ),
                processes=processes,
            )
        results = outcome.results
        run = f'online at {options.rate:g} times real time'
        print(f'ready to play after {outcome.ready - began:.1f} s')
    began = time.monotonic()
    # Loads for long: the graph need not wait for it.
    from lifting_cli.recording_summary import summarise
    from lifting_report.results import RunFacts, write_report

    facts = RunFacts(run, options.bag.name, summarise(options.bag).start, options.bag)
    page = write_report(results, output / 'report.html', facts)
    print(f'results {results}')
    print(f'report  {page} ({time.monotonic() - began:.1f} s)')
    return 0


def _play(options: argparse.Namespace) -> int:
    from lifting_cli.transport.keyboard import space_bar_pauses
    from lifting_cli.transport.play_options import PlayControl, PlayOptions
    from lifting_cli.transport.player import play

    os.environ.update(discovery())
    control = PlayControl(paused=options.start_paused)
    signal.signal(signal.SIGTERM, lambda *_: control.stop())
    signal.signal(signal.SIGINT, lambda *_: control.stop())
    play_options = PlayOptions(
        options.bag,
        rate=options.rate,
        loop=options.loop,
        start=options.start,
        namespace=options.station,
        start_paused=options.start_paused,
        plate_blocks=options.plate_blocks,
        wait_for=dict.fromkeys(options.wait_for, 1),
        wait_timeout=options.wait_timeout,
    )
    with space_bar_pauses(control) as listening:
        if listening:
            print('the space bar pauses and resumes')
        report = play(play_options, control, print)
    total = sum(report.messages.values())
    print(
        f'{total} messages in {report.wall_time:.2f} s; late by '
        f'{1e3 * report.lateness_p50:.2f} ms (median), {1e3 * report.lateness_p99:.2f} ms (p99)'
    )
    if not report.acknowledged:
        print('some subscribers have not acknowledged all messages', file=sys.stderr)
        return 1
    return 0


def _record(options: argparse.Namespace) -> int:
    from lifting_cli.transport.recorder import RecordControl, RecordOptions, record

    os.environ.update(discovery())
    control = RecordControl()
    signal.signal(signal.SIGTERM, lambda *_: control.stop())
    signal.signal(signal.SIGINT, lambda *_: control.stop())
    report = record(
        RecordOptions(options.output, topics=tuple(options.topics), duration=options.duration),
        control,
        print,
    )
    for topic, count in sorted(report.messages.items()):
        print(f'{count:8d}  {topic}')
    return 0


def _report(options: argparse.Namespace) -> int:
    from lifting_cli.recording_summary import summarise
    from lifting_report.results import RunFacts, write_report

    output = options.output or options.results.with_name('report.html')
    bag = options.recording
    facts = RunFacts() if bag is None else RunFacts(
        recording=bag.name, start=summarise(bag).start, bag=bag)  # fmt: skip
    page = write_report(options.results, output, facts)
    print(page)
    return 0


if __name__ == '__main__':
    sys.exit(main())
