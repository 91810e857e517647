# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift compare`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser(
        'compare', help='lay two lifts side by side: L5-S1 load, feet, muscles left and right'
    )
    parser.add_argument(
        'inputs', type=Path, nargs=2, metavar='LIFT',
        help='rosbag2 recording, or results.mcap of a run (or its folder)',
    )  # fmt: skip
    parser.add_argument(
        '--lifts', type=int, nargs=2, default=(1, 1), metavar=('N', 'M'),
        help='number of the lift in each (default: 1 1)',
    )  # fmt: skip
    parser.add_argument(
        '-o', '--output', type=Path, help='folder (default: out/compare/<first>_<second>)'
    )
    parser.set_defaults(handler=_run)


def _run(options: argparse.Namespace) -> int:
    # Loads for long; the other commands need none of it.
    from lifting_cli.comparison import (
        NUMBERS,
        PAGE,
        CompareLiftsOptions,
        compare_lifts,
        numbers,
        recording_name,
        table,
    )

    first, second = options.inputs
    folder = f'{recording_name(first)}_{recording_name(second)}'
    output = options.output or Path('out') / 'compare' / folder
    lifts = compare_lifts(
        CompareLiftsOptions((first, second), output, (options.lifts[0], options.lifts[1])), print
    )
    print(table(numbers(lifts[0]), numbers(lifts[1])))
    print(f'page    {output / PAGE}')
    print(f'numbers {output / NUMBERS}')
    return 0
