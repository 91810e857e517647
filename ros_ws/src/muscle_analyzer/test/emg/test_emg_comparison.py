# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""EMG beside activations: names of channels, known lags and correlations, what is left out."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.report import SolveStatus
from muscle_analyzer.core.emg.comparison import (
    compare_emg,
    emg_muscles,
    muscle_of_channel,
    parts_of,
)
from muscle_analyzer.core.emg.envelopes import OWN_MAXIMUM, Envelopes
from muscle_analyzer.core.exceptions import EmgError


@pytest.fixture(scope='module')
def analysis(box_lift):
    """Return an analysis of 31 samples, whose activations the tests replace."""
    found = box_lift.analyzer.analyze(box_lift.body, 'lift_7', 'measured')
    good = tuple(replace(report, status=SolveStatus.OK) for report in found.reports)
    return replace(found, time=found.time - found.time[0], reports=good)


def course(time):
    return 0.5 + 0.4 * np.sin(2.0 * np.pi * time / 0.4)


def envelopes(values, names=('VLR',)):
    time = np.linspace(-0.5, 1.0, 3001)
    columns = np.stack([value(time) for value in values], axis=1)
    return Envelopes(names, time, columns, np.ones(len(names)), (OWN_MAXIMUM,) * len(names))


def with_activation(analysis, names, value):
    activation = analysis.activation.copy()
    for name in names:
        activation[:, analysis.muscle_names.index(name)] = value
    return replace(analysis, activation=activation)


@pytest.mark.parametrize('shift', [-0.06, -0.013, 0.0, 0.04, 0.1])
def test_a_known_lag_is_found(analysis, shift):
    """Positive when the activation is later than the EMG; the course is the same then."""
    moved = with_activation(analysis, ['vaslat_r'], 0.6 * course(analysis.time - shift))
    (match,) = compare_emg(envelopes([course]), moved)
    assert match.lag == pytest.approx(shift, abs=1e-3)
    assert match.lag_percent == pytest.approx(100.0 * shift / 0.3, abs=0.4)
    assert match.best_correlation == pytest.approx(1.0, abs=1e-4)
    ours, theirs = match.activation, course(analysis.time)
    assert match.correlation == pytest.approx(np.corrcoef(ours, theirs)[0, 1], abs=1e-4)
    assert match.rms == pytest.approx(np.sqrt(np.mean((ours - theirs) ** 2)), abs=1e-4)
    assert (match.muscle, match.side, match.parts) == ('Vastus lateralis', 'r', ('vaslat_r',))


def test_parts_of_a_muscle_are_averaged(analysis):
    moved = with_activation(analysis, ['glmax1_l', 'glmax3_l'], course(analysis.time))
    moved = with_activation(moved, ['glmax2_l'], 0.2)
    (match,) = compare_emg(envelopes([course], ('EMG gluteus maximus left',)), moved)
    np.testing.assert_allclose(match.activation, (2.0 * course(analysis.time) + 0.2) / 3.0)
    assert match.parts == ('glmax1_l', 'glmax2_l', 'glmax3_l')
    assert match.correlation == pytest.approx(1.0, abs=1e-4)


def test_opposite_courses_correlate_negatively(analysis):
    moved = with_activation(analysis, ['vaslat_r'], 1.0 - course(analysis.time))
    (match,) = compare_emg(envelopes([course]), moved)
    assert match.correlation == pytest.approx(-1.0, abs=1e-4)


def test_constant_activation_and_a_best_shift_at_the_limit_have_no_phase(analysis):
    still = with_activation(analysis, ['vaslat_r'], 0.01)
    (match,) = compare_emg(envelopes([course]), still)
    assert np.isnan([match.correlation, match.lag, match.best_correlation]).all()
    assert match.note == 'activation constant'

    def step(centre):
        return lambda t: 1.0 / (1.0 + np.exp(-(t - centre) / 0.05))

    # Half a second apart in a lift of 0.3 s: not the same event.
    rising = with_activation(analysis, ['vaslat_r'], step(0.1)(analysis.time))
    (match,) = compare_emg(envelopes([step(0.6)]), rising)
    assert np.isnan([match.lag, match.best_correlation]).all()
    # Half of the lift, which lasts a microsecond less than 0.3 s.
    assert match.note == 'best beyond -0.149 s'
    assert 0.5 < match.correlation < 0.9


def test_samples_that_are_not_good_data_are_left_out(analysis):
    wrong = course(analysis.time)
    wrong[10:14] = 7.0
    moved = with_activation(analysis, ['vaslat_r'], wrong)
    bad = replace(analysis.reports[0], status=SolveStatus.MUSCLE_TOO_WEAK)
    reports = tuple(bad if 10 <= k < 14 else report for k, report in enumerate(analysis.reports))
    (match,) = compare_emg(envelopes([course]), replace(moved, reports=reports))
    assert match.time.size == 27
    assert match.correlation == pytest.approx(1.0, abs=1e-4)
    with pytest.raises(EmgError, match="lift 'lift_7': 0 good samples"):
        compare_emg(envelopes([course]), replace(moved, reports=(bad,) * 31))


@pytest.mark.parametrize(
    ('channel', 'code', 'side'),
    [
        ('BFR', 'BF', 'r'),
        ('BFL', 'BF', 'l'),
        ('EMG_BFR', 'BF', 'r'),
        ('EMG_VL_l', 'VL', 'l'),
        ('L VL', 'VL', 'l'),
        ('VLL', 'VL', 'l'),
        ('LDL', 'LD', 'l'),
        ('raw.GMax.right', 'GMAX', 'r'),
        ('Vastus Medialis (left)', 'VM', 'l'),
        ('gmedr', 'GMED', 'r'),
    ],
)
def test_channels_are_understood(channel, code, side):
    muscle, found = muscle_of_channel(channel)
    assert (muscle.code, found) == (code, side)


@pytest.mark.parametrize('channel', ['EMG1', 'BF', 'BF_r_l', 'soleus_r', '', 'R'])
def test_channels_without_muscle_or_side_are_refused(channel):
    with pytest.raises(EmgError, match='names no muscle and side; known are BF, VL'):
        muscle_of_channel(channel)


def test_every_muscle_of_the_table_is_in_the_model_on_both_sides(analysis):
    for muscle in emg_muscles():
        right, left = (parts_of(muscle, side, analysis.muscle_names) for side in 'rl')
        assert [name[:-2] for name in right] == [name[:-2] for name in left], muscle.code
    with pytest.raises(EmgError, match='the model has no muscle'):
        parts_of(emg_muscles()[0], 'r', ('soleus_r',))


def test_a_channel_may_be_given_a_name(analysis):
    moved = with_activation(analysis, ['vasmed_l'], course(analysis.time))
    (match,) = compare_emg(envelopes([course], ('EMG1',)), moved, {'EMG1': 'VM_l'})
    assert (match.channel, match.muscle, match.side) == ('EMG1', 'Vastus medialis', 'l')
    with pytest.raises(EmgError, match="'EMG2': no such EMG channel; channels: EMG1"):
        compare_emg(envelopes([course], ('EMG1',)), moved, {'EMG2': 'VM_l'})


def test_a_lift_outside_the_emg_is_refused(analysis):
    later = replace(analysis, time=analysis.time + 0.9)
    with pytest.raises(EmgError, match=r'0\.900 to 1\.200 s, is not within the EMG, -0\.500'):
        compare_emg(envelopes([course]), later)
