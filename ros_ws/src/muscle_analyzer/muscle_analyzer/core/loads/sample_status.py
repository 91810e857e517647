# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What a sample is good for: muscle forces, L5-S1 load and joint torques are judged apart.

Muscles that are too weak at the hip make the muscle forces of a sample doubtful.  They do not
make its L5-S1 load useless, which hangs on what balances the lumbar joints, and joint torques do
not hang on muscles at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from human_model.report import SolveReport, SolveStatus

#: Statuses of samples that have no motion or no forces to compute with.
UNUSABLE = (
    SolveStatus.MUSCLE_TRANSFER_FAILED,
    SolveStatus.MUSCLE_BAD_INPUT,
    SolveStatus.MUSCLE_NO_GROUND_FORCE,
)


@dataclass(frozen=True)
class Problem:
    """What is wrong with a sample before it is solved.

    Attributes
    ----------
    status
        OK: nothing.
    message
        In words.
    """

    status: SolveStatus = SolveStatus.OK
    message: str = ''


#: Nothing is wrong.
NONE = Problem()


def tracker_problem(status: int) -> Problem:
    """Give what a sample's tracker status means for its analysis; only 0 is usable."""
    if status == 0:
        return NONE
    known = status in SolveStatus.__members__.values()
    message = f'motion tracker: {SolveStatus(status).name if known else f"status {status}"}'
    if status == SolveStatus.TRACKER_NO_GROUND_FORCE:
        return Problem(SolveStatus.MUSCLE_NO_GROUND_FORCE, message)
    return Problem(SolveStatus.MUSCLE_BAD_INPUT, message)


def overall(report: SolveReport, problems: Sequence[Problem], notes: Sequence[str]) -> SolveReport:
    """Give the report of a sample: the first problem decides, then the optimisation.

    Parameters
    ----------
    report
        Of the optimisation.
    problems
        Of the sample, the gravest first.
    notes
        What else is to be known.
    """
    found = [problem for problem in problems if problem.status is not SolveStatus.OK]
    if not found and not notes:
        return report
    texts = [problem.message for problem in found] + [report.message, *notes]
    return replace(
        report,
        status=found[0].status if found else report.status,
        message='; '.join(text for text in texts if text),
    )


def spine(report: SolveReport, unbalanced: Sequence[str], lumbar: Sequence[str]) -> SolveReport:
    """Give the report of the L5-S1 load.

    Parameters
    ----------
    report
        Of the sample.
    unbalanced
        Coordinates whose muscles are too weak.
    lumbar
        Coordinates of the lumbar joints: those whose muscles cross L5-S1.
    """
    if report.status is not SolveStatus.MUSCLE_TOO_WEAK:
        return report
    weak = [name for name in unbalanced if name in lumbar]
    if not weak:
        return replace(report, status=SolveStatus.OK)
    return replace(report, message=f'L5-S1 not balanced at {", ".join(weak)}; {report.message}')


def torques(report: SolveReport) -> SolveStatus:
    """Give the status of the joint torques, which need motion and forces but no muscles."""
    return report.status if report.status in UNUSABLE else SolveStatus.OK


def worst(reports: Sequence[SolveReport], time: Sequence[float]) -> SolveReport:
    """Give the report of a block: that of its worst sample, with how many others are not good.

    Parameters
    ----------
    reports
        One per sample.
    time
        Of the samples [s].
    """
    if len(reports) == 1:
        return reports[0]
    k = max(
        range(len(reports)), key=lambda i: (int(reports[i].status), reports[i].primal_residual)
    )
    bad = sum(not report.ok for report in reports)
    if not bad:
        return reports[k]
    where = f'{bad} of {len(reports)} samples, worst at {time[k] - time[0]:.2f} s'
    return replace(reports[k], message=f'{where}: {reports[k].message}')
