# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The causal filter's own design against SciPy's, which loads too long for a node's start."""

import subprocess
import sys

import numpy as np
import pytest
from scipy.signal import butter, cont2discrete

from motion_tracker.core.filters import CausalFilter

TIME = np.arange(300) / 100.0


@pytest.mark.parametrize(('rate', 'cutoff'), [(100.0, 6.0), (1000.0, 25.0), (2500.0, 25.0)])
def test_steps_are_those_of_scipys_first_order_hold(rate, cutoff):
    numerator, denominator = butter(4, 2 * np.pi * cutoff, analog=True)
    discrete = cont2discrete((numerator, denominator), 1.0 / rate, method='foh')
    feedforward, feedback = discrete[0][0], discrete[1]
    wave = 1.0 + np.sin(40.0 * TIME) + TIME**2
    causal = CausalFilter(rate, cutoff, 1)
    ours = np.array([causal.step([value])[0][0] for value in wave])
    # The recursion of the transfer function, at rest in its first sample as the filter is.
    padded_in = np.concatenate([np.full(4, wave[0]), wave])
    padded_out = np.concatenate([np.full(4, wave[0]), np.zeros(len(wave))])
    for k in range(4, len(padded_out)):
        past_in = padded_in[k - 4 : k + 1][::-1]
        padded_out[k] = feedforward @ past_in - feedback[1:] @ padded_out[k - 4 : k][::-1]
    # At 2500 Hz the coefficients of the transfer function hold ten digits of the state's.
    assert ours == pytest.approx(padded_out[4:], abs=1e-6)


def test_importing_the_tracker_does_not_load_scipy_signal():
    query = 'import sys, motion_tracker.core.tracker; print("scipy.signal" in sys.modules)'
    answer = subprocess.run(
        [sys.executable, '-c', query], check=True, capture_output=True, text=True
    )
    assert answer.stdout.strip() == 'False'
