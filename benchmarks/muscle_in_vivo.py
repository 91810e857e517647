# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lumbar loads beside measurements in living people, and what the lumbar balance leaves open.

Wilke et al. 1999 measured the pressure in one L4-L5 disc; `docs/data/wilke_tasks.yaml` has the
tasks.  The page `docs/in_vivo.md` and its figure are written with the figures.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import yaml
from benchmarks.in_vivo_postures import Posture, PostureSolver

from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array
from lifting_cli.recorded_lifts import recorded_lifts
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.equivalent_extensor import equivalent_compression
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.lumbar_moments import lumbar_moments
from muscle_analyzer.core.loads.muscle_model import read_generic_model, scaled_model
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.recruitment.reserves import read_reserves
from muscle_analyzer.core.subject.segment_masses import MassDistribution

ROOT: Final = Path(__file__).resolve().parents[1]
TASKS: Final = ROOT / 'docs' / 'data' / 'wilke_tasks.yaml'
BAGS: Final = ('symmetric_7kg', 'symmetric_12kg', 'symmetric_max', 'asymmetric_7kg')
PLACES: Final = ('near', 'far')
#: Force of a disc [N] for a pressure of 1 MPa: 0.66 of its area (Dreischarf et al. 2013), which is
#: 1800 mm^2 (Wilke et al. 2001).
FORCE_OF_PRESSURE: Final = 0.66 * 1800.0
#: The two lifts whose order is compared.
STOOP, SQUAT = '20 kg lifted, round back', '20 kg lifted, knees bent'
#: Reserves of the levels, N m at unit control, whose effect is shown.
SPREAD: Final = (2.0, 5.0, 10.0)

DEFAULT: Final = MuscleAnalyzerOptions()
FORMS: Final = {
    'OpenSim': DEFAULT.as_opensim(),
    'sacrum': replace(DEFAULT, lumbar_balance='coupled', abdomen='sacrum'),
    'levels': replace(DEFAULT, lumbar_balance='levels'),
}


@dataclass(frozen=True, eq=False)
class TaskLoads:
    """Loads of one task.

    Attributes
    ----------
    posture : Posture
    moment : float
        Net extension moment at L5-S1 [N m].
    compression : dict of str to ndarray, shape (n_j,)
        Of the joints, by form of the model [N].
    equivalent : float
        Compression of L4-L5 with one equivalent extensor at 50 mm [N].
    """

    posture: Posture
    moment: float
    compression: dict[str, Array]
    equivalent: float


class InVivo:
    """The tasks of the file, computed in each form of the model."""

    def __init__(self) -> None:
        self.file: dict[str, Any] = yaml.safe_load(TASKS.read_text(encoding='utf-8'))
        person = self.file['subject']
        subject = Subject('wilke', person['sex'], person['mass'], person['stature'], person['age'])
        generic, skeleton = read_generic_model(DEFAULT), Skeleton3D.of(subject)
        self.model = scaled_model(generic, skeleton, subject, DEFAULT).multibody
        segments = replace(DEFAULT, mass_distribution=MassDistribution.SEGMENTS)
        heavier = scaled_model(generic, skeleton, subject, segments).multibody
        self.solvers = {name: LoadSolver(self.model, form) for name, form in FORMS.items()}
        self.solvers['levels, segment masses'] = LoadSolver(heavier, FORMS['levels'])
        for torque in SPREAD:
            self.solvers[f'levels, reserves {torque:g} N·m'] = self._with_reserves(torque)
        self.names = self.solvers['levels'].joint_names
        self._postures = PostureSolver(self.model)
        self.loads = {
            (name, place): self._loads(task, task.get(place))
            for name, task in (self.file['tasks'] | self.file['anchors']).items()
            for place in PLACES
            if place in task or not set(PLACES) & set(task)
        }

    def _with_reserves(self, torque: float) -> LoadSolver:
        solver = self.solvers['levels']
        reserves = tuple(
            replace(reserve, torque=torque) if reserve.coordinate in solver.lumbar else reserve
            for reserve in read_reserves(solver.coordinate_names, levels=True)
        )
        return LoadSolver(self.model, FORMS['levels'], reserves)

    def _loads(self, task: dict[str, Any], place: dict[str, Any] | None) -> TaskLoads:
        posture = self._postures.solve(task, place, self.file['crate_mass'])
        still = np.zeros((1, posture.q.size))
        compression = {}
        for name, solver in self.solvers.items():
            solver.reset()
            found = solver.solve_block(posture.q[None], still, still, posture.external[None])
            if not found.converged[0]:
                raise RuntimeError(f'{task}: {name} did not converge')
            compression[name] = found.joint_force[0, :, 2].copy()
            if name == 'levels':
                force, moment = found.joint_net_force[0], found.joint_net_moment[0]
        disc = self.names.index('l4_l5')
        equivalent = equivalent_compression(force[[disc]], moment[[disc]])
        return TaskLoads(posture, float(-moment[0, 1]), compression, float(equivalent[0]))

    def pressure(self, task: str, place: str, form: str) -> float:
        """Return the pressure of the L4-L5 disc [MPa]."""
        loads = self.loads[task, place]
        if form == EQUIVALENT:
            return loads.equivalent / FORCE_OF_PRESSURE
        return float(loads.compression[form][self.names.index('l4_l5')]) / FORCE_OF_PRESSURE

    def rmse(self, place: str, form: str) -> float:
        """Return the error over the tasks [MPa]."""
        errors = [
            self.pressure(name, place, form) - task['pressure']
            for name, task in self.file['tasks'].items()
        ]
        return float(np.sqrt(np.mean(np.square(errors))))

    def order_kept(self, form: str) -> bool:
        """Whether a round back loads more than bent knees, with the near and the far crate."""
        return all(
            self.pressure(STOOP, place, form) > self.pressure(SQUAT, place, form)
            for place in PLACES
        )


EQUIVALENT: Final = 'one extensor at 50 mm'


@dataclass(frozen=True)
class BagRow:
    """The measured lift of a bag in one form.

    Attributes
    ----------
    compression, shear, upper : float
        Peaks at L5-S1, and of compression at L4-L5 [N].
    bad, spine_bad : int
        Samples without solution, and those whose L5-S1 load is not good.
    unassigned : float
        Largest part of the moment carried by constraints [%].
    reserve : float
        Largest reserve of a lumbar coordinate [N m].
    equivalent : float
        Peak compression of L5-S1 with one equivalent extensor [N].
    """

    compression: float
    shear: float
    upper: float
    bad: int
    spine_bad: int
    unassigned: float
    reserve: float
    equivalent: float


def bag_rows() -> dict[tuple[str, str], BagRow]:
    """Return the measured lifts of the bags in each form."""
    rows = {}
    for bag in BAGS:
        recorded = recorded_lifts(ROOT / 'bags' / bag)
        motion = recorded.lift(1).lift.motion
        for form, options in FORMS.items():
            analysis = MuscleAnalyzer(recorded.subject, options).analyze(motion, bag, 'measured')
            names = analysis.coordinate_names
            lumbar = [
                j for j, name in enumerate(names) if name[:2] in {'L5', 'L4', 'L3', 'L2', 'L1'}
            ]
            lumbosacral = analysis.joint_net_force[:, 0], analysis.joint_net_moment[:, 0]
            rows[bag, form] = BagRow(
                analysis.peak_compression,
                float(np.nanmax(analysis.anterior_shear)),
                float(np.nanmax(analysis.joint_force[:, 1, 2])),
                int(np.count_nonzero(analysis.status)),
                int(np.count_nonzero(analysis.spine_status)),
                100.0 * float(np.nanmax(lumbar_moments(analysis).unassigned)),
                float(np.nanmax(np.abs(analysis.reserve[:, lumbar]))),
                float(np.nanmax(equivalent_compression(*lumbosacral))),
            )
    return rows


def run() -> dict[str, float]:
    """Return the figures by name, of the default options; write the page."""
    from benchmarks.in_vivo_page import write_page

    found, bags = InVivo(), bag_rows()
    write_page(found, bags)
    form = next(name for name, options in FORMS.items() if options == DEFAULT)
    own = [row for (_, name), row in bags.items() if name == form]
    standing = found.pressure('standing', 'near', form)
    return {
        'wilke_rmse_mpa_near': found.rmse('near', form),
        'wilke_rmse_mpa_far': found.rmse('far', form),
        'wilke_order_kept': float(found.order_kept(form)),
        'wilke_standing_error_percent': 100.0 * (standing / 0.5 - 1.0),
        'unassigned_moment_percent_max': max(row.unassigned for row in own),
        'reserve_moment_nm_max': max(row.reserve for row in own),
        'bags_bad_samples': float(sum(row.bad for row in own)),
        'bags_bad_spine_samples': float(sum(row.spine_bad for row in own)),
    }
