# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled steps of the causal filters, and rows between those of a stream."""

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array


@njit
def run(
    a: Array, b: Array, d: Array, scale: Array, state: Array, samples: Array, out: Array
) -> int:
    """Pass samples (n, channels) through ``x' = a x + b u``, ``y = scale (x + d u)``.

    ``out`` (n, k, channels) takes the output and its first k - 1 derivatives; ``state`` (order,
    channels) is left as it is after the last sample. Returns -1, or the channel of the first
    number that is not finite: its sample and those after it are not taken.
    """
    order, channels = state.shape
    after = np.empty_like(state)
    for n in range(samples.shape[0]):
        sample = samples[n]
        for channel in range(channels):
            if not np.isfinite(sample[channel]):
                return channel
        for k in range(out.shape[1]):
            for channel in range(channels):
                out[n, k, channel] = scale[k] * (state[k, channel] + d[k] * sample[channel])
        for i in range(order):
            for channel in range(channels):
                value = b[i] * sample[channel]
                for j in range(order):
                    value += a[i, j] * state[j, channel]
                after[i, channel] = value
        state[:] = after
    return -1


@njit
def blended(rows: Array, after: int, share: float) -> Array:
    """Row (channels,) at the share of the way from the row before ``after`` to that."""
    row = np.empty(rows.shape[1])
    for channel in range(rows.shape[1]):
        row[channel] = (1.0 - share) * rows[after - 1, channel] + share * rows[after, channel]
    return row
