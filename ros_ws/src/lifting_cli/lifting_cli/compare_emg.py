# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare-emg`: the EMG of a recorded lift beside the activations computed for it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from human_model.exceptions import HumanModelError
from lifting_cli.graph_errors import SessionError
from lifting_cli.recorded_lifts import recorded_lifts
from lifting_report.emg_page import build_emg_page
from lifting_report.recorded_emg import recorded_emg
from muscle_analyzer.core.emg.comparison import EmgMatch, compare_emg
from muscle_analyzer.core.emg.envelopes import OWN_MAXIMUM, normalised_envelopes
from muscle_analyzer.core.exceptions import MuscleAnalyzerError
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

NUMBERS, PAGE = 'emg.json', 'emg.html'


@dataclass(frozen=True)
class CompareEmgOptions:
    """What to compare.

    Attributes
    ----------
    bag : Path
        Recording with the topic `emg`.
    output : Path
        Folder of the numbers.
    lift : int
        Number of the lift in the recording, from 1.
    mvc : mapping of str to float
        Envelope in the maximum voluntary contraction of channels, in their units.
    channels : mapping of str to str
        In place of a channel's name, one that says muscle and side.
    """

    bag: Path
    output: Path
    lift: int = 1
    mvc: Mapping[str, float] = field(default_factory=dict)
    channels: Mapping[str, str] = field(default_factory=dict)


def compare_recorded_emg(options: CompareEmgOptions) -> tuple[EmgMatch, ...]:
    """Compare the EMG of a lift with its computed activations; write numbers and a page.

    Raises
    ------
    BagError
        If the recording cannot be read or has no EMG.
    SessionError
        If it has no such lift, or EMG and lift cannot be compared.
    """
    recorded = recorded_lifts(options.bag)
    emg = recorded_emg(options.bag, recorded.start)
    found = recorded.lift(options.lift)
    try:
        envelopes = normalised_envelopes(emg, options.mvc)
        analyzer = MuscleAnalyzer(recorded.subject)
        lift = found.lift
        analysis = analyzer.analyze(lift.motion, lift.lift_id, 'measured', found.status)
        analysis = replace(analysis, time=analysis.time - recorded.start)
        matches = compare_emg(envelopes, analysis, options.channels)
    except (MuscleAnalyzerError, HumanModelError) as error:
        raise SessionError(str(error)) from error
    options.output.mkdir(parents=True, exist_ok=True)
    text = json.dumps([_plain(match) for match in matches], indent=1)
    (options.output / NUMBERS).write_text(text + '\n', encoding='utf-8')
    title = f'{options.bag.name}, {lift.lift_id}'
    build_emg_page(matches, title, options.output / PAGE)
    return matches


def _plain(match: EmgMatch) -> dict[str, object]:
    """Return a match as plain data; what is missing is null."""
    plain: dict[str, object] = {}
    for name, value in vars(match).items():
        if isinstance(value, np.ndarray):
            plain[name] = [float(number) for number in value]
        elif isinstance(value, float):
            plain[name] = value if np.isfinite(value) else None
        else:
            plain[name] = value
    return plain


def table(matches: tuple[EmgMatch, ...]) -> str:
    """Return one line a channel, and what the numbers mean."""
    lines = [
        f'{"channel":16}{"muscle":22}{"side":>5}{"correlation":>13}{"phase [ms]":>12}'
        f'{"[% of lift]":>13}{"then":>8}{"rms":>8}  note'
    ]
    for match in matches:
        lines.append(
            f'{match.channel:16}{match.muscle:22}{match.side.upper():>5}'
            f'{_number(match.correlation, ".2f"):>13}{_number(1e3 * match.lag, "+.0f"):>12}'
            f'{_number(match.lag_percent, "+.1f"):>13}'
            f'{_number(match.best_correlation, ".2f"):>8}{match.rms:8.3f}  {match.note}'.rstrip()
        )
    lines.append(
        'phase: shift of the activation against the EMG at which they correlate best (then), '
        'positive if the activation is later'
    )
    own = [match.channel for match in matches if match.normalised_by == OWN_MAXIMUM]
    if own:
        lines.append(
            f'{", ".join(own)}: divided by the {OWN_MAXIMUM}, no MVC was given: sizes (rms) say '
            'nothing, only the course does'
        )
    return '\n'.join(lines)


def _number(value: float, layout: str) -> str:
    return format(value, layout) if np.isfinite(value) else '-'
