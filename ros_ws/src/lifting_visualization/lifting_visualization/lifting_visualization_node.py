# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node of the visualization: its station and the timer of the predicted lift."""

from __future__ import annotations

from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from lifting_visualization.station import VisualizerStation


class LiftingVisualizationNode(PipelineNode[VisualizerStation]):
    """Pictures of one station; the namespace is the station."""

    STATION = VisualizerStation

    def build(self) -> None:
        """Create the station, its topics and the timer."""
        super().build()
        self._ghost_timer = self.create_timer(1.0 / self.values['rate'], self._show_ghost)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the timer with the rest."""
        self.destroy_timer(self._ghost_timer)
        return super().on_cleanup(state)

    def _show_ghost(self) -> None:
        if self.active:
            self.publish_all(self.station.ghost())


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(LiftingVisualizationNode, args)


if __name__ == '__main__':
    main()
