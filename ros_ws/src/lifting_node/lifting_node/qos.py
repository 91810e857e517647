# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service of every topic of the graph, chosen in one place.

The graph analyses recordings as well as live streams, and an analysis with a missing plate
sample is wrong without looking wrong. So the input streams are reliable with a history deep
enough for the slowest reader at ten times real time, not best effort.
"""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

#: Samples of a 2500 Hz force plate in 16 s: how far a reader may fall behind without loss.
PLATE_DEPTH = 40_000
#: Frames of a 100 Hz stream in 200 s: what an analysis at ten times real time may lag behind.
FRAME_DEPTH = 20_000
#: Lifts kept for a reader that joins late.
LIFT_DEPTH = 100
#: Pictures kept for a viewer that is late; it loses older ones.
VIEW_DEPTH = 10
#: Depth of /tf with all broadcasters of ROS 2.
TRANSFORM_DEPTH = 100


def _profile(
    depth: int,
    durability: DurabilityPolicy,
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE,
) -> QoSProfile:
    return QoSProfile(
        reliability=reliability,
        durability=durability,
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
    )


#: Force plate samples.
PLATES = _profile(PLATE_DEPTH, DurabilityPolicy.VOLATILE)
#: One message a camera frame: markers, box, joint states, live loads.
FRAMES = _profile(FRAME_DEPTH, DurabilityPolicy.VOLATILE)
#: Subject and task: entered once, known to every node that joins later.
LATCHED = _profile(1, DurabilityPolicy.TRANSIENT_LOCAL)
#: Results of whole lifts and alarms: a reader that joins late gets the recent ones.
RESULTS = _profile(LIFT_DEPTH, DurabilityPolicy.TRANSIENT_LOCAL)
#: Pictures for people. Reliable, as RViz asks for it, and short: nobody waits for a viewer.
VIEW = _profile(VIEW_DEPTH, DurabilityPolicy.VOLATILE)
#: /tf, as the broadcasters of ROS 2 offer it.
TRANSFORMS = _profile(TRANSFORM_DEPTH, DurabilityPolicy.VOLATILE)
#: Streams of drivers of others, which may be best effort: a reliable reader would get nothing.
DRIVER = _profile(FRAME_DEPTH, DurabilityPolicy.VOLATILE, ReliabilityPolicy.BEST_EFFORT)
