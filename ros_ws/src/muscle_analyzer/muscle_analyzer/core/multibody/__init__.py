# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid-body trees: kinematics, inverse dynamics and joint reactions, compiled."""
