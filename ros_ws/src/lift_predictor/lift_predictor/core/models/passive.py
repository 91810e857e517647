# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Passive moment of the hip: what the tissues behind and before it hold without muscle activity.

Riener and Edrich 1999 (J Biomech 32:539) measured it in people lying on the side; it depends on
the flexion of the knee, as the hamstrings pass both joints.
"""

from __future__ import annotations

from typing import Any, Final

_DEGREE: Final = 57.29577951308232


def passive_hip_moment(hip: Any, knee: Any, exponential: Any) -> Any:
    """Return the passive moment of one hip in the direction of its flexion [N m].

    Parameters
    ----------
    hip, knee : number, array or expression
        Flexion [rad].
    exponential : callable
        Of the same type.
    """
    h, k = _DEGREE * hip, _DEGREE * knee
    flexing = exponential(1.4655 - 0.0034 * k - 0.0750 * h)
    extending = exponential(1.3403 - 0.0226 * k + 0.0305 * h)
    return flexing - extending + 8.072
