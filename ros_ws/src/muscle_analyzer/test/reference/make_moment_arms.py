# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compute reference muscle lengths, moment arms and curve values with OpenSim.

The result is stored beside this script and read by the tests, which do not need OpenSim.
Run it in an environment with the ``opensim`` wheel (4.6) and NumPy, never together with
CasADi (both ship ``libcasadi``)::

    python make_moment_arms.py generic Model_Pose2Sim_muscles_flex.osim moment_arms_generic.npz
    python make_moment_arms.py motion lfb_subject4.osim moment_arms_squats.npz \
        --motion ik.mot --times 1.0 1.2 1.4
    python make_moment_arms.py curves lfb_subject4.osim muscle_curves.npz

Lengths in m, moment arms in m (about a coordinate that drives others through coupler
constraints: of all joints it drives), coordinate values in rad or m.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import opensim

#: Share of a coordinate's range left out at either end of the random postures.
MARGIN = 0.1
#: Seed and number of the random postures.
SEED, POSTURES = 20261122, 12
#: Range used for a coordinate of the pelvis (rad or m), which moves no muscle.
PELVIS_RANGE = (-0.3, 0.3)

#: What is stored of each muscle's fibres, in this order.
FIBRE_KEYS = (
    'path_length',
    'path_velocity',
    'fibre_length',
    'pennation',
    'fibre_velocity',
    'optimal_fibre_length',
    'tendon_slack_length',
    'pennation_at_optimal',
    'max_velocity',
)


def coupled(model: opensim.Model) -> dict[str, tuple[str, opensim.Function]]:
    """Give, for each dependent coordinate, the one that drives it and the function."""
    couplers = {}
    for i in range(model.getConstraintSet().getSize()):
        coupler = opensim.CoordinateCouplerConstraint.safeDownCast(model.getConstraintSet().get(i))
        driver = coupler.getIndependentCoordinateNames().get(0)
        couplers[coupler.getDependentCoordinateName()] = (driver, coupler.getFunction())
    return couplers


def set_posture(
    model: opensim.Model,
    state: opensim.State,
    couplers: dict[str, tuple[str, opensim.Function]],
    posture: dict[str, float],
) -> None:
    """Set independent coordinates as given and the dependent ones by their functions."""
    coordinates = model.updCoordinateSet()
    for name, value in posture.items():
        coordinates.get(name).setValue(state, value, False)
    for name, (driver, function) in couplers.items():
        value = function.calcValue(opensim.Vector(1, posture[driver]))
        coordinates.get(name).setValue(state, value, False)
    model.realizePosition(state)


def lengths_and_arms(
    model: opensim.Model, state: opensim.State, about: list[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Return path lengths (n_m,) and moment arms (n_m, n_c) of all muscles, m."""
    muscles = model.getMuscles()
    coordinates = model.getCoordinateSet()
    lengths = np.zeros(muscles.getSize())
    arms = np.zeros((muscles.getSize(), len(about)))
    for i in range(muscles.getSize()):
        path = opensim.GeometryPath.safeDownCast(muscles.get(i).getPath())
        lengths[i] = path.getLength(state)
        for j, name in enumerate(about):
            arms[i, j] = path.computeMomentArm(state, coordinates.get(name))
    return lengths, arms


def random_postures(model: opensim.Model, names: list[str]) -> list[dict[str, float]]:
    """Return postures drawn evenly from the inner part of each coordinate's range."""
    rng = np.random.default_rng(SEED)
    postures = []
    for _ in range(POSTURES):
        posture = {}
        for name in names:
            coordinate = model.getCoordinateSet().get(name)
            low, high = coordinate.getRangeMin(), coordinate.getRangeMax()
            if name.startswith('pelvis'):
                low, high = PELVIS_RANGE
            posture[name] = low + (high - low) * rng.uniform(MARGIN, 1.0 - MARGIN)
        postures.append(posture)
    return postures


def motion_postures(
    path: Path, times: list[float], model: opensim.Model, names: list[str]
) -> list[dict[str, float]]:
    """Return the postures of a motion file at the samples nearest to the given times."""
    table = opensim.TimeSeriesTable(str(path))
    if table.getTableMetaDataString('inDegrees') == 'yes':
        model.getSimbodyEngine().convertDegreesToRadians(table)
    stamps = np.array(table.getIndependentColumn())
    columns = {name: table.getDependentColumn(name).to_numpy() for name in names}
    rows = [int(np.abs(stamps - time).argmin()) for time in times]
    return [{name: float(columns[name][row]) for name in names} for row in rows]


def curve_samples(model: opensim.Model) -> dict[str, np.ndarray]:
    """Return the multipliers of the first muscle's curves on a grid."""
    muscle = opensim.DeGrooteFregly2016Muscle.safeDownCast(model.getMuscles().get(0))
    muscle.set_ignore_passive_fiber_force(False)
    length = np.linspace(0.3, 1.7, 57)
    velocity = np.linspace(-1.2, 1.2, 49)
    return {
        'active_force_width_scale': np.array(muscle.get_active_force_width_scale()),
        'passive_strain': np.array(muscle.get_passive_fiber_strain_at_one_norm_force()),
        'normalised_length': length,
        'active': np.array([muscle.calcActiveForceLengthMultiplier(x) for x in length]),
        'passive': np.array([muscle.calcPassiveForceMultiplier(x) for x in length]),
        'normalised_velocity': velocity,
        'velocity': np.array([muscle.calcForceVelocityMultiplier(x) for x in velocity]),
    }


def rigid_tendon_samples(
    model: opensim.Model, state: opensim.State, couplers: dict, posture: dict[str, float]
) -> dict[str, np.ndarray]:
    """Return fibre lengths, pennation angles and fibre velocities of all muscles."""
    rng = np.random.default_rng(SEED)
    set_posture(model, state, couplers, posture)
    for name in posture:
        model.updCoordinateSet().get(name).setSpeedValue(state, rng.uniform(-1.0, 1.0))
    model.realizeVelocity(state)
    rows = []
    for i in range(model.getMuscles().getSize()):
        muscle = model.getMuscles().get(i)
        rows.append(
            (
                muscle.getLength(state),
                muscle.getLengtheningSpeed(state),
                muscle.getFiberLength(state),
                muscle.getPennationAngle(state),
                muscle.getFiberVelocity(state),
                muscle.getOptimalFiberLength(),
                muscle.getTendonSlackLength(),
                muscle.getPennationAngleAtOptimalFiberLength(),
                muscle.getMaxContractionVelocity(),
            )
        )
    return dict(zip(FIBRE_KEYS, np.array(rows).T, strict=True))


def main() -> None:
    """Read the command line and write one reference file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('what', choices=('generic', 'motion', 'curves'))
    parser.add_argument('model', type=Path)
    parser.add_argument('output', type=Path)
    parser.add_argument('--motion', type=Path)
    parser.add_argument('--times', type=float, nargs='*', default=[])
    arguments = parser.parse_args()

    model = opensim.Model(str(arguments.model))
    state = model.initSystem()
    couplers = coupled(model)
    coordinates = model.getCoordinateSet()
    names = [coordinates.get(i).getName() for i in range(coordinates.getSize())]
    names = [
        name for name in names if name not in couplers and not coordinates.get(name).get_locked()
    ]
    muscles = [model.getMuscles().get(i).getName() for i in range(model.getMuscles().getSize())]
    source = f'OpenSim {opensim.GetVersion()}, {arguments.model.name}'

    if arguments.what == 'curves':
        samples = curve_samples(model)
        posture = random_postures(model, names)[0]
        samples |= rigid_tendon_samples(model, state, couplers, posture)
        np.savez_compressed(arguments.output, source=source, muscles=muscles, **samples)
        return

    if arguments.what == 'motion':
        postures = motion_postures(arguments.motion, arguments.times, model, names)
        source += f', {arguments.motion.name}'
    else:
        postures = random_postures(model, names)
    about = [name for name in names if not name.startswith('pelvis')]
    results = []
    for posture in postures:
        set_posture(model, state, couplers, posture)
        results.append(lengths_and_arms(model, state, about))
    np.savez_compressed(
        arguments.output,
        source=source,
        muscles=muscles,
        coordinates=names,
        posture=np.array([[posture[name] for name in names] for posture in postures]),
        times=np.array(arguments.times),
        arm_coordinates=about,
        length=np.array([length for length, _ in results]),
        moment_arm=np.array([arm for _, arm in results]),
    )


if __name__ == '__main__':
    main()
