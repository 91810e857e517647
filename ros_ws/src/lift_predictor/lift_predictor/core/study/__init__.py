# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Studies over populations: subjects x tasks x weightings, resumable, on one machine or many."""
