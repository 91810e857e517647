# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift compare-opensim`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser(
        'compare-opensim', help='run OpenSim on a recorded lift and report the differences'
    )
    parser.add_argument('bag', type=Path, help='rosbag2 recording (MCAP or SQLite)')
    parser.add_argument('--lift', type=int, default=1, help='number of the lift (default: 1)')
    parser.add_argument(
        '--at', type=_times, default=(), metavar='T1,T2,...',
        help='instants, from the start of the recording [s] (default: five, evenly)',
    )  # fmt: skip
    parser.add_argument('--every', type=float, metavar='S', help='an instant every so many s')
    parser.add_argument('--out', type=Path, help='folder (default: out/opensim/<bag>)')
    parser.add_argument('--opensim-python', type=Path, help='Python that has the wheel opensim')
    parser.add_argument(
        '--physiology', action='store_true', help="with the muscles' force-length-velocity"
    )
    parser.add_argument(
        '--criterion', choices=('squares', 'cubes', 'min_max'), default='squares',
        help='what this side minimises (OpenSim: squares); what then differs is not compared',
    )  # fmt: skip
    parser.add_argument(
        '--export-only', action='store_true', help='write the files for OpenSim, do not run it'
    )
    parser.set_defaults(handler=_run)


def _times(text: str) -> tuple[float, ...]:
    return tuple(float(part) for part in text.split(','))


def _run(options: argparse.Namespace) -> int:
    from lifting_cli.compare_opensim import CompareOptions, compare_opensim, table

    output = options.out or Path('out') / 'opensim' / options.bag.stem
    result = compare_opensim(
        CompareOptions(
            bag=options.bag,
            output=output,
            lift=options.lift,
            at=options.at,
            every=options.every,
            opensim_python=options.opensim_python,
            physiology=options.physiology,
            export_only=options.export_only,
            criterion=options.criterion,
        ),
        print,
    )
    if result is not None:
        print(table(result))
        print(f'files and numbers: {output}')
    return 0
