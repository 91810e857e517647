# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Status of a fitted frame and the reason for it."""

import numpy as np

from human_model.report import SolveStatus
from human_model.typing import Array
from motion_tracker.core.inverse_kinematics.solution import IKSettings, Observed
from motion_tracker.core.markers.marker_model import MarkerModel


def judge(
    settings: IKSettings,
    model: MarkerModel,
    stopped: str,
    rms: float,
    maximum: float,
    residuals: Array,
    used: int,
    observed: Observed,
    swapped: str,
    rejected: tuple[str, ...],
) -> tuple[SolveStatus, str]:
    """Return the status of a frame, and why it is not good or which markers were left out.

    Parameters
    ----------
    settings : IKSettings
        Limits of the residuals.
    model : MarkerModel
        The markers.
    stopped : str
        Why the fit did not converge; empty if it did.
    rms, maximum : float
        Of the residuals [m].
    residuals : ndarray, shape (n_markers,)
        [m]; NaN where not seen or not used.
    used : int
        Markers used.
    observed : Observed
        Coordinates that the markers of this frame do not determine.
    swapped : str
        Markers that look exchanged, in words.
    rejected : tuple of str
        Markers left out.
    """
    if swapped:
        return SolveStatus.TRACKER_MARKERS_SWAPPED, f'markers {swapped}'
    if stopped:
        return SolveStatus.TRACKER_NOT_CONVERGED, stopped
    if not (maximum <= settings.max_residual and rms <= settings.rms_residual):
        worst = model.names[int(np.nanargmax(residuals))]
        return (
            SolveStatus.TRACKER_BAD_INPUT,
            f'marker residuals rms {rms:.3f} m, largest {maximum:.3f} m at {worst}',
        )
    words = []
    if used < len(residuals):
        seen = {s for s, r in zip(model.segments, residuals, strict=True) if np.isfinite(r)}
        blind = sorted(set(model.segments) - seen)
        words += [f'no marker seen on {", ".join(blind)}'] if blind else []
    if observed.names:
        words.append(f'{", ".join(observed.names)} not observed: kept at the previous value')
    if words:
        return SolveStatus.TRACKER_MARKERS_MISSING, '; '.join(words)
    return SolveStatus.OK, f'left out: {", ".join(rejected)}' if rejected else ''
