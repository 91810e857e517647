# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Bridge to OpenSim itself: its files, its tools in a process of their own, the comparison."""
