# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service of the graph's topics as profiles of rclpy."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from lifting_messages.topics import Quality


def profile(
    quality: Quality, reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
) -> QoSProfile:
    """Return the profile of a quality of service."""
    durable = DurabilityPolicy.TRANSIENT_LOCAL if quality.latched else DurabilityPolicy.VOLATILE
    return QoSProfile(
        reliability=reliability,
        durability=durable,
        history=HistoryPolicy.KEEP_LAST,
        depth=quality.depth,
    )


PLATES = profile(Quality.PLATES)
FRAMES = profile(Quality.FRAMES)
LATCHED = profile(Quality.LATCHED)
RESULTS = profile(Quality.RESULTS)
VIEW = profile(Quality.VIEW)
TRANSFORMS = profile(Quality.TRANSFORMS)
#: Streams of external drivers, which may be best effort: a reliable subscriber gets nothing then.
DRIVER = profile(Quality.FRAMES, ReliabilityPolicy.BEST_EFFORT)
