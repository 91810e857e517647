# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compares spine loads, joint torques and activations with published limits; raises alarms."""
