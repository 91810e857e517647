# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift urdf`: the skeleton of a person for robotics tools."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from lifting_cli.graph_errors import SessionError


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser('urdf', help="write a person's skeleton as URDF")
    parser.add_argument(
        'subject', type=Path, help='subject file or task file (YAML) with a section subject'
    )
    parser.add_argument('-o', '--output', type=Path, help='URDF file (default: <pseudonym>.urdf)')
    parser.set_defaults(handler=_run)


def _run(options: argparse.Namespace) -> int:
    # Loads for long; the other commands need none of it.
    from human_model.exceptions import HumanModelError
    from human_model.urdf import person_urdf
    from lifting_recordings.subject_file import read_person

    person = read_person(options.subject)
    output = options.output or Path(f'{person.pseudonym}.urdf')
    try:
        text = person_urdf(person)
    except HumanModelError as error:
        raise SessionError(f'{options.subject}: {error}') from error
    try:
        output.write_text(text, encoding='utf-8')
    except OSError as error:
        raise SessionError(f'{output}: cannot be written: {error}') from error
    print(output)
    return 0
