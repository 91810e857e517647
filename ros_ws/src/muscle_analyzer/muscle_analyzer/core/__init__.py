# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Musculoskeletal model, muscle forces and joint reactions; no ROS in here."""
