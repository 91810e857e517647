# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Motions on musculoskeletal models that the muscle analysis and OpenSim both compute.

Real squats (OpenSim's own inverse kinematics on its scaled model, `ik.mot`, and the plates of the
recording), the asymmetric lift of 7 kg as the graph tracks and transfers it, and the first of
these on the 80-muscle gait model of Rajagopal et al. 2016. Rates are those of quintic splines
through the positions, which is what OpenSim takes.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from human_model.opensim_storage import read_storage
from lifting_cli.recorded_lifts import recorded_lifts
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.opensim_bridge.derivatives import smooth
from muscle_analyzer.core.opensim_bridge.export import read_coordinates
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel, motion_on_model
from muscle_analyzer.core.opensim_bridge.setup_files import PointForce
from muscle_analyzer.core.osim.reader import read_osim

ROOT: Final = Path(__file__).resolve().parents[1]
SQUATS: Final = ROOT.parent / 'shared' / 'data' / 'squats_bodyweight'
ASYMMETRIC: Final = ROOT / 'bags' / 'asymmetric_7kg'
GAIT_MODEL: Final = ROOT / '.cache' / 'reference_models' / 'Rajagopal2015.osim'
CUTOFF: Final = 6.0
"""Low-pass of the coordinates, as in the reference of the squats [Hz]."""
PLATES: Final = {'calcn_r': 1, 'calcn_l': 2}
"""Body and number of the plate under it in the squats' recording."""
LUMBAR: Final = {
    'lumbar_extension': 'L5_S1_Flex_Ext',
    'lumbar_bending': 'L5_S1_Lat_Bending',
    'lumbar_rotation': 'L5_S1_axial_rotation',
}
"""Coordinates of the gait model's one lumbar joint and what they follow."""


@dataclass(frozen=True, eq=False)
class BenchMotion:
    """A motion to be analysed.

    Attributes
    ----------
    name
        In file names and figures.
    motion
        On its model, with splined rates.
    original
        The model's own file, where OpenSim can take that in place of the one written here.
    """

    name: str
    motion: MotionOnModel
    original: Path | None = None


def squats() -> BenchMotion:
    """Give the real squats; `SQUATS` must be there."""
    reference = SQUATS / 'opensim46_reference'
    path = reference / 'lfb_subject4.osim'
    model = compile_model(read_osim(path))
    time, q = read_coordinates(reference / 'ik.mot', model)
    plates = read_storage(SQUATS / 'squats1_grf.mot')
    forces = tuple(
        PointForce(
            f'ground_force_{body}',
            body,
            *(
                plates.at(time)[
                    :, [plates.columns.index(f'ground_force_{number}_{kind}{a}') for a in 'xyz']
                ]
                for kind in 'vpm'
            ),
        )
        for body, number in PLATES.items()
    )
    zero = np.zeros_like(q)
    motion = MotionOnModel(model, time, smooth(time, q, CUTOFF), zero, zero, forces)
    return BenchMotion('squats', motion.with_splined_rates(), path)


def asymmetric() -> BenchMotion:
    """Give the asymmetric lift of 7 kg as the analysis takes it over."""
    recorded = recorded_lifts(ASYMMETRIC)
    analyzer = MuscleAnalyzer(recorded.subject)
    body = recorded.lift(1).lift.motion
    transfer = analyzer.new_transfer(body.skeleton)
    motion = motion_on_model(transfer, body, recorded.start)
    return BenchMotion('asymmetric', motion.with_splined_rates())


def gait(given: MotionOnModel) -> BenchMotion:
    """Give a motion on the unscaled gait model: coordinates by name, within their ranges.

    Those that the gait model does not share stay at their defaults. The forces of the ground stay
    as recorded, so the model's pelvis carries what does not fit its size: this tells how fast and
    how equally both programs compute, and nothing of a person.
    """
    model = compile_model(read_osim(GAIT_MODEL))
    names = given.model.coordinate_names
    q = np.tile(model.default, (given.time.size, 1))
    for k, name in enumerate(model.coordinate_names):
        source = LUMBAR.get(name, name)
        if source in names:
            lower, upper = model.lower[k], model.upper[k]
            q[:, k] = np.clip(given.q[:, names.index(source)], lower, upper)
    zero = np.zeros_like(q)
    forces = tuple(force for force in given.forces if force.body in PLATES)
    motion = MotionOnModel(model, given.time, q, zero, zero, forces)
    return BenchMotion('rajagopal', motion.with_splined_rates())
