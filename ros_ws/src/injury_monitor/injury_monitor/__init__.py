# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compares spine loads, joint torques and muscle activations with published limits and raises alarms."""
