# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lumbar rhythm as a prior of the inverse kinematics."""

from functools import cache

from human_model.tables import read_table


@cache
def spine_prior() -> tuple[tuple[str, str, float], ...]:
    """Lower and upper coordinate and the share of their sum the lower one takes."""
    rows = read_table('motion_tracker', 'spine_prior.csv', 'lower upper lower_share')
    return tuple((row['lower'], row['upper'], row.number('lower_share')) for row in rows)
