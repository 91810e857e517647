# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files, configuration and the lift command: import, play and record bags, run the graph, write the report."""
