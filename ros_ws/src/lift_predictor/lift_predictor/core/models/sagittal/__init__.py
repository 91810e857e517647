# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lift in the sagittal plane: body model, programme, task, proof (chapters II and IV)."""
