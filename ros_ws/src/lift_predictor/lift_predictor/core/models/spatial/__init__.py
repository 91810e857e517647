# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lift in space: 40 degrees of freedom, both feet and both hands (chapters III and V)."""
