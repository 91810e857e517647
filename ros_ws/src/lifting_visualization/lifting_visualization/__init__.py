# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of persons, loads and predicted lifts for RViz and Foxglove, and the frames of /tf."""
