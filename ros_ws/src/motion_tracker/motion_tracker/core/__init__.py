# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tracker without ROS: filters, force plates, marker sets, inverse kinematics, lift events."""
