# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node of the muscle analyzer."""

from __future__ import annotations

from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from muscle_analyzer.station import AnalyzerStation


class MuscleAnalyzerNode(PipelineNode[AnalyzerStation]):
    """Analyses live motion and whole lifts of one station; the namespace is the station."""

    STATION = AnalyzerStation


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(MuscleAnalyzerNode, args)


if __name__ == '__main__':
    main()
