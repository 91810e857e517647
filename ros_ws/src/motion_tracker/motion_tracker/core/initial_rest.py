# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a recording begins at rest, as the causal filters take it to."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from human_model.typing import Array


def initial_speed(stamps: npt.ArrayLike, frames: Sequence[Array]) -> float:
    """Root mean square speed of the markers in the first frames of a recording [m/s].

    The velocity of a marker is the slope of the straight line through its places. What noise adds
    to the mean square, the variance of the slopes by the residuals about the lines, is taken off
    (Draper & Smith 1998, Applied Regression Analysis, section 1.4).

    Parameters
    ----------
    stamps
        Shape (n,), n >= 3 [s].
    frames
        n arrays (markers, 3) [m]; NaN where not seen. Markers seen in all of them count.

    Returns
    -------
    float
        0 if noise explains all of the movement, or no marker was seen throughout.
    """
    time = np.asarray(stamps, dtype=np.float64)
    time = time - time.mean()
    places = np.stack(frames)
    places = places[:, np.isfinite(places).all(axis=(0, 2))]
    if places.shape[1] == 0:
        return 0.0
    places = places - places.mean(axis=0)
    spread = float(time @ time)
    slopes = np.tensordot(time, places, 1) / spread
    residuals = places - time[:, None, None] * slopes
    noise = np.sum(residuals**2, axis=0) / (len(time) - 2) / spread
    return float(np.sqrt(max(0.0, np.mean(np.sum(slopes**2 - noise, axis=1)))))
