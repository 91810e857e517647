# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The page of two lifts side by side: one HTML file that needs nothing else."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from lifting_report.compared import (
    COMPONENTS,
    SIDES,
    SOURCES,
    ComparedLift,
    Two,
    muscle_course,
    peak,
    published_limits,
    share_beyond,
)
from lifting_report.figures import compared_figures as figures
from lifting_report.figures.loads import MuscleGroup, muscle_groups
from lifting_report.pages import Card, Drawing, amount, drawing, render_page, write_page
from lifting_report.report_data import Missing

#: Activations that differ by less are called equal: one hundredth of a muscle's strength.
_EQUAL_ACTIVATION = 0.01


def build_comparison(lifts: Two, created: str, path: Path) -> Path:
    """Write the page; return its path."""
    return write_page(path, render(lifts, created))


def render(lifts: Two, created: str) -> str:
    """Return the page as HTML text.

    Parameters
    ----------
    lifts : two of ComparedLift
        The second is compared with the first.
    created : str
        Date and time.
    """
    return render_page(
        'compared.html',
        title=f'Two lifts: {lifts[0].name} and {lifts[1].name}',
        created=created,
        lifts=lifts,
        simulated=[lift.name for lift in lifts if lift.header.simulated],
        unequal=_unequal(lifts),
        peak_cards=_cards(lifts),
        findings=_findings(lifts),
        spine=_spine(lifts),
        peaks=_peak_rows(lifts),
        beyond=_beyond_rows(lifts),
        feet=_feet(lifts),
        muscles=_muscles(lifts),
        activations=_activation_rows(lifts),
    )


def _unequal(lifts: Two) -> list[str]:
    """Return the differences of the lifts apart from the task."""
    first, second = (lift.header for lift in lifts)
    compared = (
        ('the persons', (first.subject, first.mass), (second.subject, second.mass)),
        ('the masses of the boxes', first.box_mass, second.box_mass),
        (
            'the loads a day, and possibly the shear limit',
            first.lifts_per_day,
            second.lifts_per_day,
        ),
        ('the frames of the disc', _disc_frames(lifts[0]), _disc_frames(lifts[1])),
    )
    return [words for words, a, b in compared if a != b]


def _disc_frames(lift: ComparedLift) -> list[str]:
    return sorted({part.disc_frame for part in lift.lift.spine.present().values()})


def _cards(lifts: Two) -> list[Card]:
    items = []
    limits = published_limits()
    for component, name in COMPONENTS.items():
        peaks = [_peak(lift, 'measured', component)[0] for lift in lifts]
        rows = tuple(
            (f'{lift.name}, optimal', amount(_peak(lift, 'predicted', component)[0], 'N'))
            for lift in lifts
        )
        beyond = [line for value in peaks for line in limits[component] if value >= line.value]
        level = 'hazard' if any(line.hazardous for line in beyond) else 'action' if beyond else ''
        items.append(
            Card(
                f'Peak L5-S1 {name}, recorded',
                f'{amount(peaks[0])} and {amount(peaks[1], "N")}',
                _difference(peaks, component),
                level,
                rows,
            )
        )
    return items


def _peak(lift: ComparedLift, source: str, component: str) -> tuple[float, float]:
    return peak(getattr(lift.lift.spine, source), component)


def _difference(peaks: list[float], component: str) -> str:
    """Return the difference of the second peak from the first, in words."""
    first, second = peaks
    if math.isnan(first) or math.isnan(second):
        return 'not comparable: a peak is missing'
    if component == 'lateral_shear':
        return 'magnitude; no published limit'
    change = second - first
    word = 'higher' if change > 0.0 else 'lower'
    return f'{amount(abs(change), "N")} ({abs(change) / first:.0%}) {word}'


def _findings(lifts: Two) -> list[str]:
    """Return the largest differences in words."""
    second = lifts[1].name
    points = []
    for source, word in SOURCES.items():
        peaks = [_peak(lift, source, 'compression')[0] for lift in lifts]
        shears = [_peak(lift, source, 'anterior_shear')[0] for lift in lifts]
        if not any(math.isnan(value) for value in (*peaks, *shears)):
            points.append(
                f'{word.capitalize()}: {second} has a peak compression '
                f'{_difference(peaks, "compression")} and a peak anterior shear '
                f'{_difference(shears, "anterior_shear")}.'
            )
        points += _muscle_findings(lifts, source, word)
    return points


def _muscle_findings(lifts: Two, source: str, word: str) -> list[str]:
    changes, sides = [], []
    for group in muscle_groups():
        peaks = [[_muscle_peak(lift, source, group, side) for side in SIDES] for lift in lifts]
        for k, side in enumerate(SIDES):
            change = peaks[1][k] - peaks[0][k]
            if not math.isnan(change):
                changes.append((change, f'{group.name.lower()} {side}'))
        sides.append((peaks[1][0] - peaks[1][1], group.name.lower()))
    if not changes:
        return []
    more = sum(change > _EQUAL_ACTIVATION for change, _ in changes)
    fewer = sum(change < -_EQUAL_ACTIVATION for change, _ in changes)
    high, low = max(changes), min(changes)
    points = [
        f'{word.capitalize()}: of {len(changes)} muscles (left and right apart) {more} have a '
        f'higher peak activation in {lifts[1].name}, {fewer} a lower one; most up '
        f'{high[1]} ({_signed(high[0])}), most down {low[1]} ({_signed(low[0])}).'
    ]
    uneven = max(sides, key=lambda pair: -1.0 if math.isnan(pair[0]) else abs(pair[0]))
    if not math.isnan(uneven[0]):
        points.append(
            f'{word.capitalize()}: {lifts[1].name} is most uneven at {uneven[1]}, '
            f'whose peak on the left is {abs(uneven[0]):.2f} '
            f'{"higher" if uneven[0] > 0.0 else "lower"} than on the right.')  # fmt: skip
    return points


def _muscle_peak(lift: ComparedLift, source: str, group: MuscleGroup, side: str) -> float:
    course = muscle_course(lift, source, group, side)
    return math.nan if isinstance(course, Missing) else course.peak


def _signed(value: float) -> str:
    if math.isnan(value):
        return '–'
    return f'{value:+.2f}'.replace('-', '−')


def _spine(lifts: Two) -> Drawing:
    frames = sorted({frame for lift in lifts for frame in _disc_frames(lift)})
    caption = (
        f'Force of S1 on L5 in the frame of the disc ({", ".join(frames) or "none"}). Lateral '
        'shear: positive if S1 pushes L5 to the left; no limit is published for it. Gaps: samples '
        f'that did not solve. {_reasons(lifts, "spine")}'
    )
    limits = published_limits()
    return _drawn(
        lifts,
        'spine',
        'L5-S1 compression and shear',
        lambda: figures.spine_loads(lifts, limits, 'spine'),
        caption,
    )


def _beyond_rows(lifts: Two) -> list[list[str]]:
    """Return the fraction of each lift at or above each limit."""
    return [
        [
            COMPONENTS[component],
            f'{line.name}, {amount(line.value, "N")}',
            word,
            *(
                amount(share_beyond(getattr(lift.lift.spine, source), component, line.value), '%')
                for lift in lifts
            ),
        ]
        for component, lines in published_limits().items()
        for line in lines
        for source, word in SOURCES.items()
    ]


def _peak_rows(lifts: Two) -> list[list[str]]:
    rows = []
    for component, name in COMPONENTS.items():
        for source, word in SOURCES.items():
            row = [name, word]
            peaks = []
            for lift in lifts:
                largest, at = _peak(lift, source, component)
                peaks.append(largest)
                row += [
                    amount(largest, 'N'),
                    amount(largest / lift.header.mass, 'N/kg', 1),
                    amount(at, '%'),
                ]
            change = peaks[1] - peaks[0]
            share = change / peaks[0] if component != 'lateral_shear' else math.nan
            rows.append([*row, amount(change, 'N'), amount(100.0 * share, '%', 1)])
    return rows


def _feet(lifts: Two) -> Drawing:
    return _drawn(
        lifts,
        'ground',
        'Vertical force on each foot',
        lambda: figures.foot_forces(lifts, 'feet'),
        'Force of the ground on each foot. A lift predicted in the sagittal plane loads both feet '
        f'equally. {_reasons(lifts, "ground")}',
    )


def _muscles(lifts: Two) -> list[Drawing]:
    return [
        _drawn_muscles(lifts, source, f'Muscle activations, {word} lifts')
        for source, word in SOURCES.items()
    ]


def _drawn_muscles(lifts: Two, source: str, title: str) -> Drawing:
    parts = [getattr(lift.lift.activations, source) for lift in lifts]
    if all(isinstance(part, Missing) for part in parts):
        return Drawing(title, '', '; '.join(part.reason for part in parts))
    caption = (
        'Mean over the fascicles of the muscle on that side. Gaps: samples that did not solve'
        f'{_gaps(lifts, source)}. {_reasons(lifts, "activations")}'
    )
    svg = figures.muscle_activations(lifts, source, f'muscles-{source}')
    return Drawing(title, svg, caption.strip())


def _activation_rows(lifts: Two) -> list[list[str]]:
    rows = []
    for group in muscle_groups():
        for side in SIDES:
            row = [group.name, side]
            for source in SOURCES:
                peaks = [_muscle_peak(lift, source, group, side) for lift in lifts]
                row += [
                    amount(peaks[0], digits=2),
                    amount(peaks[1], digits=2),
                    _signed(peaks[1] - peaks[0]),
                ]
            rows.append(row)
    return rows


def _gaps(lifts: Two, source: str) -> str:
    """Return the number of missing samples of each lift, in words."""
    counts = [
        f'{np.count_nonzero(~part.solved)} of {part.solved.size} in {lift.name}'
        for lift in lifts
        if not isinstance(part := getattr(lift.lift.activations, source), Missing)
        and not part.solved.all()
    ]
    return f' ({", ".join(counts)}; a peak in a gap is not found)' if counts else ''


def _drawn(lifts: Two, part: str, title: str, draw: Callable[[], str], caption: str) -> Drawing:
    """Return a figure, or the reasons if no lift has the part."""
    missing = not any(getattr(lift.lift, part).present() for lift in lifts)
    return drawing(title, draw, caption.strip(), _reasons(lifts, part) if missing else '')


def _reasons(lifts: Two, part: str) -> str:
    return ' '.join(
        f'{lift.name}, {SOURCES[source]}: not available, {reason}.'
        for lift in lifts for source, reason in getattr(lift.lift, part).missing().items()
    )  # fmt: skip
