# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The best of twenty IPOPT runs on one sagittal task, kept on disk: a killed benchmark goes on.

A record is found again by a hash of everything that decides it: objective and constraints of the
problem at the starts, the bounds, and IPOPT's settings. A change of our own solver leaves it
valid; a change of the model or of the tasks does not.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks.solved_lifts import random_starts

from lift_predictor.core.models.sagittal.lift_model import SagittalModel
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.problem.run import FEASIBILITY_TOLERANCE, Start
from lift_predictor.core.solvers.ipopt import IpoptSolver

N_STARTS: Final = 20
MAX_ITERATIONS: Final = 500
WALL_LIMIT: Final = 60.0
"""Of one run [s]: a last resort, far above what the iterations take."""
SETTINGS: Final[dict[str, Any]] = {
    'mu_strategy': 'adaptive',
    'expect_infeasible_problem': 'yes',
    'mumps_permuting_scaling': 0,
    'mumps_scaling': 0,
}
"""IPOPT's own options, found on three tasks: with the adaptive barrier more random starts end in
a minimum, and in half the time; the problem has its scaling already."""
STORE: Final = Path(__file__).resolve().parents[1] / '.cache' / 'benchmarks' / 'ipopt_random.jsonl'


@dataclass(frozen=True)
class Referee:
    """What twenty IPOPT runs found for one task.

    Attributes
    ----------
    key : str
        Hash of what was solved.
    number : int
        Of the task.
    objective : list of float
        Effort of each run that converged [s], the least first.
    iterations : int
        Of all runs.
    seconds : float
        Processor time of all runs [s].
    """

    key: str
    number: int
    objective: list[float]
    iterations: int
    seconds: float

    @property
    def best(self) -> float:
        """Least effort [s]; NaN: no run converged."""
        return self.objective[0] if self.objective else float('nan')


class RefereeStore:
    """Records of the referee in a file of one JSON object a line.

    Parameters
    ----------
    model : SagittalModel
        Of the NLP.
    path : Path
        The file; made when it is missing.
    """

    def __init__(self, model: SagittalModel, path: Path = STORE) -> None:
        self.path = path
        self._model = model
        self._known: dict[str, Referee] = {}
        if path.exists():
            for line in path.read_text(encoding='utf-8').splitlines():
                record = Referee(**json.loads(line))
                self._known[record.key] = record

    def find(self, number: int, task: SagittalTask) -> Referee:
        """Return the record of a task; make it and append it to the file if there is none."""
        starts = random_starts(task.bounds, self._model.grid, N_STARTS, number)
        key = self._key(task, starts)
        if key in self._known:
            return self._known[key]
        begin = time.process_time()
        nlp, first = self._model.nlp(task), self._model.variables(task, starts[0])
        limits = {'max_iter': MAX_ITERATIONS, 'max_wall_time': WALL_LIMIT}
        solver = IpoptSolver(nlp, first, SETTINGS | limits)
        runs = [solver.solve(nlp, self._model.variables(task, start)) for start in starts]
        record = Referee(
            key,
            number,
            sorted(r.objective for r in runs if r.ok and r.primal <= FEASIBILITY_TOLERANCE),
            sum(run.iterations for run in runs),
            time.process_time() - begin,
        )
        self._append(record)
        return record

    def _append(self, record: Referee) -> None:
        self._known[record.key] = record
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open('a', encoding='utf-8') as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.write(json.dumps(asdict(record)) + '\n')

    def _key(self, task: SagittalTask, starts: Sequence[Start]) -> str:
        programme = self._model.nlp(task)
        numbers = [programme.lower, programme.upper, programme.g_lower, programme.g_upper]
        for start in starts:
            objective, rows = programme.values(np.append(start.control, task.mass[0]))
            numbers += [start.control.ravel(), np.array([objective]), rows]
        text = ' '.join(f'{value:.6e}' for value in np.concatenate(numbers))
        settings = repr((SETTINGS, MAX_ITERATIONS))
        return hashlib.sha256(f'{settings} {text}'.encode()).hexdigest()[:24]
