# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the figures of the benchmarks should be, result file by result file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Target:
    """What a figure should be, and the dissertation's value (None: it has none)."""

    least: float | None = None
    most: float | None = None
    dissertation: float | None = None

    def met(self, value: float) -> bool:
        """Whether a value reaches the target."""
        low = self.least is None or value >= self.least
        return low and (self.most is None or value <= self.most)

    def __str__(self) -> str:
        """In words."""
        if self.least is not None and self.least == self.most:
            return f'{self.least:g}'
        return f'>= {self.least:g}' if self.least is not None else f'<= {self.most:g}'


PREDICTOR: Final[dict[str, Target]] = {
    '2d_fixed_7kg_ms': Target(most=5.0, dissertation=480.0),
    '2d_fixed_12kg_ms': Target(most=5.0, dissertation=620.0),
    '2d_max_ms': Target(most=5.0, dissertation=3340.0),
    '2d_warm_hz': Target(least=500.0),
    '3d_fixed_s': Target(most=0.4, dissertation=42.0),
    '3d_max_s': Target(most=0.5, dissertation=72.8),
    '3d_warm_hz': Target(least=10.0),
    'random2d_solved': Target(least=200.0, most=200.0),
    'random2d_best_within_0_1pct': Target(least=195.0),
    'random3d_solved': Target(least=100.0, most=100.0),
    'dense_grid_violations': Target(least=0.0, most=0.0),
    'infeasible_detected': Target(least=50.0, most=50.0),
    'pareto_252_solves_s': Target(most=10.0),
    'cold_process_s': Target(most=0.5),
}

MUSCLE: Final[dict[str, Target]] = {
    'frame_us_p50': Target(most=200.0),
    'frame_us_p99': Target(most=1000.0),
    'ratio_to_opensim': Target(least=10_000.0),
    'ratio_to_opensim_rajagopal': Target(least=500.0),
    'moment_arm_mm_p50': Target(most=0.1),
    'moment_arm_mm_max': Target(most=1.0),
    'so_cost_over_opensim_max': Target(most=0.0),
    'l5s1_diff_percent': Target(most=2.0),
    'l5s1_equal_forces_N': Target(most=0.1),
    'frames_unsolved': Target(least=0.0, most=0.0),
    'node_latency_ms_p99': Target(most=5.0),
}

TARGETS: Final[dict[str, dict[str, Target]]] = {'predictor': PREDICTOR, 'muscle': MUSCLE}
