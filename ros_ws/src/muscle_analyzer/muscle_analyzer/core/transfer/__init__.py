# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From the motion of a skeleton to the motion of the musculoskeletal model."""
