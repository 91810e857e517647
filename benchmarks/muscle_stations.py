# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How many whole graphs this machine carries: stations are added until frames come late.

Each station is a namespaced copy of all four nodes with a player of its own; all play the same
recording at the same time. A step counts if the worst station's 99th percentile keeps the limit.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks.muscle_chain import BAG
from benchmarks.node_graphs import WHOLE, Stations

LIMIT_MS: Final = 20.0
MOST: Final = 12
"""Stations that are not exceeded, so that this comes to an end on any machine."""


def run() -> dict[str, float]:
    """Give the figures by name."""
    figures = {'stations_at_100hz': 0.0}
    with tempfile.TemporaryDirectory() as folder, Stations(WHOLE, Path(folder)) as stations:
        for number in range(1, MOST + 1):
            stations.add()
            # Once to warm the new one up.
            stations.play(BAG)
            worst = max(1e3 * float(np.percentile(one, 99)) for one in stations.play(BAG))
            print(f'{number} stations: p99 {worst:.1f} ms', flush=True)
            figures[f'station_latency_ms_p99_{number}'] = worst
            if worst > LIMIT_MS:
                break
            figures['stations_at_100hz'] = float(number)
    return figures
