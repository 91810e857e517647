# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps that say which content a step of the set-up was last done for."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path


def digest(files: Iterable[Path], *facts: str) -> str:
    """Return a hash over the facts and the names and contents of the files."""
    total = hashlib.sha256('\0'.join(facts).encode())
    for path in sorted(files):
        total.update(f'\0{path.name}\0'.encode())
        total.update(path.read_bytes())
    return total.hexdigest()


class Stamp:
    """The stamp of one step, a file that holds the digest of the step's inputs.

    Parameters
    ----------
    path : Path
        File of the stamp.
    value : str
        Digest of the present inputs.
    """

    def __init__(self, path: Path, value: str) -> None:
        self.path = path
        self.value = value

    def is_current(self) -> bool:
        """Tell whether the step was completed for the present inputs."""
        return self.path.exists() and self.path.read_text() == self.value

    def write(self) -> None:
        """Note that the step is complete."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(self.value)
