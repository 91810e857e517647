# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects, skeletons, dynamics and joint strength of a lifting person."""

#: Of all packages; the manifests package.xml repeat it.
__version__ = '0.1.0'
