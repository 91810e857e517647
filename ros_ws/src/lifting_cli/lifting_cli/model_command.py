# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift model`: the file of the musculoskeletal model."""

from __future__ import annotations

import argparse
from typing import Any


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser('model', help='fetch the musculoskeletal model, if it is missing')
    parser.set_defaults(handler=_run)


def _run(_options: argparse.Namespace) -> int:
    from muscle_analyzer.core.exceptions import ModelFileError
    from muscle_analyzer.core.subject.model_file import fetch_lifting_model, lifting_model_path

    try:
        path = lifting_model_path()
    except ModelFileError:
        path = fetch_lifting_model()
    print(path)
    return 0
