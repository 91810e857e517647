# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle forces by static optimisation and L5-S1 reactions, measured and predicted lifts."""
