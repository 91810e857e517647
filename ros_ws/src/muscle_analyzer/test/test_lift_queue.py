# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Whole lifts in steps: the same numbers as at once, errors reported, nothing lost."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest

from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.lift_queue import SAMPLES, LiftQueue, WaitingLift

NO_TIMES = {'build_time': 0.0, 'solve_time': 0.0}


@pytest.fixture
def finished():
    return []


@pytest.fixture
def queue(box_lift, finished):
    def results(lift, analyzer, analysis):
        assert analyzer is box_lift.analyzer
        yield None
        yield lift, analysis

    return LiftQueue(results, lambda lift, error: finished.append((lift, error)))


@pytest.fixture
def add(box_lift, queue):
    return lambda lift: queue.add(lift, box_lift.analyzer)


@pytest.fixture
def work(queue, finished):
    def work(duration):
        for result in queue.work(duration):
            finished.append(result)

    return work


def waiting(body, name='lift_001', source='measured'):
    return WaitingLift(name, source, 12.0, body, np.zeros(len(body), np.int64))


def assert_equal(ours, whole):
    for field in fields(MuscleAnalysis):
        a, b = getattr(ours, field.name), getattr(whole, field.name)
        if isinstance(b, np.ndarray):
            np.testing.assert_array_equal(a, b, err_msg=field.name)
        elif field.name not in ('reports', 'spine_reports'):
            assert a == b, field.name
    for kind in ('reports', 'spine_reports'):
        for a, b in zip(getattr(ours, kind), getattr(whole, kind), strict=True):
            # Not-a-numbers of unsolved samples are equal as text.
            assert repr(replace(a, **NO_TIMES)) == repr(replace(b, **NO_TIMES))


def test_a_lift_in_steps_has_the_numbers_of_the_lift_at_once(box_lift, queue, add, work, finished):
    """A call without time takes one step; live samples in between change nothing."""
    body = box_lift.body
    whole = box_lift.analyzer.analyze(body, 'lift_001', 'measured', np.zeros(len(body), int))
    add(waiting(body))
    steps = math.ceil(len(body) / SAMPLES)
    for k in range(steps):
        work(0.0)
        box_lift.analyzer.analyze(body[-1 - k])
    for _ in range(2):
        assert len(queue) == 1 and not finished
        work(0.0)
    assert finished
    work(0.0)
    assert not queue
    ((_, ours),) = finished
    assert_equal(ours, whole)


def test_lifts_are_finished_in_their_order(box_lift, queue, add, work, finished):
    body = box_lift.body[:5]
    add(waiting(body, 'lift_001'))
    add(waiting(body, 'lift_001', 'predicted'))
    assert len(queue) == 2
    work(math.inf)
    assert [(lift.lift_id, lift.source) for lift, _ in finished] == [
        ('lift_001', 'measured'), ('lift_001', 'predicted'),
    ]  # fmt: skip
    assert len(queue) == 0


def test_a_lift_that_cannot_be_analysed_is_reported_and_the_next_goes_on(
    box_lift, add, work, finished
):
    body = box_lift.body[:4]
    bad = waiting(body, 'lift_001', 'recorded')
    add(bad)
    add(waiting(body, 'lift_002'))
    work(math.inf)
    assert 'recorded' in str(finished[0][1])
    assert finished[1][0].lift_id == 'lift_002'
    assert len(finished[1][1]) == 4


def test_an_unknown_error_is_not_taken_for_bad_input(add, work, box_lift, monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(MuscleAnalyzer, 'analyze', broken)
    add(waiting(box_lift.body[:2]))
    with pytest.raises(ZeroDivisionError):
        work(0.0)
