# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Bridge to OpenSim: its files written and read, its tools run as referee, the differences."""
