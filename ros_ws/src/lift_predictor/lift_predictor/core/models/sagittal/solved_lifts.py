# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Library of solved lifts: initial guesses from other persons and tasks.

`data/solved_lifts.csv` holds the free control values [rad] of 7 control points per joint; the file
is made by `benchmarks/solved_lifts.py`. They lead to minima that generated initial
guesses do not find.
"""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np

from human_model.tables import read_table
from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.problem.run import Start

N_CONTROL: Final = 7
"""Control points of the library's splines."""
_DENSE: Final = 41


@cache
def solved_lifts() -> tuple[Array, ...]:
    """Read the library: control values (5, 6) [rad] of each lift.

    Raises
    ------
    TableError
        A value is no number.
    TaskError
        A lift does not have all control points.
    """
    columns = ' '.join(('lift', *JOINTS))
    lifts: dict[str, list[tuple[float, ...]]] = {}
    for row in read_table('lift_predictor', 'solved_lifts.csv', columns):
        lifts.setdefault(row['lift'], []).append(row.numbers(*JOINTS))
    n_free = RestToRestSpline(N_CONTROL).n_free
    for name, points in lifts.items():
        if len(points) != n_free:
            raise TaskError(
                f'solved_lifts.csv: lift {name} has {len(points)} points, not {n_free}'
            )
    return tuple(np.array(points) for points in lifts.values())


def library_starts(spline: RestToRestSpline) -> tuple[Start, ...]:
    """Return the library's lifts as initial guesses on a spline."""
    source = RestToRestSpline(N_CONTROL)
    s = np.linspace(0.0, 1.0, _DENSE)
    starts = []
    for number, control in enumerate(solved_lifts(), 1):
        own = control if spline == source else spline.fit(s, source.basis(s) @ control)
        starts.append(Start(f'solved lift {number}', own, near=True))
    return tuple(starts)
