# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded or live markers and force plates to joint states, ground reaction, centre of pressure and lift events."""
