# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects, skeletons, recursive dynamics and joint strength of a lifting person."""
