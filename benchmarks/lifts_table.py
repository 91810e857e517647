# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Table of peak L5-S1 loads of the simulated lifts beside those of the dissertation.

`python benchmarks/lifts_table.py`, by hand, in the repository's root. The dissertation's values
(Zaman 2022, chapter IV, predicted lifts of a man of 63.5 kg and 1.69 m) are of other postures than
ours, whose recordings are simulated: the two are put side by side, not fitted to each other.
"""

from __future__ import annotations

import contextlib
import io
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from lifting_cli.offline import run_offline
from lifting_report.results_file import MEASURED, PREDICTED, read_results

BAGS = Path(__file__).resolve().parents[1] / 'bags'
LIFTS = ('symmetric_7kg', 'symmetric_12kg', 'symmetric_max', 'asymmetric_7kg')
#: Peak compression and anterior shear [N].
DISSERTATION = {'symmetric_7kg': (2298.0, 732.0), 'symmetric_12kg': (2390.0, 796.0)}


def peaks(load: Any) -> tuple[float, float, int, int]:
    """Return peak compression and anterior shear [N], and how many samples are good of all."""
    good = np.asarray(load.status) == 0
    if not good.any():
        return float('nan'), float('nan'), 0, good.size
    compression = np.asarray(load.compression)[good].max()
    shear = np.asarray(load.anterior_shear)[good].max()
    return float(compression), float(shear), int(good.sum()), good.size


def row(name: str, source: str, compression: float, shear: float, mass: float, good: str) -> str:
    """Return one line of the table."""
    per_kg = f'{compression / mass:5.1f} | {shear / mass:5.1f}'
    return f'| {name} | {source} | {compression:5.0f} | {shear:5.0f} | {per_kg} | {good} |'


def main() -> None:
    """Run all lifts and print the table (Markdown)."""
    print('| lift | source | compression N | shear N | N/kg | N/kg | good samples |')
    print('|---|---|---|---|---|---|---|')
    for name in LIFTS:
        with tempfile.TemporaryDirectory() as folder:
            with contextlib.redirect_stdout(io.StringIO()):
                path = run_offline(BAGS / name, Path(folder))
            results = read_results(path)
        mass = results.subject.mass
        if name in DISSERTATION:
            print(row(name, 'dissertation', *DISSERTATION[name], mass, ''))
        for source in (MEASURED, PREDICTED):
            for lift in results.lifts.values():
                if ('spine_load', source) not in lift.blocks:
                    reason = lift.single['predicted_lift'].report.message
                    print(f'| {name} | {source} | failed: {reason} |')
                    continue
                load = lift.blocks['spine_load', source]
                compression, shear, good, total = peaks(load)
                print(row(name, source, compression, shear, mass, f'{good} of {total}'))


if __name__ == '__main__':
    main()
