# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Two lifts side by side: what the page of a comparison is made of."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from injury_monitor.core.limits import read_limits
from lifting_report.figures.curves import percent
from lifting_report.figures.loads import LimitLine, MuscleGroup
from lifting_report.pages import CRITERIA
from lifting_report.report_data import Activations, Header, LiftReport, Missing, SpineCurves

#: Components of the L5-S1 load: field of `SpineCurves` and its name on the page.
COMPONENTS = {
    'compression': 'compression',
    'anterior_shear': 'anterior shear',
    'lateral_shear': 'lateral shear',
}
SOURCES = {'measured': 'recorded', 'predicted': 'optimal'}
#: In the order of the thesis' chapter V.
SIDES = ('left', 'right')


def curve(spine: SpineCurves, component: str) -> Array:
    """Return a component of the load [N], NaN where no sample solved."""
    values: Array = np.where(spine.solved, getattr(spine, component), np.nan)
    return values


def peak(spine: SpineCurves | Missing, component: str) -> tuple[float, float]:
    """Return the peak [N] and its place in the course of the lift [%]; NaN without samples.

    Lateral shear goes either way: its peak is the largest size, with its sign.
    """
    if isinstance(spine, Missing):
        return np.nan, np.nan
    values = curve(spine, component)
    size = np.abs(values) if component == 'lateral_shear' else values
    if not np.any(np.isfinite(size)):
        return np.nan, np.nan
    k = int(np.nanargmax(size))
    return float(values[k]), float(percent(spine.time)[k])


def share_beyond(spine: SpineCurves | Missing, component: str, limit: float) -> float:
    """Return the share of the solved samples at or above a limit [%]; NaN without samples."""
    if isinstance(spine, Missing) or not np.any(spine.solved):
        return np.nan
    return 100.0 * float(np.mean(getattr(spine, component)[spine.solved] >= limit))


def published_limits() -> dict[str, tuple[LimitLine, ...]]:
    """Return the limits by component of the load; none are published for lateral shear."""
    return {
        component: tuple(
            LimitLine(limit.value, CRITERIA[limit.name], limit.name == 'compression_maximum')
            for limit in read_limits().values()
            if limit.quantity == f'l5_s1_{component}'
        )
        for component in COMPONENTS
    }


@dataclass(frozen=True)
class ComparedLift:
    """One of the two lifts: a short name that the other does not have, who lifted what, how."""

    name: str
    header: Header
    lift: LiftReport


Two = tuple[ComparedLift, ComparedLift]


@dataclass(frozen=True)
class MuscleCourse:
    """Mean activation of a muscle's fascicles on one side over a lift, NaN in gaps."""

    time: Array
    activation: Array

    @property
    def peak(self) -> float:
        """Largest activation; NaN without a solved sample."""
        good = self.activation[np.isfinite(self.activation)]
        return float(good.max()) if good.size else np.nan


def muscle_course(
    compared: ComparedLift, source: str, group: MuscleGroup, side: str
) -> MuscleCourse | Missing:
    """Return the course of one muscle in one lift, or why there is none.

    Parameters
    ----------
    compared : ComparedLift
    source : {'measured', 'predicted'}
    group : MuscleGroup
    side : {'left', 'right'}
    """
    part: Activations | Missing = getattr(compared.lift.activations, source)
    if isinstance(part, Missing):
        return part
    ending = f'_{side[0]}'
    chosen = [
        k for k, name in enumerate(part.muscles)
        if re.search(group.pattern, name) and name.endswith(ending)
    ]  # fmt: skip
    if not chosen:
        return Missing('not in this model')
    mean = part.activation[:, chosen].mean(axis=1)
    return MuscleCourse(part.time, np.where(part.solved, mean, np.nan))
