# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write docs/in_vivo.md and its figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from benchmarks.in_vivo_postures import Posture
from benchmarks.muscle_in_vivo import (
    BAGS,
    EQUIVALENT,
    FORMS,
    PLACES,
    ROOT,
    SQUAT,
    STOOP,
    BagRow,
    InVivo,
)
from matplotlib.figure import Figure

from human_model.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PAGE: Final = ROOT / 'docs' / 'in_vivo.md'
FIGURE: Final = ROOT / 'docs' / 'figures' / 'in_vivo_postures.svg'
COLUMNS: Final = (*FORMS, EQUIVALENT)
#: Bodies whose joints are drawn as lines: spine and head, leg, arm.
LINES: Final = (
    ('femur_r', 'lumbar5', 'torso', 'head'),
    ('femur_r', 'tibia_r', 'talus_r', 'toes_r'),
    ('humerus_r', 'ulna_r', 'hand_r'),
)
TEMPLATE: Final = ROOT / 'docs' / 'data' / 'in_vivo_template.md'


def write_page(found: InVivo, bags: dict[tuple[str, str], BagRow]) -> None:
    """Write page and figure.

    Parameters
    ----------
    found
        The tasks.
    bags
        The measured lifts of the bags, by bag and form.
    """
    PAGE.write_text(
        TEMPLATE.read_text(encoding='utf-8').format(
            pressures=_pressures(found),
            equivalent=EQUIVALENT,
            order=_order(found),
            variants=_variants(found),
            anchors=_anchors(found),
            bags=_bags(bags),
        ),
        encoding='utf-8',
    )
    _draw(found)


def _table(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ['---'] * len(header), *rows]
    return '\n'.join(f'| {" | ".join(line)} |' for line in lines)


def _pressures(found: InVivo) -> str:
    rows = []
    for name, task in found.file['tasks'].items():
        for place in PLACES if PLACES[0] in task else PLACES[:1]:
            loads = found.loads[name, place]
            words = f'{name}, {place}' if PLACES[0] in task else name
            values = [f'{found.pressure(name, place, form):.2f}' for form in COLUMNS]
            lean, moment = f'{loads.posture.lean:.0f}', f'{loads.moment:.0f}'
            rows.append([words, lean, moment, f'{task["pressure"]:.2f}', *values])
    for place in PLACES:
        errors = [f'**{found.rmse(place, form):.2f}**' for form in COLUMNS]
        rows.append([f'root mean square error, {place}', '', '', '', *errors])
    header = ['task', 'lean [°]', 'net moment at L5-S1 [N·m]', 'Wilke et al. [MPa]', *COLUMNS]
    return _table(header, rows)


def _order(found: InVivo) -> str:
    kept = [form for form in COLUMNS if found.order_kept(form)]
    lost = [form for form in COLUMNS if form not in kept]
    text = 'The measured order, more with a round back than with bent knees, is kept by: '
    return f'{text}{", ".join(kept) or "none"}; not by: {", ".join(lost) or "none"}.'


def _variants(found: InVivo) -> str:
    names = [name for name in found.solvers if name not in ('OpenSim', 'sacrum')]
    rows = [[name, *(f'{found.rmse(place, name):.2f}' for place in PLACES)] for name in names]
    return _table(['variant', *PLACES], rows)


def _anchors(found: InVivo) -> str:
    l1, l5 = found.names.index('l1_l2'), found.names.index('l5_s1')

    def load(task: str, form: str, joint: int) -> float:
        return float(found.loads[task, 'near'].compression[form][joint])

    def more(task: str, form: str) -> float:
        return load(task, form, l1) - load('standing', form, l1)

    rows = [
        [
            'increase at L1-L2, flexed by 53° against 33°', '1.4',
            *(f'{more("flexed by 53", f) / more("flexed by 33", f):.2f}' for f in FORMS),
        ],
        [
            'L5-S1, round back against knees bent, near', '1.04 or 0.96',
            *(f'{load(STOOP, f, l5) / load(SQUAT, f, l5):.2f}' for f in FORMS),
        ],
        [
            'increase at L1-L2, 20 kg held close in front against at the sides', 'above 2',
            *(
                f'{more("20 kg held close", f) / more("20 kg carried at the sides", f):.1f}'
                for f in FORMS
            ),
        ],
    ]  # fmt: skip
    return _table(['ratio', 'measured', *FORMS], rows)


def _bags(bags: dict[tuple[str, str], BagRow]) -> str:
    rows = [
        [
            bag, form, f'{row.compression:.0f}', f'{row.equivalent:.0f}', f'{row.shear:.0f}',
            f'{row.upper:.0f}', f'{row.unassigned:.0f}', f'{row.reserve:.1f}',
            f'{row.bad} ({row.spine_bad})',
        ]
        for bag in BAGS
        for form in FORMS
        for row in [bags[bag, form]]
    ]  # fmt: skip
    header = [
        'bag', 'form', 'compression L5-S1 [N]', f'{EQUIVALENT} [N]', 'anterior shear L5-S1 [N]',
        'compression L4-L5 [N]', 'constraint [%]', 'reserve [N·m]',
        'samples not good (of L5-S1)',
    ]  # fmt: skip
    return _table(header, rows)


def _draw(found: InVivo) -> None:
    tasks = list(found.file['tasks'])
    figure = Figure(figsize=(2.0 * len(tasks), 2.8))
    for axes, name in zip(figure.subplots(1, len(tasks)), tasks, strict=True):
        for place, colour in zip(PLACES, ('tab:blue', 'tab:orange'), strict=True):
            if (name, place) in found.loads:
                _stick(axes, found, found.loads[name, place].posture, colour)
        axes.set(xlim=(-0.75, 0.95), ylim=(-0.05, 1.85), aspect='equal')
        axes.set_title(name.replace(', ', '\n').replace(' from', '\nfrom'), fontsize=8)
        axes.axis('off')
    figure.tight_layout()
    figure.savefig(FIGURE, metadata={'Date': None})


def _stick(axes: Axes, found: InVivo, posture: Posture, colour: str) -> None:
    """Draw a posture, forward to the right, the ankles at 0."""
    origin = posture.ankle

    def points(bodies: tuple[str, ...]) -> Array:
        rows = [found.model.body_index(body) for body in bodies]
        places: Array = posture.state.joint_position[rows] - origin
        return places

    for bodies in LINES:
        line = points(bodies)
        axes.plot(line[:, 0], line[:, 1], color=colour, linewidth=1.5)
    head = points(('head',))[0]
    axes.plot(head[0], head[1] + 0.12, 'o', color=colour, markersize=8, fillstyle='none')
    if posture.crate is not None:
        crate = posture.crate - origin
        axes.plot(crate[0], crate[1], 's', color=colour, markersize=6)
