# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Physical constants."""

#: Standard gravity [m/s^2] (CGPM 1901).
GRAVITY = 9.80665
