# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift import`: C3D, or TRC with MOT or STO, becomes a recording."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

_NEGATIVE_AXIS = re.compile('-[xyz]')


def add_to(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser('import', help='turn C3D or TRC + MOT/STO into a recording')
    parser.add_argument('markers', type=Path, help='.c3d or .trc')
    parser.add_argument('--forces', type=Path, help='.mot or .sto that belongs to a .trc')
    parser.add_argument('--subject', type=Path, required=True, help='subject file (YAML)')
    parser.add_argument('--static', type=Path, help='static trial for the calibration')
    parser.add_argument('--output', type=Path, required=True, help='recording to create')
    parser.add_argument(
        '--label-prefix',
        metavar='NAME',
        help='subject whose markers are taken, where labels are NAME:MARKER of several subjects',
    )
    group = parser.add_argument_group('conventions', 'facts that the recording does not settle')
    group.add_argument('--units', choices=('m', 'cm', 'mm'))
    group.add_argument('--vertical', metavar='AXIS', help='for example +y or -z')
    group.add_argument('--facing', metavar='AXIS', help='for example +x or -x')
    group.add_argument('--floor-height', type=float, default=0.0, help='[m]')
    group.add_argument(
        '--mass-tolerance',
        type=float,
        default=0.05,
        help='accepted deviation of the weight on the plates from the mass (default: 0.05)',
    )
    group.add_argument(
        '--plate',
        action='append',
        default=[],
        metavar='NAME=LOAD',
        help='right, left, both (feet), box or none, for example 1=right or 3=none',
    )
    parser.set_defaults(handler=_import)


def with_axes(words: Sequence[str]) -> list[str]:
    """Join an option and its axis -x, -y or -z, which argparse takes for another option."""
    joined: list[str] = []
    for word in words:
        if _NEGATIVE_AXIS.fullmatch(word) and joined and joined[-1].startswith('--'):
            joined[-1] += f'={word}'
        else:
            joined.append(word)
    return joined


def _plates(entries: Sequence[str]) -> dict[str, str]:
    """Return the load of each plate from entries ``NAME=LOAD``."""
    from lifting_recordings.exceptions import ConventionError

    plates = {}
    for entry in entries:
        name, _, load = entry.partition('=')
        if not name or not load:
            raise ConventionError(f'--plate {entry}: write NAME=LOAD, for example 1=right')
        plates[name] = load
    return plates


def _import(options: argparse.Namespace) -> int:
    from lifting.importing import import_recording
    from lifting_recordings.alignment import ConventionOptions
    from lifting_recordings.importer import ImportOptions

    report = import_recording(
        ImportOptions(
            options.markers,
            options.subject,
            options.output,
            forces=options.forces,
            static=options.static,
            conventions=ConventionOptions(
                units=options.units,
                vertical=options.vertical,
                facing=options.facing,
                floor_height=options.floor_height,
                mass_tolerance=options.mass_tolerance,
                plates=_plates(options.plate),
            ),
            label_prefix=options.label_prefix,
        )
    )
    for statement in report.statements:
        print(statement)
    total = sum(report.messages.values())
    print(f'{report.bag}: {total} messages, {report.duration:.2f} s')
    return 0
