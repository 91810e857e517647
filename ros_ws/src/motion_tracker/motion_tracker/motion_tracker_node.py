# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node of the motion tracker: its station and the service that ends a recording."""

from __future__ import annotations

from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from std_srvs.srv import Trigger

from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from motion_tracker.station import TrackerStation


class MotionTrackerNode(PipelineNode[TrackerStation]):
    """Tracks the person at one station; the namespace is the station."""

    STATION = TrackerStation
    LATER = ('scipy.signal', 'scipy.interpolate')

    def build(self) -> None:
        """Create the station, its topics and the flush service."""
        super().build()
        self._flush_service = self.serve(Trigger, '~/flush', self._on_flush)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the service with the rest."""
        self.destroy_service(self._flush_service)
        return super().on_cleanup(state)

    def _on_flush(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """End the recording: no further sample will come."""
        begun, before = self.station.tracker is not None, self.station.lifts
        self.publish_all(self.station.flush())
        response.success = begun
        response.message = (
            f'{self.station.lifts - before} lifts'
            if begun
            else 'no recording under way: neither person, task nor samples came'
        )
        return response


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(MotionTrackerNode, args)


if __name__ == '__main__':
    main()
