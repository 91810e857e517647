# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lumbar rhythm as a prior of the inverse kinematics."""

import csv
from functools import cache

from motion_tracker.core.markers.marker_set import DATA


@cache
def spine_prior() -> tuple[tuple[str, str, float], ...]:
    """Lower and upper coordinate and the share of their sum the lower one takes."""
    with (DATA / 'spine_prior.csv').open(newline='', encoding='utf-8') as file:
        return tuple(
            (row['lower'], row['upper'], float(row['lower_share'])) for row in csv.DictReader(file)
        )
