# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads of a lift against the published limits and the revised NIOSH lifting equation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from injury_monitor.core.assessment import RiskAssessment, assess_lift
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.lifting_geometry import LiftEnd
from injury_monitor.core.limits import limits_for
from injury_monitor.core.loads import ActivationSeries, LiftLoads, TorqueSeries
from injury_monitor.core.rnle_assessment import LiftEnds
from lifting.exceptions import IncompleteLiftError

if TYPE_CHECKING:
    from human_model.task import Work
    from lifting.lift import Lift
    from lifting.loads import Loads


def assess(load: Loads, best: Loads | None = None, work: Work | None = None) -> RiskAssessment:
    """Assess the loads of a lift.

    Parameters
    ----------
    load : Loads
        Of the lift.
    best : Loads, optional
        Of the optimal lift for the same task: gives the avoidable part of the load.
    work : Work, optional
        Frequency of the task; default: that of the recording.

    Raises
    ------
    IncompleteLiftError
        If the loads are of a motion without a lift, or nothing gives the work.
    InjuryMonitorError
        If the two loads belong to different lifts, or a value is out of its range.
    """
    if load.lift is None:
        raise IncompleteLiftError('', 'a lift')
    work = work or load.lift.work
    if work is None:
        raise IncompleteLiftError(load.lift.lift_id, 'the work (lifting.Work)')
    limits = limits_for(work.lifts_per_day)
    optimal = None if best is None else _series(best)
    return assess_lift(
        _assignment(load.lift, work), limits, _series(load), optimal, _ends(load.lift)
    )


def _assignment(lift: Lift, work: Work) -> Assignment:
    box_mass = lift.box_mass if lift.box is None else lift.box.mass
    return Assignment(lift.lift_id, lift.subject.pseudonym, lift.subject.mass, box_mass, work)


def _series(load: Loads) -> LiftLoads:
    a, torques = load.analysis, load.torques
    assert load.lift is not None
    return LiftLoads(
        a.lift_id,
        load.lift.start,
        a.time,
        a.compression,
        a.anterior_shear,
        a.spine_status == 0,
        TorqueSeries(
            torques.time, torques.joint_names, torques.torque, torques.lower, torques.upper,
            torques.status == 0,
        ),
        ActivationSeries(a.time, a.muscle_names, a.activation, a.status == 0),
    )  # fmt: skip


def _ends(lift: Lift) -> LiftEnds:
    window = lift.window
    hands, ankles = (
        np.stack([window.point(f'{name}_r'), window.point(f'{name}_l')], axis=1)
        for name in ('hand', 'ankle')
    )
    first, last = (LiftEnd(hands[k].mean(axis=0), ankles[k]) for k in (0, -1))
    return LiftEnds(first, last)
