# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service between a bag's metadata and rclpy, and message classes by type name."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosReliability

# Keep-last depth of a transient-local topic when the bag does not say.
_LATCHED_DEPTH = 1


def message_class(name: str) -> Any | None:
    """Return the Python class of 'package/msg/Name', or None when it is not installed."""
    package, _, message = name.partition('/msg/')
    try:
        module = import_module(f'{package}.msg')
    except ModuleNotFoundError:
        return None
    return getattr(module, message, None)


def publisher_profile(offered: Iterable[Qos]) -> QoSProfile:
    """Return a profile under which nothing is lost: reliable, and as durable as recorded.

    Streams keep all, so that a slow subscriber holds the player up instead of losing data.
    """
    profiles = list(offered)
    latched = bool(profiles) and all(
        q.durability == QosDurability.TRANSIENT_LOCAL for q in profiles
    )
    if not latched:
        return QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
    depth = max((q.depth for q in profiles), default=0)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=max(depth, _LATCHED_DEPTH),
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
    )


def subscription_profile(offered: Iterable[QoSProfile]) -> QoSProfile:
    """Return the strongest profile that every publisher offers, keeping all."""
    profiles = list(offered)
    reliable = all(p.reliability == ReliabilityPolicy.RELIABLE for p in profiles)
    latched = all(p.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=(DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE),
    )


_HISTORY = {
    HistoryPolicy.KEEP_ALL: QosHistory.KEEP_ALL,
    HistoryPolicy.KEEP_LAST: QosHistory.KEEP_LAST,
}


def recorded_quality(template: Qos, profile: QoSProfile) -> Qos:
    """Return the bag's form of what a publisher offers.

    Parameters
    ----------
    template : Qos
        Gives deadline, lifespan and liveliness.
    profile : QoSProfile
        As discovered; discovery does not transmit history, so it may be unknown.
    """
    reliable = profile.reliability == ReliabilityPolicy.RELIABLE
    latched = profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    return template._replace(
        history=_HISTORY.get(profile.history, template.history),
        depth=profile.depth or template.depth,
        reliability=QosReliability.RELIABLE if reliable else QosReliability.BEST_EFFORT,
        durability=QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE,
    )
