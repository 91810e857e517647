# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The page of two lifts side by side: one HTML file that needs nothing else."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

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
from lifting_report.html_parts import Card, absent, amount, cards, figure, table, text
from lifting_report.model_limits import MODEL_LIMITS
from lifting_report.page_style import CSS, SCRIPT
from lifting_report.report_data import Missing, Pair

#: Activations that differ by less are called equal: one hundredth of a muscle's strength.
_EQUAL_ACTIVATION = 0.01


def build_comparison(lifts: Two, created: str, path: Path) -> Path:
    """Write the page; return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(render(lifts, created), encoding='utf-8')
    return path


def render(lifts: Two, created: str) -> str:
    """Return the page as HTML text.

    Parameters
    ----------
    lifts : two of ComparedLift
        The first is the one that the second is compared with.
    created : str
        Date and time.
    """
    title = f'Two lifts: {lifts[0].name} and {lifts[1].name}'
    body = ''.join((
        _head(lifts, title, created), _cards(lifts), _findings(lifts), _spine(lifts),
        _feet(lifts), _muscles(lifts),
        '<h2>Limits of the models</h2><ul class="plain">'
        + ''.join(f'<li>{text(limit)}</li>' for limit in MODEL_LIMITS) + '</ul>'))  # fmt: skip
    return (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{text(title)}</title><style>{CSS}</style></head>'
        f'<body><main>{body}</main><script>{SCRIPT}</script></body></html>\n'
    )


def _head(lifts: Two, title: str, created: str) -> str:
    simulated = [lift.name for lift in lifts if lift.header.simulated]
    banner = (
        '<p class="simulated"><strong>SIMULATED RECORDING.</strong> '
        f'{text(" and ".join(simulated))}: made by a simulation, not recorded from a person. '
        'What differs says what the models do with two such motions, not what people are '
        'exposed to.</p>'
        if simulated else '')  # fmt: skip
    rows = [
        [f'<strong>{text(lift.name)}</strong>', text(lift.header.description), _person(lift),
         amount(lift.header.box_mass, 'kg', 1), amount(lift.lift.duration, 's', 2),
         f'{lift.header.lifts_per_day:g}', text(lift.header.recording), text(lift.lift.lift_id)]
        for lift in lifts
    ]  # fmt: skip
    head = ('lift', 'task', 'person', 'box', 'lasts', 'lifts a day', 'recording', 'number')
    return (
        f'<h1>{text(title)}</h1>' + banner + table(head, rows, (3, 4, 5)) + _unequal(lifts)
        + '<p class="note">Recorded is what the person did, optimal the lift with the least joint '
        'effort for the same person, box, feet and places. Differences are those of the second '
        f'lift against the first. {text(created)}, version {text(lifts[0].header.version)}.</p>'
    )  # fmt: skip


def _person(lift: ComparedLift) -> str:
    header = lift.header
    return (
        f'{text(header.subject)}, {text(header.sex)}, {amount(header.mass, "kg", 1)}, '
        f'{amount(header.stature, "m", 2)}'
    )


def _unequal(lifts: Two) -> str:
    """Say what else differs between the lifts than the task."""
    first, second = (lift.header for lift in lifts)
    different = [
        words for words, a, b in (
            ('the persons', (first.subject, first.mass), (second.subject, second.mass)),
            ('the masses of the boxes', first.box_mass, second.box_mass),
            ('the loads a day, and so perhaps the shear limit', first.lifts_per_day,
             second.lifts_per_day),
            ('the frames of the disc', _disc_frames(lifts[0]), _disc_frames(lifts[1])))
        if a != b
    ]  # fmt: skip
    if not different:
        return ''
    return f'<p class="absent"><strong>Not equal:</strong> {text("; ".join(different))}.</p>'


def _disc_frames(lift: ComparedLift) -> list[str]:
    return sorted({part.disc_frame for part in lift.lift.spine.present().values()})


def _cards(lifts: Two) -> str:
    items = []
    limits = published_limits()
    for component, name in COMPONENTS.items():
        peaks = [_peak(lift, 'measured', component)[0] for lift in lifts]
        rows = [
            (f'{text(lift.name)}, optimal', amount(_peak(lift, 'predicted', component)[0], 'N'))
            for lift in lifts
        ]
        beyond = [
            line for value in peaks for line in limits[component] if value >= line.value
        ]  # fmt: skip
        level = 'hazard' if any(line.hazardous for line in beyond) else 'action' if beyond else ''
        items.append(Card(
            f'Peak L5-S1 {text(name)}, recorded',
            f'{amount(peaks[0])} <small>and</small> {amount(peaks[1], "N")}',
            _difference(peaks, component), level, tuple(rows)))  # fmt: skip
    return cards(items)


def _peak(lift: ComparedLift, source: str, component: str) -> tuple[float, float]:
    return peak(getattr(lift.lift.spine, source), component)


def _difference(peaks: list[float], component: str) -> str:
    """Say by how much the second peak is higher or lower."""
    first, second = peaks
    if math.isnan(first) or math.isnan(second):
        return 'not comparable: a peak is missing'
    if component == 'lateral_shear':
        return 'size, either way; no published limit'
    change = second - first
    word = 'higher' if change > 0.0 else 'lower'
    return f'{amount(abs(change), "N")} ({abs(change) / first:.0%}) {word}'


def _findings(lifts: Two) -> str:
    """Say in words what differs most."""
    second = lifts[1].name
    points = []
    for source, word in SOURCES.items():
        peaks = [_peak(lift, source, 'compression')[0] for lift in lifts]
        shears = [_peak(lift, source, 'anterior_shear')[0] for lift in lifts]
        if not any(math.isnan(value) for value in (*peaks, *shears)):
            points.append(
                f'{word.capitalize()}: {second} has a peak compression '
                f'{_difference(peaks, "compression")} and a peak anterior shear '
                f'{_difference(shears, "anterior_shear")}.')  # fmt: skip
        points += _muscle_findings(lifts, source, word)
    return '<h2>What differs</h2><ul class="plain">' + ''.join(
        f'<li>{point}</li>' for point in points) + '</ul>'  # fmt: skip


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
        f'higher peak activation in {text(lifts[1].name)}, {fewer} a lower one; most up '
        f'{text(high[1])} ({_signed(high[0])}), most down {text(low[1])} ({_signed(low[0])}).'
    ]
    uneven = max(sides, key=lambda pair: -1.0 if math.isnan(pair[0]) else abs(pair[0]))
    if not math.isnan(uneven[0]):
        points.append(
            f'{word.capitalize()}: {text(lifts[1].name)} is most uneven at {text(uneven[1])}, '
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


def _spine(lifts: Two) -> str:
    frames = sorted({frame for lift in lifts for frame in _disc_frames(lift)})
    caption = (
        'Force of S1 on L5 in the frame of the disc '
        f'({text(", ".join(frames)) or "none"}). Lateral shear: positive where S1 pushes L5 to '
        'the left; no limit is published for it. Gaps: samples that did not solve. '
        + _reasons(lifts, 'spine')
    )
    limits = published_limits()
    beyond = [
        [text(COMPONENTS[component]), f'{text(line.name)}, {amount(line.value, "N")}', word,
         *(_beyond(lift, source, component, line.value) for lift in lifts)]
        for component, lines in limits.items() for line in lines
        for source, word in SOURCES.items()
    ]  # fmt: skip
    names = [text(lift.name) for lift in lifts]
    return (
        '<h2>Load on L5-S1</h2>'
        + _drawn(lifts, 'spine', 'L5-S1 compression and shear',
                 lambda: figures.spine_loads(lifts, limits, 'spine'), caption)
        + '<h3>Peaks</h3>' + table(
            ('load', 'lift', names[0], 'per body mass', 'at', names[1], 'per body mass', 'at',
             'difference', ''), _peak_rows(lifts), (2, 3, 4, 5, 6, 7, 8, 9))
        + '<h3>How long a limit is reached or exceeded</h3>'
        + table(('load', 'limit', 'lift', *names), beyond, (3, 4))
        + '<p class="note">Share of the solved samples. “At”: course of the lift. Lateral shear: '
        'largest size, with its sign.</p>'
    )  # fmt: skip


def _beyond(lift: ComparedLift, source: str, component: str, limit: float) -> str:
    return amount(share_beyond(getattr(lift.lift.spine, source), component, limit), '%')


def _peak_rows(lifts: Two) -> list[list[str]]:
    rows = []
    for component, name in COMPONENTS.items():
        for source, word in SOURCES.items():
            row = [text(name), word]
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


def _feet(lifts: Two) -> str:
    caption = (
        'Of the ground on each foot. A lift predicted in the sagittal plane loads both '
        'feet alike. ' + _reasons(lifts, 'ground')
    )
    return '<h2>Ground reaction</h2>' + _drawn(
        lifts, 'ground', 'Vertical force on each foot',
        lambda: figures.foot_forces(lifts, 'feet'), caption)  # fmt: skip


def _muscles(lifts: Two) -> str:
    parts = ['<h2>Muscles</h2>']
    for source, word in SOURCES.items():
        title = f'Muscle activations, {word} lifts'
        missing = [getattr(lift.lift.activations, source) for lift in lifts]
        if all(isinstance(part, Missing) for part in missing):
            parts.append(absent(title, '; '.join(part.reason for part in missing)))
            continue
        parts.append(figure(
            title, figures.muscle_activations(lifts, source, f'muscles-{source}'),
            'Mean over the fascicles of the muscle on that side. Gaps: samples that did not '
            f'solve{_gaps(lifts, source)}. ' + _reasons(lifts, 'activations')))  # fmt: skip
    names = [text(lift.name) for lift in lifts]
    head = ('muscle', 'side', f'{names[0]}, recorded', f'{names[1]}, recorded', 'difference',
            f'{names[0]}, optimal', f'{names[1]}, optimal', 'difference')  # fmt: skip
    rows = []
    for group in muscle_groups():
        for side in SIDES:
            row = [text(group.name), side]
            for source in SOURCES:
                peaks = [_muscle_peak(lift, source, group, side) for lift in lifts]
                row += [
                    amount(peaks[0], digits=2),
                    amount(peaks[1], digits=2),
                    _signed(peaks[1] - peaks[0]),
                ]
            rows.append(row)
    return ''.join(parts) + '<h3>Peak activations</h3>' + table(head, rows, range(2, 8))


def _gaps(lifts: Two, source: str) -> str:
    """Say how many samples of each lift are gaps, in which a peak may be hidden."""
    counts = [
        f'{np.count_nonzero(~part.solved)} of {part.solved.size} in {text(lift.name)}'
        for lift in lifts
        if not isinstance(part := getattr(lift.lift.activations, source), Missing)
        and not part.solved.all()
    ]
    return f' ({", ".join(counts)}; a peak in one is not seen)' if counts else ''


def _drawn(lifts: Two, part: str, title: str, draw: Callable[[], str], caption: str) -> str:
    """Return a figure, or the reasons if no lift has what it shows."""
    pairs: list[Pair[Any]] = [getattr(lift.lift, part) for lift in lifts]
    if not any(pair.present() for pair in pairs):
        return absent(title, _reasons(lifts, part))
    return figure(title, draw(), caption.strip())


def _reasons(lifts: Two, part: str) -> str:
    return ' '.join(
        f'{text(lift.name)}, {SOURCES[source]}: not available, {text(reason)}.'
        for lift in lifts for source, reason in getattr(lift.lift, part).missing().items()
    )  # fmt: skip
