# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torques, limits, ground forces and constraint values of a motion by the sagittal model."""

from __future__ import annotations

from dataclasses import dataclass

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline, simpson_weights
from lift_predictor.core.sagittal.grid import CENTRES, Grid
from lift_predictor.core.sagittal.parameters import LiftParameters
from lift_predictor.core.sagittal.report_function import ReportFunction


@dataclass(frozen=True)
class SagittalLoads:
    """What the sagittal model says of n instants.

    Attributes
    ----------
    torque, lower, upper : array, shape (n, 6)
        Generalised forces of the joints and their dynamic limits [N m], both limbs together.
    ground_force : array, shape (n, 2)
        Force of the ground, forward and up [N].
    zmp : array, shape (n,)
        Zero-moment point, forward [m].
    hand_force : array, shape (n, 2)
        Force of the box on both hands [N].
    rows : array, shape (n, n_g)
        Scaled constraints of `node_functions.NODE_ROWS`.
    effort : array, shape (n,)
        Integrand of the first term of equation 2.11.
    centres : array, shape (n, 7, 2)
        Joint centres of `node_functions.CENTRES` [m].
    """

    torque: Array
    lower: Array
    upper: Array
    ground_force: Array
    zmp: Array
    hand_force: Array
    rows: Array
    effort: Array
    centres: Array


def evaluate(
    report: ReportFunction, q: Array, dq: Array, ddq: Array, parameters: LiftParameters
) -> SagittalLoads:
    """Run the model over n instants.

    Parameters
    ----------
    report : ReportFunction
        `LiftOptimiser.report`.
    q, dq, ddq : array, shape (n, 6)
        Joint coordinates [rad], [rad/s], [rad/s^2].
    parameters : LiftParameters
        Person, task and the mass in the hands.
    """
    n = len(q)
    values = report(q, dq, ddq, parameters.box_mass, parameters.pack())
    ground_force = values['ground_force']
    return SagittalLoads(
        torque=values['torque'],
        lower=values['lower'],
        upper=values['upper'],
        ground_force=ground_force,
        zmp=values['ground_moment'][:, 0] / ground_force[:, 1],
        hand_force=values['hand_force'],
        rows=values['rows'],
        effort=values['effort'][:, 0],
        centres=values['centres'].reshape(n, len(CENTRES), 2),
    )


def total_effort(
    report: ReportFunction, grid: Grid, control: Array, parameters: LiftParameters
) -> float:
    """Return the first term of equation 2.11 [s] as the programme integrates it.

    Parameters
    ----------
    report : ReportFunction
        `LiftOptimiser.report`.
    grid : Grid
        Of the solution.
    control : array, shape (n_free, 6)
        Free control values [rad].
    parameters : LiftParameters
        Person, task and the mass in the hands.
    """
    duration = parameters.duration
    loads = evaluate(report, *sample(grid.spline, control, grid.times, duration), parameters)
    return float(duration * simpson_weights(grid.n_nodes) @ loads.effort)


def sample(
    spline: RestToRestSpline, control: Array, s: Array, duration: float
) -> tuple[Array, Array, Array]:
    """Evaluate a spline at normalised times s (n,): q, dq, ddq by real time, (n, 6) each."""
    q, dq, ddq = (spline.basis(s, derivative) @ control for derivative in range(3))
    return q, dq / duration, ddq / duration**2
