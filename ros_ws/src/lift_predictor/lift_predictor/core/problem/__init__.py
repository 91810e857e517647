# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lift problem, independent of the model: solve, verify, refine, compare, explain."""
