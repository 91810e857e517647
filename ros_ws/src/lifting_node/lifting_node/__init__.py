# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the lifecycle nodes: parameters, quality of service, diagnostics."""
