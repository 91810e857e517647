# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Models of the lifting person: in the sagittal plane, and in space."""
