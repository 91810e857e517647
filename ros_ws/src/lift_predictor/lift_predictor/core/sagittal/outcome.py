# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What became of a solve: the solver's outcome and the dense check, as one status."""

from __future__ import annotations

from typing import Final

from human_model.report import SolveStatus
from lift_predictor.core.sagittal.verify import Verification
from lift_predictor.core.solvers.solution import Status
from lift_predictor.core.solvers.solver_run import SolverRun

TIMED_OUT: Final = (Status.TIME_LIMIT, 'Maximum_WallTime_Exceeded')
INFEASIBLE: Final = (Status.INFEASIBLE, 'Infeasible_Problem_Detected')
"""In our solver's words and in IPOPT's."""


def judge(best: SolverRun, check: Verification | None) -> tuple[SolveStatus, str]:
    """Return the status of the best run and its check, and what it means in words.

    Parameters
    ----------
    best : SolverRun
        The run that is kept.
    check : Verification or None
        On the dense grid; None if the run did not converge.
    """
    if best.converged and check is not None and check.passed:
        return SolveStatus.OK, f'optimal from the start "{best.start}"'
    if best.converged and check is not None:
        return (
            SolveStatus.PREDICTOR_VERIFICATION_FAILED,
            f'between the nodes constraints are violated: {check.failures()}',
        )
    detail = f'largest violation: {best.violated or "none"} ({best.violation:.3g})'
    if best.status in TIMED_OUT:
        return SolveStatus.PREDICTOR_TIME_LIMIT, f'time limit reached; {detail}'
    if best.status in INFEASIBLE:
        return SolveStatus.PREDICTOR_INFEASIBLE, f'no feasible motion was found; {detail}'
    return SolveStatus.PREDICTOR_NOT_CONVERGED, f'not solved: {best.status}; {detail}'
