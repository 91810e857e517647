# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the functions of the pipelines into their caches: `python -m lifting_cli.warm_up`.

The set-up runs it once, so that the nodes find compiled functions when they start. Each pipeline
does one piece of its work; what is in a cache already is only loaded.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor


def warm_tracker() -> None:
    """Track a few frames."""
    from motion_tracker.core.warm_up import warm_up

    warm_up()


def warm_analyzer() -> None:
    """Analyse one posture of each skeleton, as live motion and predicted lifts have them."""
    import numpy as np

    from human_model.named_subjects import named_subject, subject_names
    from human_model.skeletons import Skeleton2D, Skeleton3D
    from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

    subject = named_subject(subject_names()[0])
    analyzer = MuscleAnalyzer(subject)
    for kind, source in ((Skeleton3D, 'measured'), (Skeleton2D, 'predicted')):
        skeleton = kind.of(subject)
        q = skeleton.standing()
        motion = skeleton.body_motion(0.0, q, np.zeros_like(q), np.zeros_like(q))
        analyzer.joint_torques(analyzer.analyze(motion, 'warm_up', source), motion)


def warm_predictor() -> None:
    """Build the functions of both models for the default options, and both models of a person."""
    from human_model.named_subjects import named_subject, subject_names
    from lift_predictor.core.predictor import LiftPredictor

    predictor = LiftPredictor()
    subject = named_subject(subject_names()[0])
    # Asymmetric lifts are predicted by the spatial model.
    for solver in (predictor.sagittal, predictor.spatial):
        solver.model.person(subject)


#: What can be warmed, longest first.
PIPELINES: dict[str, Callable[[], None]] = {
    'muscle_analyzer': warm_analyzer,
    'lift_predictor': warm_predictor,
    'motion_tracker': warm_tracker,
}


def timed(name: str) -> tuple[str, float]:
    """Warm one pipeline; return its name and the time [s] it took."""
    start = time.monotonic()
    PIPELINES[name]()
    return name, time.monotonic() - start


def main(arguments: Sequence[str] | None = None) -> int:
    """Warm the named pipelines (default: all), two at a time; return the exit code."""
    names = list(sys.argv[1:] if arguments is None else arguments) or list(PIPELINES)
    unknown = [name for name in names if name not in PIPELINES]
    if unknown:
        print(f'{", ".join(unknown)}: not one of {", ".join(PIPELINES)}', file=sys.stderr)
        return 2
    # A fresh interpreter for each: no state of one library reaches another pipeline.
    spawn = multiprocessing.get_context('spawn')
    with ProcessPoolExecutor(2, mp_context=spawn, max_tasks_per_child=1) as pool:
        for name, duration in pool.map(timed, names):
            print(f'{name}: {duration:.1f} s', flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
