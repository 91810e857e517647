# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Latency of live frames through motion tracker, muscle analyzer and injury monitor at 100 Hz.

Real node processes, the real player in real time; what a latency is stands in `node_graphs`. The
whole recording counts, its lift too, which is analysed as a whole while live frames go on.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks.node_graphs import CHAIN, ROOT, Stations

BAG: Final = ROOT / 'bags' / 'asymmetric_7kg'
PLAYS: Final = 6
"""The first warms the processes up and is not counted."""


def run() -> dict[str, float]:
    """Give the figures by name."""
    with tempfile.TemporaryDirectory() as folder, Stations(CHAIN, Path(folder)) as stations:
        stations.add()
        plays = [stations.play(BAG)[0] for _ in range(PLAYS)]
    latency = 1e3 * np.concatenate(plays[1:])
    if not np.isfinite(latency).all():
        raise RuntimeError('the chain cannot keep up with 100 Hz on this machine as it is')
    return {
        'node_latency_ms_p50': float(np.percentile(latency, 50)),
        'node_latency_ms_p99': float(np.percentile(latency, 99)),
        'node_latency_ms_max': float(latency.max()),
        'node_latency_frames': float(latency.size),
    }
