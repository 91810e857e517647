# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint states, ground reaction, centre of pressure and lift events from markers and plates."""
