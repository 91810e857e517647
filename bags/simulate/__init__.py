# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Generator of the simulated recordings in this folder: `python -m bags.simulate`."""
