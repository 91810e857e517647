# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The optimal-control problem of a lift, its solver and its checks; no ROS."""
