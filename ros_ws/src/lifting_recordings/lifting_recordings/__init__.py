# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of lifts as bags: read, write, import and recover; no ROS needed."""
