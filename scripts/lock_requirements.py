# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve requirements/*.in to exact versions in requirements/*.txt.

Run it with the oldest supported Python (3.11) after a change of a .in file:
``python3.11 scripts/lock_requirements.py``. The groups build on each other, so a package is
pinned once, in the first group that needs it. ``tests/test_packaging.py`` checks the result.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

REQUIREMENTS = Path(__file__).resolve().parents[1] / 'requirements'
GROUPS = ('runtime', 'build', 'dev')
HEADER = (
    '# SPDX-FileCopyrightText: 2026 The lift monitor authors\n'
    '# SPDX-License-Identifier: Apache-2.0\n'
    '# Written by scripts/lock_requirements.py from {name}.in: do not edit.\n'
)


def resolve(inputs: list[Path], constraints: str) -> dict[str, str]:
    """Return name -> version of everything pip would install for the input files."""
    with tempfile.NamedTemporaryFile('w', suffix='.txt') as constraint_file:
        constraint_file.write(constraints)
        constraint_file.flush()
        command = [
            sys.executable,
            '-m',
            'pip',
            'install',
            '--quiet',
            '--dry-run',
            '--ignore-installed',
            '--report',
            '-',
            '--constraint',
            constraint_file.name,
        ]
        for path in inputs:
            command += ['--requirement', str(path)]
        report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    found = {}
    for item in report['install']:
        name = re.sub(r'[-_.]+', '-', item['metadata']['name']).lower()
        found[name] = item['metadata']['version']
    return found


def main() -> None:
    """Write one lock file a group."""
    inputs = [REQUIREMENTS / f'{name}.in' for name in GROUPS]
    everything = resolve(inputs, '')
    constraints = ''.join(f'{key}=={value}\n' for key, value in everything.items())
    written: set[str] = set()
    for index, name in enumerate(GROUPS):
        needed = resolve(inputs[: index + 1], constraints)
        new = {key: value for key, value in needed.items() if key not in written}
        lines = [f'{key}=={value}\n' for key, value in sorted(new.items())]
        (REQUIREMENTS / f'{name}.txt').write_text(HEADER.format(name=name) + ''.join(lines))
        written |= set(new)


if __name__ == '__main__':
    main()
