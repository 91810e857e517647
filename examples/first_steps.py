# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded lift and its optimum: loads on L5-S1, figures, and a lift without a recording.

    python examples/first_steps.py [BAG] [FOLDER]

The figures are written to FOLDER, `out/first_steps` by default.
"""

from __future__ import annotations

import sys
from pathlib import Path

import lifting


def main(bag: Path, folder: Path) -> None:
    """Analyze the first lift of a recording, and plan a lift of another person."""
    folder.mkdir(parents=True, exist_ok=True)
    lift = lifting.track(lifting.load_recording(bag)).lifts[0]
    best = lifting.predict(lift)
    recorded, optimal = lifting.analyze(lift), lifting.analyze(best)
    print(lifting.assess(recorded, optimal).summary)
    for name, load in (('recorded', recorded), ('optimal', optimal)):
        print(f'{name}: peak compression {load.l5_s1.peak_compression:.0f} N')
        load.plot().savefig(folder / f'{name}.png')

    person = lifting.Subject('S2', 'female', 62.0, 1.68, 31.0)
    task = lifting.PlanTask('shelf', 8.0, (0.24, 0.30, 0.13), (0.40, 0.0, 0.07), (0.55, 0.0, 0.97))
    planned = lifting.analyze(lifting.predict(task, person))
    print(f'planned, 8 kg: peak compression {planned.l5_s1.peak_compression:.0f} N')
    heaviest = lifting.maximum_weight(task, person)
    print(f'largest mass for the same task: {heaviest.box_mass:.1f} kg')


if __name__ == '__main__':
    main(
        Path(sys.argv[1] if len(sys.argv) > 1 else 'bags/symmetric_12kg'),
        Path(sys.argv[2] if len(sys.argv) > 2 else 'out/first_steps'),
    )
