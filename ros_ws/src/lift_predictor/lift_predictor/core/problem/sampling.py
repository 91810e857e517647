# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""At what instants a predicted motion is given out, in plane and space."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

SAMPLE_RATE: Final = 100.0
"""Samples per second of a predicted motion, as of the recorded one (section 4.3)."""


def sample_times(duration: float) -> NDArray[np.float64]:
    """Return times from 0 to the duration [s], as near to `SAMPLE_RATE` as fits."""
    return np.linspace(0.0, duration, max(round(duration * SAMPLE_RATE), 1) + 1)
