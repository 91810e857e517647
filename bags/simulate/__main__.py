# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write the simulated recordings: `python -m bags.simulate [--output FOLDER] [TASK ...]`."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from bags.simulate.recordings import Session
from bags.simulate.tasks import load_tasks


def main() -> None:
    """Write all or the named recordings; existing ones are replaced."""
    stage, tasks = load_tasks()
    names = ['static_trial', *(task.name for task in tasks)]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('tasks', nargs='*', metavar='TASK', help=', '.join(names))
    parser.add_argument('--output', type=Path, default=Path(__file__).resolve().parents[1])
    arguments = parser.parse_args()
    unknown = set(arguments.tasks) - set(names)
    if unknown:
        parser.error(f'unknown task {sorted(unknown)}; there are {", ".join(names)}')
    wanted = arguments.tasks or names
    session = Session(stage)
    for name in wanted:
        folder = arguments.output / name
        if folder.exists():
            shutil.rmtree(folder)
        if name == 'static_trial':
            session.write_static(arguments.output)
        else:
            session.write_lift(arguments.output, next(t for t in tasks if t.name == name))
        size = sum(file.stat().st_size for file in folder.iterdir())
        print(f'{folder}: {size / 1e6:.2f} MB')


if __name__ == '__main__':
    main()
