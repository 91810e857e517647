# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assessment of a lift: the thesis' numbers, missing parts, samples that did not solve."""

import math
from dataclasses import replace

import numpy as np
import pytest

from human_model.task import Coupling, Work
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lifting_geometry import LiftEnd
from injury_monitor.core.limits import Zone
from injury_monitor.core.loads import ActivationSeries, LiftLoads, TorqueSeries
from injury_monitor.core.monitor import InjuryMonitor
from injury_monitor.core.rnle_assessment import LiftEnds

TIME = 10.0 + np.arange(0.0, 1.201, 0.01)
GOOD = np.ones(len(TIME), bool)
BUMP = np.sin(np.pi * (TIME - 10.0) / 1.2)
# Thesis chapter IV: 63.5 kg, peaks of the 12 kg lift 2390 N and 796 N.
ASSIGNMENT = Assignment('symmetric_12kg', 'P01', 63.5, 12.0, Work(500.0, 0.2, 1.0, Coupling.GOOD))


def loads(compression, shear, **parts):
    return LiftLoads(
        'lift_001',
        10.0,
        TIME,
        compression * BUMP,
        shear * BUMP,
        parts.pop('solved', GOOD),
        **parts,
    )


def working(**changes):
    """Return the assignment with changed work."""
    return replace(ASSIGNMENT, work=replace(ASSIGNMENT.work, **changes))


def assess(measured, predicted=None, ends=None, assignment=ASSIGNMENT):
    target = InjuryMonitor()
    target.configure(assignment)
    return target.assess(measured, predicted, ends)


def ends(distance=0.25, low=0.3, high=0.75):
    ankles = np.array([[0.0, -0.1, 0.08], [0.0, 0.1, 0.08]])
    return LiftEnds(
        LiftEnd(np.array([distance, 0.0, low]), ankles),
        LiftEnd(np.array([distance, 0.0, high]), ankles),
    )


def test_the_numbers_of_the_thesis():
    result = assess(loads(2390.0, 796.0), loads(2000.0, 600.0))
    peak = result.criterion('compression_action', 'measured')
    shear = result.criterion('shear_frequent', 'measured')
    assert result.zone is Zone.NOMINAL
    assert peak.per_kilogram == pytest.approx(38.0, abs=0.5)
    assert shear.per_kilogram == pytest.approx(12.6, abs=0.1)
    assert peak.margin == pytest.approx(3400.0 - 2390.0)
    assert shear.margin == pytest.approx(700.0 - 796.0)
    assert peak.time == pytest.approx(0.6)
    assert result.avoidable_compression == pytest.approx(390.0)
    assert result.avoidable_shear == pytest.approx(196.0)
    assert '390 N of it were avoidable' in result.summary


def test_a_worse_optimal_lift_is_not_sold_as_an_improvement():
    result = assess(loads(2000.0, 500.0), loads(2100.0, 400.0))
    assert result.avoidable_compression == pytest.approx(-100.0)
    assert '100 N higher' in result.summary


def test_missing_parts_are_named():
    result = assess(loads(2390.0, 796.0))
    assert math.isnan(result.avoidable_compression)
    assert any('no predicted lift' in note for note in result.notes)
    assert any('no joint torques' in note for note in result.notes)
    assert any('no muscle activations' in note for note in result.notes)
    assert 'not known' in result.lifting.note and math.isnan(result.lifting.lifting_index)
    assert result.criterion('torque_index', 'measured') is None


def test_unsolved_samples_are_left_out_of_peaks_and_counted():
    solved = GOOD.copy()
    solved[60] = False
    measured = loads(2390.0, 796.0, solved=solved)
    measured.compression[60] = 1e6
    result = assess(measured)
    assert result.criterion('compression_maximum', 'measured').value == pytest.approx(
        2390.0, abs=2.0
    )
    assert result.samples_left_out == 1


def test_a_lift_without_any_solved_sample_has_no_zone():
    result = assess(loads(2390.0, 796.0, solved=~GOOD))
    assert result.zone is Zone.UNKNOWN
    assert math.isnan(result.criterion('compression_action', 'measured').value)
    assert any('no sample of the spine load' in note for note in result.notes)
    assert 'unknown' in result.summary


@pytest.mark.parametrize(('left_out', 'words'), [(0, ''), (20, 'at least '), (80, None)])
def test_a_minority_of_samples_is_no_assessment(left_out, words):
    """The first samples are not good: the peak is at least that of the others, or not known."""
    solved = GOOD.copy()
    solved[:left_out] = False
    result = assess(loads(2390.0, 796.0, solved=solved))
    peak = result.criterion('compression_action', 'measured').value
    if words is None:
        assert math.isnan(peak)
        assert result.zone is Zone.UNKNOWN
        assert any('at least compression 20' in note for note in result.notes)
        return
    assert peak == pytest.approx(2390.0, abs=1.0)
    assert f'Peak L5-S1 compression {words}2390 N' in result.summary
    assert any('at least as high' in note for note in result.notes) == bool(words)


def test_indices_name_joint_and_muscle():
    n = len(TIME)
    torques = TorqueSeries(
        TIME,
        ('hip', 'knee'),
        np.column_stack([-80.0 * BUMP, 20.0 * BUMP]),
        np.full((n, 2), -100.0),
        np.full((n, 2), 200.0),
        GOOD,
    )
    active = ActivationSeries(
        TIME, ('gluteus', 'vastus'), np.column_stack([0.4 * np.ones(n), 0.2 * np.ones(n)]), GOOD
    )
    result = assess(loads(2390.0, 796.0, torques=torques, activations=active))
    torque = result.criterion('torque_index', 'measured')
    held = result.criterion('activation_index', 'measured')
    assert (torque.detail, torque.value) == ('hip', pytest.approx(0.8, abs=1e-3))
    assert (held.detail, held.value) == ('gluteus', pytest.approx(0.4))
    np.testing.assert_allclose(result.torque_index['measured'].peak, [0.8, 0.1], atol=1e-3)


def test_lifting_equation_at_both_ends():
    near_floor = assess(loads(2000.0, 500.0), ends=ends()).lifting
    assert near_floor.governing == 'origin'
    assert near_floor.origin.multipliers[1] == pytest.approx(1.0 - 0.003 * 45.0)
    assert near_floor.lifting_index == pytest.approx(12.0 / (23.0 * 0.865 * (0.82 + 4.5 / 45.0)))
    far_up = ends(low=0.75, high=1.6)
    assert assess(loads(2000.0, 500.0), ends=far_up).lifting.governing == 'origin'
    controlled = assess(
        loads(2000.0, 500.0), ends=far_up, assignment=working(control_at_destination=True)
    ).lifting
    assert controlled.governing == 'destination'
    assert controlled.result() is controlled.destination
    assert controlled.lifting_index > controlled.origin.lifting_index


@pytest.mark.parametrize(
    ('change', 'reason'),
    [
        ({'duration_hours': 0.0}, 'duration_hours'),
        ({'lifts_per_minute': math.nan}, 'lifts_per_minute'),
    ],
)
def test_no_lifting_index_without_its_inputs(change, reason):
    lifting = assess(loads(2000.0, 500.0), ends=ends(), assignment=working(**change)).lifting
    assert reason in lifting.note and math.isnan(lifting.lifting_index)


def test_no_lifting_index_without_a_box():
    empty = replace(ASSIGNMENT, box_mass=0.0)
    lifting = assess(loads(2000.0, 500.0), ends=ends(), assignment=empty).lifting
    assert 'nothing is lifted' in lifting.note and math.isnan(lifting.lifting_index)


def test_more_loads_than_the_source_covers_is_said():
    result = assess(loads(2000.0, 500.0), assignment=working(lifts_per_day=2000.0))
    assert any('2000 loads a day' in note for note in result.notes)


def test_bad_series_are_refused_by_field():
    with pytest.raises(InvalidInputError, match=r'LiftLoads\.compression'):
        replace(loads(1.0, 1.0), compression=np.full(len(TIME), np.nan))
    unsolved = replace(loads(1.0, 1.0), compression=np.full(len(TIME), np.nan), solved=~GOOD)
    assert np.all(np.isnan(unsolved.compression))
    for time in (TIME[::-1], np.where(TIME[3] == TIME, np.nan, TIME), TIME[:, None]):
        with pytest.raises(InvalidInputError, match=r'LiftLoads\.time'):
            replace(loads(1.0, 1.0), time=time)
    with pytest.raises(InvalidInputError, match=r'LiftLoads\.time = \[\]: must not be empty'):
        replace(loads(1.0, 1.0), time=TIME[:0])
    with pytest.raises(InvalidInputError, match=r'LiftLoads\.solved = \(3,\)'):
        replace(loads(1.0, 1.0), solved=GOOD[:3])
    with pytest.raises(InvalidInputError, match=r'TorqueSeries\.lower'):
        TorqueSeries(
            TIME, ('hip',), np.zeros((len(TIME), 1)), np.zeros(3), np.zeros((len(TIME), 1)), GOOD
        )
    with pytest.raises(InvalidInputError, match=r'predicted\.lift_id'):
        assess(loads(1.0, 1.0), replace(loads(1.0, 1.0), lift_id='lift_002'))
