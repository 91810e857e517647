# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of the streams: a load is right within 2 %, or its status is not good."""

import pytest
from benchmarks import faults


@pytest.fixture(scope='module')
def clean():
    """Return the result without a fault."""
    return faults.play(faults.recording()[2])


def test_without_a_fault(clean):
    """The peaks that docs/validation.md has."""
    assert clean.assessed == [pytest.approx(4497.0, abs=1.0)]
    assert clean.live == pytest.approx(4506.0, abs=1.0)


def test_the_measure_finds_a_wrong_load(clean):
    """A peak that is 3 % too high in good samples is named."""
    other = faults.Outcome(live=1.03 * clean.live, time=clean.time, load=1.03 * clean.load)
    assert faults.wrong(other, clean)


#: Fault, and whether the lift is still assessed with a good status.
SOME = {
    'box gone 4.4 to 5.4 s': True,
    'box gone 3.9 to 4.9 s': False,
    'box gone until 4.3 s': False,
    'box frozen 4.4 to 5.4 s': True,
    'box stray 30 cm up, 0.2 s': True,
    'box noise 5 mm in the lift': False,
    'one marker frame +0.5 s': True,
    'all back 0.5 s in the lift': False,
    'markers jitter 3 ms': True,
    'markers gone 0.5 s': False,
    'markers gone 50 ms': False,
    'right plate gone 20 ms': False,
}


@pytest.mark.parametrize('name', SOME)
def test_no_wrong_load_looks_good(name, clean):
    outcome = faults.play(faults.CASES[name](list(faults.recording()[2])))
    assert faults.wrong(outcome, clean) == []
    good = [report for report in outcome.reports if report.startswith('0/')]
    assert bool(good) == SOME[name]


@pytest.mark.parametrize(
    'name', ['one marker frame +1e6 s', 'one plate sample +1e6 s', 'one box pose -1e6 s']
)
def test_a_wrong_stamp_costs_no_lift(name, clean):
    """Both lifts after it are assessed, and no frame waits for the end of the recording."""
    outcome = faults.play(faults.CASES[name](list(faults.recording()[2])))
    assert outcome.assessed == [pytest.approx(clean.assessed[0], rel=0.001)] * 2
    assert outcome.frames >= 2 * clean.frames - 2
