# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compute where OpenSim puts the bodies, markers and muscles of a model in random postures.

The result is stored beside this script and read by the tests, which do not need OpenSim.
Run it in an environment with the ``opensim`` wheel (4.6) and NumPy, never together with CasADi
(both ship ``libcasadi``)::

    python make_model_references.py Rajagopal2015.osim model_Rajagopal2015.npz

Weld constraints are switched off: in the models at hand they close loops of bodies that welds and
locked coordinates join rigidly already.  Positions and lengths in m, moment arms in m about each
independent coordinate with the ones it drives through couplers, coordinate values in rad or m.
"""

from __future__ import annotations

import argparse
import hashlib
from pathlib import Path

import numpy as np
import opensim

#: Seed of the random postures, and share of a coordinate's range left out at either end.
SEED, MARGIN = 20261122, 0.05
#: Ranges that are too wide for a posture are cut to this on either side of zero, rad or m.
WIDEST = {'rotation': 1.5, 'translation': 0.3}


def couplers_of(model: opensim.Model) -> dict[str, tuple[str, opensim.Function]]:
    """Give, for each dependent coordinate, the one that drives it and the function."""
    couplers = {}
    constraints = model.getConstraintSet()
    for i in range(constraints.getSize()):
        coupler = opensim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
        if coupler is not None:
            driver = coupler.getIndependentCoordinateNames().get(0)
            couplers[coupler.getDependentCoordinateName()] = (driver, coupler.getFunction())
    return couplers


def release_welds(model: opensim.Model, state: opensim.State) -> None:
    """Switch off every constraint that is not a coupler."""
    constraints = model.updConstraintSet()
    for i in range(constraints.getSize()):
        constraint = constraints.get(i)
        if opensim.CoordinateCouplerConstraint.safeDownCast(constraint) is None:
            constraint.setIsEnforced(state, False)


def random_posture(model: opensim.Model, names: list[str], rng: np.random.Generator) -> np.ndarray:
    """Return values drawn evenly from the inner part of each coordinate's range."""
    values = []
    for name in names:
        coordinate = model.getCoordinateSet().get(name)
        turns = coordinate.getMotionType() != opensim.Coordinate.Translational
        widest = WIDEST['rotation' if turns else 'translation']
        low = max(coordinate.getRangeMin(), -widest)
        high = min(coordinate.getRangeMax(), widest)
        values.append(low + (high - low) * rng.uniform(MARGIN, 1.0 - MARGIN))
    return np.array(values)


def main() -> None:
    """Read the command line and write one reference file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('model', type=Path)
    parser.add_argument('output', type=Path)
    parser.add_argument('--postures', type=int, default=6)
    arguments = parser.parse_args()

    opensim.Logger.setLevelString('error')
    model = opensim.Model(str(arguments.model))
    state = model.initSystem()
    release_welds(model, state)
    couplers = couplers_of(model)
    coordinates = model.updCoordinateSet()
    every = [coordinates.get(i).getName() for i in range(coordinates.getSize())]
    names = [n for n in every if n not in couplers and not coordinates.get(n).get_locked()]
    bodies = model.getBodySet()
    muscles = model.getMuscles()
    markers = model.getMarkerSet()
    rng = np.random.default_rng(SEED)
    rows: dict[str, list] = {key: [] for key in ('posture', 'position', 'rotation', 'marker')}
    rows |= {'length': [], 'moment_arm': []}
    for _ in range(arguments.postures):
        posture = random_posture(model, names, rng)
        rows['posture'].append(posture)
        values = dict(zip(names, posture, strict=True))
        for name, value in values.items():
            coordinates.get(name).setValue(state, value, False)
        for name, (driver, function) in couplers.items():
            if driver in values:
                value = function.calcValue(opensim.Vector(1, values[driver]))
                coordinates.get(name).setValue(state, value, False)
        model.realizePosition(state)
        frames = [bodies.get(i).getTransformInGround(state) for i in range(bodies.getSize())]
        rows['position'].append([[frame.p().get(k) for k in range(3)] for frame in frames])
        rows['rotation'].append(
            [[[f.R().get(i, j) for j in range(3)] for i in range(3)] for f in frames]
        )
        places = [markers.get(i).getLocationInGround(state) for i in range(markers.getSize())]
        rows['marker'].append([[place.get(k) for k in range(3)] for place in places])
        paths = [
            opensim.GeometryPath.safeDownCast(muscles.get(i).getPath())
            for i in range(muscles.getSize())
        ]
        rows['length'].append([path.getLength(state) for path in paths])
        rows['moment_arm'].append(
            [[p.computeMomentArm(state, coordinates.get(name)) for name in names] for p in paths]
        )
    digest = hashlib.sha256(arguments.model.read_bytes()).hexdigest()
    np.savez_compressed(
        arguments.output,
        source=f'OpenSim {opensim.GetVersion()}, {arguments.model.name}, sha256 {digest}',
        sha256=digest,
        coordinates=names,
        bodies=[bodies.get(i).getName() for i in range(bodies.getSize())],
        markers=[markers.get(i).getName() for i in range(markers.getSize())],
        muscles=[muscles.get(i).getName() for i in range(muscles.getSize())],
        **{key: np.array(value) for key, value in rows.items() if key != 'moment_arm'},
        # Single precision is exact to 1e-8 m and halves the file.
        moment_arm=np.array(rows['moment_arm'], np.float32),
    )


if __name__ == '__main__':
    main()
