# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which sample is good for what."""

import pytest

from human_model.report import SolveReport, SolveStatus
from muscle_analyzer.core.loads import sample_status

WEAK = SolveReport(SolveStatus.MUSCLE_TOO_WEAK, 'muscles too weak', primal_residual=1e-9)
LUMBAR = ('L5_S1_Flex_Ext', 'L5_S1_Lat_Bending')


@pytest.mark.parametrize('status', [s for s in SolveStatus if s is not SolveStatus.OK])
def test_no_tracker_status_but_ok_gives_a_good_sample(status):
    issue = sample_status.tracker_issue(int(status))
    lost = status is SolveStatus.TRACKER_NO_GROUND_FORCE
    assert issue.status is (
        SolveStatus.MUSCLE_NO_GROUND_FORCE if lost else SolveStatus.MUSCLE_BAD_INPUT
    )
    assert status.name in issue.message
    assert sample_status.overall_report(SolveReport(), (issue,), ()).status is issue.status


def test_tracker_status_that_is_not_known_is_bad_input():
    issue = sample_status.tracker_issue(199)
    assert issue.status is SolveStatus.MUSCLE_BAD_INPUT
    assert '199' in issue.message
    assert sample_status.tracker_issue(0) == sample_status.Issue()


def test_first_issue_decides_and_all_are_told():
    issues = (
        sample_status.Issue(),
        sample_status.Issue(SolveStatus.MUSCLE_TRANSFER_FAILED, 'not converged'),
        sample_status.Issue(SolveStatus.MUSCLE_BAD_INPUT, 'no place'),
    )
    report = sample_status.overall_report(WEAK, issues, ['feet off'])
    assert report.status is SolveStatus.MUSCLE_TRANSFER_FAILED
    assert report.message == 'not converged; no place; muscles too weak; feet off'
    assert report.primal_residual == WEAK.primal_residual


def test_weak_hip_leaves_the_spine_load_good():
    good = sample_status.spine_report(WEAK, ('hip_adduction_r',), LUMBAR)
    assert good.ok and good.message == 'muscles too weak'
    bad = sample_status.spine_report(WEAK, ('hip_adduction_r', 'L5_S1_Flex_Ext'), LUMBAR)
    assert bad.status is SolveStatus.MUSCLE_TOO_WEAK
    assert bad.message.startswith('L5-S1 not balanced at L5_S1_Flex_Ext')


@pytest.mark.parametrize('status', [SolveStatus.MUSCLE_NOT_CONVERGED, *sample_status.UNUSABLE])
def test_spine_load_needs_all_but_strong_muscles(status):
    report = SolveReport(status, 'why')
    assert sample_status.spine_report(report, ('hip_adduction_r',), LUMBAR) == report


def test_torques_need_no_muscles():
    for status in (SolveStatus.MUSCLE_NOT_CONVERGED, SolveStatus.MUSCLE_TOO_WEAK):
        assert sample_status.torque_status(SolveReport(status)) is SolveStatus.OK
    for status in sample_status.UNUSABLE:
        assert sample_status.torque_status(SolveReport(status)) is status


def test_block_tells_its_worst_sample_and_how_many():
    reports = [SolveReport(), WEAK, SolveReport(SolveStatus.MUSCLE_BAD_INPUT, 'no place'), WEAK]
    worst = sample_status.worst_report(reports, [5.0, 5.5, 6.0, 6.5])
    assert worst.status is SolveStatus.MUSCLE_BAD_INPUT
    assert worst.message == '3 of 4 samples, worst at 1.00 s: no place'
    assert sample_status.worst_report([WEAK], [5.0]) == WEAK
    fine = SolveReport(message='at full activation: x', primal_residual=1e-8)
    assert sample_status.worst_report([SolveReport(), fine], [5.0, 5.5]) == fine
