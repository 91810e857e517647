# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Status of a sample, separate for muscle forces, L5-S1 load and joint torques.

Muscles that are too weak at the hip make the muscle forces of a sample doubtful.  Its L5-S1 load
stays valid, because it depends on the muscles at the lumbar joints; joint torques do not depend
on muscles.
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
class Issue:
    """Reason why a sample cannot be solved.

    Attributes
    ----------
    status
        OK if there is none.
    message
    """

    status: SolveStatus = SolveStatus.OK
    message: str = ''


#: Of a usable sample.
NO_ISSUE = Issue()


def tracker_issue(status: int) -> Issue:
    """Return the issue of a sample's tracker status; only 0 is usable."""
    if status == 0:
        return NO_ISSUE
    known = status in SolveStatus.__members__.values()
    message = f'motion tracker: {SolveStatus(status).name if known else f"status {status}"}'
    if status == SolveStatus.TRACKER_NO_GROUND_FORCE:
        return Issue(SolveStatus.MUSCLE_NO_GROUND_FORCE, message)
    return Issue(SolveStatus.MUSCLE_BAD_INPUT, message)


def overall_report(
    report: SolveReport, issues: Sequence[Issue], notes: Sequence[str]
) -> SolveReport:
    """Return the report of a sample: the first issue decides, then the optimisation.

    Parameters
    ----------
    report
        Of the optimisation.
    issues
        Of the sample, the most severe first.
    notes
        Further remarks.
    """
    severe = [issue for issue in issues if issue.status is not SolveStatus.OK]
    if not severe and not notes:
        return report
    texts = [issue.message for issue in severe] + [report.message, *notes]
    return replace(
        report,
        status=severe[0].status if severe else report.status,
        message='; '.join(text for text in texts if text),
    )


def spine_report(
    report: SolveReport, unbalanced: Sequence[str], lumbar: Sequence[str]
) -> SolveReport:
    """Return the report of the L5-S1 load.

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


def torque_status(report: SolveReport) -> SolveStatus:
    """Return the status of the joint torques, which need motion and forces but no muscles."""
    return report.status if report.status in UNUSABLE else SolveStatus.OK


def worst_report(reports: Sequence[SolveReport], time: Sequence[float]) -> SolveReport:
    """Return the report of a block: that of its worst sample, with how many others are not good.

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
