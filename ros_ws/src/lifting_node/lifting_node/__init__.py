# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the lifecycle nodes of the lift monitor share: parameters, quality of service, message conversion and diagnostics."""
