# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a lift are joined as they come, and only to a whole lift."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.analysis import JoinedParts
from muscle_analyzer.core.muscles.activation_dynamics import ActivationDynamics


def test_parts_of_any_length_give_the_whole(box_lift):
    body = box_lift.body[:6]
    whole = box_lift.analyzer.analyze(body, 'lift', 'measured')
    parts = JoinedParts(6)
    for first, end in ((0, 1), (1, 4), (4, 6)):
        assert len(parts) == first
        part = box_lift.analyzer.analyze(body[first:end], 'lift', 'measured', continued=first > 0)
        parts.add(part)
    joined = parts.whole()
    assert len(joined) == 6
    np.testing.assert_array_equal(joined.time, body.time)
    np.testing.assert_array_equal(joined.force, whole.force)
    np.testing.assert_array_equal(joined.status, whole.status)
    assert joined.good_spine_samples == whole.good_spine_samples
    assert joined.peak_compression == whole.peak_compression


def test_a_lift_that_lacks_samples_is_refused(box_lift):
    parts = JoinedParts(3)
    with pytest.raises(InputArrayError, match='0 of 3'):
        parts.whole()
    parts.add(box_lift.analyzer.analyze(box_lift.body[:2], 'lift', 'measured'))
    with pytest.raises(InputArrayError, match='2 of 3'):
        parts.whole()


def test_excitations_of_a_lift_produce_its_activations(box_lift):
    body = box_lift.body[:6]
    whole = box_lift.analyzer.analyze(body, 'lift', 'measured')
    dynamics = ActivationDynamics(deactivation_time=0.06)
    excitation = whole.excitation(dynamics)
    rate = dynamics.rate(whole.activation, excitation)
    slope = np.gradient(whole.activation, whole.time, axis=0)
    np.testing.assert_allclose(rate, slope, atol=1e-9)
    assert not np.array_equal(whole.excitation(), excitation)
    with pytest.raises(InputArrayError, match='at least 3 samples'):
        box_lift.analyzer.analyze(body[:2]).excitation()
