# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift compare-emg`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser(
        'compare-emg', help='lay the EMG of a recorded lift beside the computed activations'
    )
    parser.add_argument('bag', type=Path, help='rosbag2 recording with the topic emg')
    parser.add_argument('--lift', type=int, default=1, help='number of the lift (default: 1)')
    parser.add_argument(
        '--mvc', type=_mvc, action='append', default=[], metavar='CHANNEL=VALUE',
        help='envelope in the maximum voluntary contraction, in the unit of the channel',
    )  # fmt: skip
    parser.add_argument(
        '--channel', type=_channel, action='append', default=[], metavar='CHANNEL=NAME',
        help='muscle and side of a channel, for example EMG1=BF_r',
    )  # fmt: skip
    parser.add_argument('--out', type=Path, help='folder (default: out/emg/<bag>)')
    parser.set_defaults(handler=_run)


def _channel(text: str) -> tuple[str, str]:
    name, equals, value = text.partition('=')
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f'{text!r} is not CHANNEL=...')
    return name, value


def _mvc(text: str) -> tuple[str, float]:
    name, value = _channel(text)
    try:
        return name, float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f'{text!r}: {value!r} is not a number') from None


def _run(options: argparse.Namespace) -> int:
    from lifting_cli.compare_emg import (
        NUMBERS,
        PAGE,
        CompareEmgOptions,
        compare_recorded_emg,
        table,
    )

    output = options.out or Path('out') / 'emg' / options.bag.stem
    matches = compare_recorded_emg(
        CompareEmgOptions(
            options.bag,
            output,
            lift=options.lift,
            mvc=dict(options.mvc),
            channels=dict(options.channel),
        )
    )
    print(table(matches))
    print(f'curves  {output / PAGE}')
    print(f'numbers {output / NUMBERS}')
    return 0
