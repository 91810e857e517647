# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The musculoskeletal model alone: muscle paths and muscle recruitment at a posture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array
from muscle_analyzer.core.exceptions import UnknownNameError
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.curves import strength
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.osim.model_cache import load_model
from muscle_analyzer.core.recruitment.static_optimization import MuscleBalance
from muscle_analyzer.core.subject.model import SubjectModel, subject_model
from muscle_analyzer.core.subject.model_file import lifting_model_path
from muscle_analyzer.core.subject.muscle_strength import force_factors
from muscle_analyzer.core.subject.segment_masses import MassDistribution, segment_masses


def read_generic_model(options: MuscleAnalyzerOptions) -> OsimModel:
    """Return the generic model that the options name.

    Raises
    ------
    MuscleAnalyzerError
        If the model cannot be read.
    """
    return load_model(options.model_path or lifting_model_path())


def scaled_model(
    generic: OsimModel, skeleton: Skeleton3D, subject: Subject, options: MuscleAnalyzerOptions
) -> SubjectModel:
    """Return the generic model scaled to a subject.

    Raises
    ------
    MuscleAnalyzerError
        If the model cannot be scaled or an option cannot be used.
    """
    segments = options.mass_distribution is MassDistribution.SEGMENTS
    return subject_model(
        generic,
        skeleton.points(np.zeros(len(skeleton.coordinates))),
        skeleton.parameters.lengths,
        subject.mass,
        force_factors(generic, subject, options.muscle_strength),
        segment_masses(skeleton) if segments else None,
    )


class MuscleModel:
    """The musculoskeletal model of a subject, or the generic model.

    Parameters
    ----------
    subject : Subject, optional
        Without a subject the model is the generic one.
    options : MuscleAnalyzerOptions, optional
        Lumbar balance and abdomen are always those of OpenSim.

    Attributes
    ----------
    muscle_names, coordinate_names : tuple of str
        Muscles, and independent coordinates of the model.

    Raises
    ------
    MuscleAnalyzerError
        If the model cannot be read or scaled, or an option cannot be used.
    HumanModelError
        If the subject's measures cannot be used.
    """

    def __init__(
        self, subject: Subject | None = None, options: MuscleAnalyzerOptions | None = None
    ) -> None:
        # Its coordinates are those of the model's file, coupled as in OpenSim.
        options = (options or MuscleAnalyzerOptions()).as_opensim()
        generic = read_generic_model(options)
        if subject is None:
            self._multibody = compile_model(generic)
        else:
            skeleton = Skeleton3D.of(subject)
            self._multibody = scaled_model(generic, skeleton, subject, options).multibody
        self._solver = LoadSolver(self._multibody, options)
        self.muscle_names = self._solver.muscle_names
        self.coordinate_names = self._multibody.coordinate_names

    def posture(self, **coordinates: float) -> MusclePosture:
        """Return the muscles at a posture.

        Parameters
        ----------
        coordinates
            Values of independent coordinates by name [rad or m]; the others have their default
            values.

        Raises
        ------
        UnknownNameError
            If the model has no such coordinate.
        """
        q = self._multibody.default.copy()
        for name, value in coordinates.items():
            q[self._multibody.coordinate_index(name)] = value
        zero = np.zeros_like(q)
        tree, model = self._multibody.tree, self._solver.sample_model
        state = forward_kinematics(tree, q, zero, zero)
        paths = posture_paths(model.paths, state, body_jacobians(tree, state))
        active, passive = model.muscles.max_isometric_force, np.zeros(paths.length.size)
        if model.force_length_velocity:
            speed = np.zeros_like(paths.length)
            active, passive = strength(model.muscles, paths.length, speed, model.passive_force)
        return MusclePosture(
            self._solver,
            self._multibody.coordinate_names,
            q,
            paths.length,
            paths.moment_arm,
            active,
            passive,
        )


@dataclass(frozen=True, eq=False)
class MusclePosture:
    """Muscles at a posture; made by `MuscleModel.posture`.

    Attributes
    ----------
    solver : LoadSolver
        Of the model.
    coordinate_names : tuple of str, n_q
    q : ndarray, shape (n_q,)
        Independent coordinates [rad or m].
    lengths : ndarray, shape (n_m,)
        Path lengths [m].
    moment_arms : ndarray, shape (n_m, n_q)
        Of every muscle about every coordinate [m/rad or m/m].
    active, passive : ndarray, shape (n_m,)
        Muscle force per unit activation, and without activation [N].
    """

    solver: LoadSolver
    coordinate_names: tuple[str, ...]
    q: Array
    lengths: Array
    moment_arms: Array
    active: Array
    passive: Array

    @property
    def length(self) -> Mapping[str, float]:
        """Path length of every muscle by name [m]."""
        return dict(zip(self.solver.muscle_names, self.lengths.tolist(), strict=True))

    def moment_arm(self, muscle: str, coordinate: str) -> float:
        """Return the moment arm of a muscle about a coordinate [m/rad or m/m].

        Raises
        ------
        UnknownNameError
            If the model has no such muscle or coordinate.
        """
        row = _index(self.solver.muscle_names, muscle, 'muscle')
        return float(
            self.moment_arms[row, _index(self.coordinate_names, coordinate, 'coordinate')]
        )

    def recruit(self, **torques: float) -> MuscleBalance:
        """Return the activations for joint torques, by static optimisation (equation 4.10).

        Parameters
        ----------
        torques
            Joint torque about coordinates by name [N m]; zero about the others.

        Raises
        ------
        UnknownNameError
            If muscles do not balance a coordinate of that name.
        """
        solver = self.solver
        torque = np.zeros(len(solver.coordinate_names))
        for name, value in torques.items():
            torque[_index(solver.coordinate_names, name, 'balanced coordinate')] = value
        arms = self.moment_arms[:, solver.sample_model.balanced].T
        solver.reset()
        return solver.optimization.solve(arms * self.active, torque - arms @ self.passive)


def _index(names: tuple[str, ...], name: str, kind: str) -> int:
    if name not in names:
        raise UnknownNameError(f'there is no {kind} {name!r}')
    return names.index(name)
