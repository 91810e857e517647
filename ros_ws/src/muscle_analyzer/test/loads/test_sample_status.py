# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which sample is good for what."""

import pytest

from human_model.report import SolveReport, SolveStatus
from muscle_analyzer.core.loads import sample_status as verdict

WEAK = SolveReport(SolveStatus.MUSCLE_TOO_WEAK, 'muscles too weak', primal_residual=1e-9)
LUMBAR = ('L5_S1_Flex_Ext', 'L5_S1_Lat_Bending')


@pytest.mark.parametrize('status', [s for s in SolveStatus if s is not SolveStatus.OK])
def test_no_tracker_status_but_ok_gives_a_good_sample(status):
    problem = verdict.tracker_problem(int(status))
    lost = status is SolveStatus.TRACKER_NO_GROUND_FORCE
    assert problem.status is (
        SolveStatus.MUSCLE_NO_GROUND_FORCE if lost else SolveStatus.MUSCLE_BAD_INPUT
    )
    assert status.name in problem.message
    assert verdict.overall(SolveReport(), (problem,), ()).status is problem.status


def test_tracker_status_that_is_not_known_is_bad_input():
    problem = verdict.tracker_problem(199)
    assert problem.status is SolveStatus.MUSCLE_BAD_INPUT
    assert '199' in problem.message
    assert verdict.tracker_problem(0) == verdict.Problem()


def test_first_problem_decides_and_all_are_told():
    problems = (
        verdict.Problem(),
        verdict.Problem(SolveStatus.MUSCLE_TRANSFER_FAILED, 'not converged'),
        verdict.Problem(SolveStatus.MUSCLE_BAD_INPUT, 'no place'),
    )
    report = verdict.overall(WEAK, problems, ['feet off'])
    assert report.status is SolveStatus.MUSCLE_TRANSFER_FAILED
    assert report.message == 'not converged; no place; muscles too weak; feet off'
    assert report.primal_residual == WEAK.primal_residual


def test_weak_hip_leaves_the_spine_load_good():
    good = verdict.spine(WEAK, ('hip_adduction_r',), LUMBAR)
    assert good.ok and good.message == 'muscles too weak'
    bad = verdict.spine(WEAK, ('hip_adduction_r', 'L5_S1_Flex_Ext'), LUMBAR)
    assert bad.status is SolveStatus.MUSCLE_TOO_WEAK
    assert bad.message.startswith('L5-S1 not balanced at L5_S1_Flex_Ext')


@pytest.mark.parametrize('status', [SolveStatus.MUSCLE_NOT_CONVERGED, *verdict.UNUSABLE])
def test_spine_load_needs_all_but_strong_muscles(status):
    report = SolveReport(status, 'why')
    assert verdict.spine(report, ('hip_adduction_r',), LUMBAR) == report


def test_torques_need_no_muscles():
    for status in (SolveStatus.MUSCLE_NOT_CONVERGED, SolveStatus.MUSCLE_TOO_WEAK):
        assert verdict.torques(SolveReport(status)) is SolveStatus.OK
    for status in verdict.UNUSABLE:
        assert verdict.torques(SolveReport(status)) is status


def test_block_tells_its_worst_sample_and_how_many():
    reports = [SolveReport(), WEAK, SolveReport(SolveStatus.MUSCLE_BAD_INPUT, 'no place'), WEAK]
    worst = verdict.worst(reports, [5.0, 5.5, 6.0, 6.5])
    assert worst.status is SolveStatus.MUSCLE_BAD_INPUT
    assert worst.message == '3 of 4 samples, worst at 1.00 s: no place'
    assert verdict.worst([WEAK], [5.0]) == WEAK
    fine = SolveReport(message='at full activation: x', primal_residual=1e-8)
    assert verdict.worst([SolveReport(), fine], [5.0, 5.5]) == fine
