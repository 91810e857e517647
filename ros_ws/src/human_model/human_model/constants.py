# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Constants that all packages share."""

#: Standard gravity [m/s^2] (CGPM 1901).
GRAVITY = 9.80665

#: Sides of the body, in the order of every array with one row for each.
SIDES = ('right', 'left')
