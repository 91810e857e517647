# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Anthropometry, 2D and 3D skeletons, recursive kinematics and dynamics, and joint strength of a lifting person."""
