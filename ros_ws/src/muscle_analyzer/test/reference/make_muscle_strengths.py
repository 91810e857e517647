# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compute with OpenSim what Millard and Thelen muscles can do in random postures at random speeds.

Run it in an environment with the ``opensim`` wheel (4.6) and NumPy::

    python make_muscle_strengths.py muscle_strengths.npz Rajagopal2015.osim GPK_generic.osim \
        arm26_ball.osim

Stored of each model (under its name): path lengths [m] and lengthening speeds [m/s], the force
along the tendon of the fully active muscle with a rigid tendon (``active``) and the passive force
(``passive``, Millard's only) [N]; and samples of the curves, with the properties that they have by
default and with others.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import opensim

SEED, POSTURES = 20261122, 4
#: Properties of the sampled curves: of active force and length, of force and velocity, of passive
#: force and length.
ACTIVE = {
    'min_norm_active_fiber_length': 0.35,
    'transition_norm_fiber_length': 0.8,
    'max_norm_active_fiber_length': 1.7,
    'shallow_ascending_slope': 0.7,
    'minimum_value': 0.05,
}
VELOCITY = {
    'concentric_slope_at_vmax': 0.1,
    'concentric_slope_near_vmax': 0.3,
    'isometric_slope': 4.5,
    'eccentric_slope_at_vmax': 0.05,
    'eccentric_slope_near_vmax': 0.2,
    'max_eccentric_velocity_force_multiplier': 1.5,
    'concentric_curviness': 0.7,
    'eccentric_curviness': 0.8,
}
PASSIVE = {
    'strain_at_zero_force': 0.1,
    'strain_at_one_norm_force': 0.6,
    'stiffness_at_low_force': 0.3,
    'stiffness_at_one_norm_force': 4.5,
    'curviness': 0.6,
}


def samples(curve, properties: dict[str, float], at: np.ndarray) -> np.ndarray:
    """Return a curve's values with the given properties, and with its defaults."""
    plain = [curve.calcValue(float(x)) for x in at]
    for name, value in properties.items():
        getattr(curve, f'set_{name}')(value)
    curve.ensureCurveUpToDate()
    return np.array([plain, [curve.calcValue(float(x)) for x in at]])


def strengths(path: Path, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Return lengths, speeds and forces (n, n_m) of a model's muscles."""
    model = opensim.Model(str(path))
    muscles = model.updMuscles()
    # OpenSim has no rigid tendon for the passive force of Thelen's muscle.
    rigid = all(
        muscles.get(i).getConcreteClassName() == 'Millard2012EquilibriumMuscle'
        for i in range(muscles.getSize())
    )
    for i in range(muscles.getSize() if rigid else 0):
        muscle = opensim.Millard2012EquilibriumMuscle.safeDownCast(muscles.get(i))
        muscle.set_ignore_tendon_compliance(True)
        # The passive force would have the damping of the fibres in it.
        muscle.set_fiber_damping(0.0)
    state = model.initSystem()
    coordinates = model.updCoordinateSet()
    rows: dict[str, list] = {key: [] for key in ('length', 'speed', 'active', 'passive')}
    for _ in range(POSTURES):
        for i in range(coordinates.getSize()):
            coordinate = coordinates.get(i)
            if coordinate.getLocked(state):
                continue
            low, high = max(coordinate.getRangeMin(), -1.0), min(coordinate.getRangeMax(), 1.0)
            coordinate.setValue(state, rng.uniform(low, high), False)
            coordinate.setSpeedValue(state, rng.uniform(-6.0, 6.0))
        model.realizeVelocity(state)
        each = [muscles.get(i) for i in range(muscles.getSize())]
        rows['length'].append([muscle.getLength(state) for muscle in each])
        rows['speed'].append([muscle.getLengtheningSpeed(state) for muscle in each])
        if rigid:
            # OpenSim's calcInextensibleTendonActiveFiberForce gives Millard's force along the
            # fibres, not along the tendon.
            model.realizeDynamics(state)
            rows['active'].append(
                [m.getActiveFiberForceAlongTendon(state) / m.getActivation(state) for m in each]
            )
            rows['passive'].append([m.getPassiveFiberForceAlongTendon(state) for m in each])
        else:
            rows['active'].append(
                [m.calcInextensibleTendonActiveFiberForce(state, 1.0) for m in each]
            )
    return {f'{path.stem}_{key}': np.array(value) for key, value in rows.items()}


def main() -> None:
    """Read the command line and write the reference file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('output', type=Path)
    parser.add_argument('models', type=Path, nargs='+')
    arguments = parser.parse_args()
    opensim.Logger.setLevelString('error')
    length, velocity = np.linspace(0.2, 2.0, 91), np.linspace(-1.3, 1.3, 79)
    rng = np.random.default_rng(SEED)
    found = {
        'length': length,
        'velocity': velocity,
        'active': samples(opensim.ActiveForceLengthCurve(), ACTIVE, length),
        'rate': samples(opensim.ForceVelocityCurve(), VELOCITY, velocity),
        'passive': samples(opensim.FiberForceLengthCurve(), PASSIVE, length),
    }
    for path in arguments.models:
        found |= strengths(path, rng)
    source = f'OpenSim {opensim.GetVersion()}, {", ".join(path.name for path in arguments.models)}'
    np.savez_compressed(arguments.output, source=source, **found)


if __name__ == '__main__':
    main()
