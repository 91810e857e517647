# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Predicts how a recorded lift could be done with the least effort, and compares both."""
