# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write the tables of L5-S1 peaks in docs/validation.md: ours, the dissertation's, six studies.

The recordings in bags/ are run offline into out/figures, as for the figures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from human_model.constants import GRAVITY
from human_model.tables import read_file
from lifting_cli.offline import run_offline
from lifting_report import results_curves as curves
from lifting_report.compared import peak
from lifting_report.report_data import SpineCurves
from lifting_report.results_file import Results, read_results, seconds
from muscle_analyzer.core.loads.disc_frame import DiscOption, disc_parameters

DOCS = Path(__file__).parent
ROOT = DOCS.parent
PAGE = DOCS / 'validation.md'
STUDIES = DOCS / 'data' / 'l5_s1_studies.csv'
COLUMNS = 'box_mass lift study body_mass compression compression_per_mass shear shear_per_mass'
#: Recordings of the dissertation's tasks, and what sort of lift each is.
TASKS = {
    'symmetric_7kg': 'symmetric',
    'asymmetric_7kg': 'asymmetric',
    'symmetric_12kg': 'symmetric',
    'symmetric_max': 'symmetric',
}
WORDS = {'measured': 'recorded', 'predicted': 'optimal'}
BEGIN, END = '<!-- {}: begin, by docs/peaks_table.py -->', '<!-- {}: end -->'


@dataclass(frozen=True)
class OurPeak:
    """One lift of ours at its peaks.

    Attributes
    ----------
    lift : {'symmetric', 'asymmetric'}
    source : {'measured', 'predicted'}
    body_mass, box_mass : float
        [kg].
    compression, shear, lateral : float
        Peaks [N]; NaN without a good sample.
    why_not : str
        Why there are none; empty if there are.
    lean : float
        Of L5-S1 to C7 against the vertical at the peak compression [deg].
    reach : float
        Horizontal distance of the box from L5-S1 then [m].
    moment, box_moment : float
        Net forward bending moment then, and the part of the hand forces in it [N m].
    vertebral : (float, float)
        Compression and anterior shear then in the frame of the vertebra [N].
    mismatch : float
        Net moment from above against from below, rms over the lift [N m].
    """

    lift: str
    source: str
    body_mass: float
    box_mass: float
    compression: float = math.nan
    shear: float = math.nan
    lateral: float = math.nan
    why_not: str = ''
    lean: float = math.nan
    reach: float = math.nan
    moment: float = math.nan
    box_moment: float = math.nan
    vertebral: tuple[float, float] = (math.nan, math.nan)
    mismatch: float = math.nan


def our_peaks(results: dict[str, Results]) -> list[OurPeak]:
    """Return the peaks of all tasks, recorded and optimal.

    Parameters
    ----------
    results : dict of str to Results
        By name of the recording in `TASKS`.
    """
    return [
        _our_peak(results[name], lift, source) for name, lift in TASKS.items() for source in WORDS
    ]


def _our_peak(results: Results, lift: str, source: str) -> OurPeak:
    (entry,) = results.lifts.values()
    known = (lift, source, results.subject.mass, results.task.box_mass)
    motion_message = entry.single['predicted_lift' if source == 'predicted' else 'measured_lift']
    if source == 'predicted' and motion_message.report.status != 0:
        return OurPeak(*known, why_not=motion_message.report.message)
    message = entry.blocks['spine_load', source]
    spine = curves.spine_curves(message, seconds(entry.single['measured_lift'].header.stamp))
    compression, _ = peak(spine, 'compression')
    k = int(np.nanargmax(np.where(spine.solved, spine.compression, np.nan)))
    _, motion = curves.window(motion_message)
    lean, reach, box_moment = _posture(motion, k)
    moments = np.asarray(message.net_moment, np.float64).reshape(-1, 3)
    return OurPeak(
        *known, compression, peak(spine, 'anterior_shear')[0], peak(spine, 'lateral_shear')[0],
        lean=lean, reach=reach, moment=abs(float(moments[k, 1])), box_moment=box_moment,
        vertebral=_vertebral(spine, k),
        mismatch=curves.root_mean_square(message.moment_difference),
    )  # fmt: skip


def _posture(motion: Any, k: int) -> tuple[float, float, float]:
    """Return lean [deg], reach [m] and the forward bending moment of the hand forces [N m]."""
    point = {name: motion.points[k, j] for j, name in enumerate(motion.point_names)}
    trunk = point['c7'] - point['l5_s1']
    lean = math.degrees(math.atan2(math.hypot(trunk[0], trunk[1]), trunk[2]))
    reach = motion.box_position[k] - point['l5_s1']
    moment = np.sum(
        [
            np.cross(point[f'hand_{side}'] - point['l5_s1'], motion.hand_force[k, j])
            for j, side in enumerate('rl')
        ],
        axis=0,
    )
    return lean, math.hypot(reach[0], reach[1]), float(moment[1])


def _vertebral(spine: SpineCurves, k: int) -> tuple[float, float]:
    """Return compression and shear at a sample with the disc's normal along the vertebra."""
    if spine.disc_frame != DiscOption.BRUNO2015:
        raise ValueError(f'disc frame {spine.disc_frame}: the tables are made for bruno2015')
    back = -math.radians(disc_parameters(DiscOption.BRUNO2015)['forward_tilt'])
    turned = [
        value[k] * math.cos(back) + math.degrees(slope[k]) * math.sin(back)
        for value, slope in ((spine.compression, spine.compression_per_degree),
                             (spine.anterior_shear, spine.anterior_shear_per_degree))
    ]  # fmt: skip
    return turned[0], turned[1]


def peaks_table(ours: list[OurPeak]) -> str:
    """Return the table of all peaks, by mass of the box."""
    rows: list[tuple[tuple[float, bool, int], list[str]]] = []
    for order, row in enumerate(read_file(STUDIES, COLUMNS, sourced=True)):
        place = (row.number('box_mass'), row['lift'] == 'asymmetric', order)
        rows.append((place, [row[column] for column in COLUMNS.split()]))
    for order, entry in enumerate(ours, len(rows)):
        place = (round(entry.box_mass, 1), entry.lift == 'asymmetric', order)
        forces = (entry.compression, entry.shear)
        cells = [f'**{value:.0f}** | {value / entry.body_mass:.1f}' for value in forces]
        if entry.why_not:
            cells = [f'{entry.why_not.partition(":")[0]} | ', ' | ']
        rows.append((place, [
            f'{entry.box_mass:.3g}', entry.lift, f'**here, {WORDS[entry.source]}**',
            f'{entry.body_mass:g}', *cells,
        ]))  # fmt: skip
    head = ('box [kg]', 'lift', 'study', 'body mass [kg]', 'peak compression [N]', '[N/kg]',
            'peak anterior shear [N]', '[N/kg]')  # fmt: skip
    return _table(head, [row for _, row in sorted(rows, key=lambda pair: pair[0])])


def reasons_table(ours: list[OurPeak]) -> str:
    """Return the table of what makes our peaks: posture, moment, disc frame."""
    head = (
        'lift', 'trunk leans [°]', 'box from L5-S1 [m]', 'net moment [N·m]',
        'of it by the hands [N·m]', 'a box held still there [N·m]',
        'compression per moment [1/m]',
        'compression, shear along the vertebra [N]', 'peak lateral shear [N]',
        'moment above against below, rms [N·m]',
    )  # fmt: skip
    rows = [
        [
            f'{entry.lift} {entry.box_mass:.3g} kg, {WORDS[entry.source]}', f'{entry.lean:.0f}',
            f'{entry.reach:.2f}', f'{entry.moment:.0f}', f'{entry.box_moment:.0f}',
            f'{entry.box_mass * GRAVITY * entry.reach:.0f}',
            f'{entry.compression / entry.moment:.1f}',
            f'{entry.vertebral[0]:.0f}, {entry.vertebral[1]:.0f}'.replace('-', '−'),
            f'{entry.lateral:.0f}'.replace('-', '−'), f'{entry.mismatch:.0f}',
        ]
        for entry in ours if not entry.why_not
    ]  # fmt: skip
    return _table(head, rows)


def _table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    lines = [f'| {" | ".join(head)} |', '|---' * len(head) + '|']
    return '\n'.join(lines + [f'| {" | ".join(row)} |' for row in rows])


def parts(ours: list[OurPeak]) -> dict[str, str]:
    """Return the written parts of the page by name."""
    return {'peaks': peaks_table(ours), 'reasons': reasons_table(ours)}


def with_parts(page: str, new: dict[str, str]) -> str:
    """Return a page with its written parts replaced; raise ValueError if a mark is missing."""
    for name, text in new.items():
        begin, end = BEGIN.format(name), END.format(name)
        before, found, rest = page.partition(begin)
        _, closed, after = rest.partition(end)
        if not (found and closed):
            raise ValueError(f'{PAGE.name}: the marks of {name!r} are missing')
        page = f'{before}{begin}\n\n{text}\n\n{end}{after}'
    return page


def main() -> None:
    """Run the recordings and write the tables."""
    results = {
        name: read_results(run_offline(ROOT / 'bags' / name, ROOT / 'out' / 'figures' / name))
        for name in TASKS
    }
    ours = our_peaks(results)
    PAGE.write_text(with_parts(PAGE.read_text(encoding='utf-8'), parts(ours)), encoding='utf-8')
    print(PAGE)


if __name__ == '__main__':
    main()
