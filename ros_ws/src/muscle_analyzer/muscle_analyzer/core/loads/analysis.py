# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The result of the muscle analysis of a block of motion."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.report import SolveReport, SolveStatus
from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.sample_status import worst_report
from muscle_analyzer.core.muscles.activation_dynamics import ActivationDynamics


class Origin(NamedTuple):
    """Person and source of a block; see `MuscleAnalysis`."""

    lift_id: str
    source: str
    pseudonym: str
    body_mass: float


@dataclass(frozen=True, eq=False)
class MuscleAnalysis:
    """Muscle forces and L5-S1 loads of n samples.

    A sample whose status is not `OK` is not good data.  Values that could not be computed are NaN;
    torque that too weak muscles leave to the reserves is kept and marked.  The L5-S1 load has
    reports of its own, which are `OK` when muscles are too weak elsewhere than at the lumbar
    joints, and the joint torques have statuses of their own, which do not depend on muscles.

    Attributes
    ----------
    lift_id : str
        Empty outside a lift.
    source : str
        ``'live'``, ``'measured'`` or ``'predicted'``.
    pseudonym, body_mass
        Of the person; mass [kg].
    time : (n,)
        [s].
    muscle_names : tuple of str, n_m
    activation : (n, n_m)
        0 to 1.
    force : (n, n_m)
        Along the tendon [N].
    coordinate_names : tuple of str, n_c
        Coordinates to balance, OpenSim names and signs; the pelvis is not among them.
    torque : (n, n_c)
        Net joint torque to balance [N m].
    reserve : (n, n_c)
        Part of it that reserves took [N m].
    disc_frame : str
        Name of the source of the disc's orientation.
    disc_position : (n, 3)
        Centre of the L5-S1 joint of the musculoskeletal model, world frame (REP-103) [m].
    disc_orientation : (n, 4)
        Quaternion xyzw, world <- disc frame.
    l5_s1_force, l5_s1_moment : (n, 3)
        Of S1 on L5 about the joint centre, in the disc frame (anterior, left, cranial) [N, N m];
        compression is +z, anterior shear -x, lateral shear +y.
    joint_names : tuple of str, n_j
        Lumbar levels, hips and knees (see `joint_loads`).
    joint_force, joint_moment : (n, n_j, 3)
        Of the lower segment on the upper one, in the joint's anatomical frame (anterior, left,
        cranial) [N, N m]; signs as at L5-S1.
    joint_net_force, joint_net_moment : (n, n_j, 3)
        Of joint and muscles together in the same frames [N, N m].
    abdomen_moment : (n, 3)
        Of the sacrum on the abdominal body about its joint at L5-S1, in that body's frame
        (anterior, left, cranial) [N m]: the muscles pull on it with the opposite moment.
    lumbar_balance : str
        Lumbar moments that the muscles balance (see `lumbar_balance.LumbarBalance`).
    abdomen : str
        What carries the pull on the abdominal body (see `lumbar_balance.AbdomenSupport`).
    compression_per_degree, anterior_shear_per_degree : (n,)
        Change per degree of more forward tilt of the disc frame [N / deg].
    net_moment_top_down, net_moment_bottom_up : (n, 3)
        Net moment at L5-S1 from trunk, arms, head and box, and from plates, legs and pelvis;
        world frame (REP-103) [N m].
    pelvis_residual : (n, 6)
        Force [N] and moment about the pelvis' origin [N m] that the motion needs beyond the
        external forces; world frame.
    hand_distance, foot_distance : (n, 2)
        Largest distance of the points of the [right, left] hand and foot between the two
        skeletons after the transfer [m].
    trunk_angle : (n,)
        Angle between the thoraces of the two skeletons [rad].
    hand_angle, foot_angle : (n, 2)
        Angles between hands and feet [right, left] of the two skeletons [rad].
    torque_status : (n,) int
        SolveStatus of torques and net moments.
    spine_reports : tuple of SolveReport, n
        Of the L5-S1 load.
    reports : tuple of SolveReport, n
        Of the muscle forces.  Primal residual: balance of the torques [N m]; dual residual:
        stationarity.
    """

    lift_id: str
    source: str
    pseudonym: str
    body_mass: float
    time: Array
    muscle_names: tuple[str, ...]
    activation: Array
    force: Array
    coordinate_names: tuple[str, ...]
    torque: Array
    reserve: Array
    disc_frame: str
    disc_position: Array
    disc_orientation: Array
    l5_s1_force: Array
    l5_s1_moment: Array
    joint_names: tuple[str, ...]
    joint_force: Array
    joint_moment: Array
    joint_net_force: Array
    joint_net_moment: Array
    abdomen_moment: Array
    lumbar_balance: str
    abdomen: str
    compression_per_degree: Array
    anterior_shear_per_degree: Array
    net_moment_top_down: Array
    net_moment_bottom_up: Array
    pelvis_residual: Array
    hand_distance: Array
    foot_distance: Array
    trunk_angle: Array
    hand_angle: Array
    foot_angle: Array
    torque_status: NDArray[np.int64]
    spine_reports: tuple[SolveReport, ...]
    reports: tuple[SolveReport, ...]

    def __len__(self) -> int:
        """Return the number of samples."""
        return int(self.time.size)

    @property
    def compression(self) -> Array:
        """Compression of the L5-S1 disc (n,) [N]."""
        return self.l5_s1_force[:, 2]

    @property
    def anterior_shear(self) -> Array:
        """Anterior shear at L5-S1 (n,) [N]: positive when L5 is pushed forward on S1."""
        return -self.l5_s1_force[:, 0]

    @property
    def lateral_shear(self) -> Array:
        """Lateral shear at L5-S1 (n,) [N], positive to the left."""
        return self.l5_s1_force[:, 1]

    @property
    def net_moment_difference(self) -> Array:
        """Top-down less bottom-up net moment at L5-S1 (n, 3), world frame [N m]."""
        return self.net_moment_top_down - self.net_moment_bottom_up

    @cached_property
    def status(self) -> NDArray[np.int64]:
        """Status of each sample (n,)."""
        return np.array([int(report.status) for report in self.reports], np.int64)

    @cached_property
    def report(self) -> SolveReport:
        """Report of the worst sample: highest status, then largest residual."""
        return worst_report(self.reports, self.time.tolist())

    @cached_property
    def spine_status(self) -> NDArray[np.int64]:
        """Status of the L5-S1 load of each sample (n,)."""
        return np.array([int(report.status) for report in self.spine_reports], np.int64)

    @cached_property
    def spine_report(self) -> SolveReport:
        """Report of the worst L5-S1 load."""
        return worst_report(self.spine_reports, self.time.tolist())

    @property
    def good_spine_samples(self) -> int:
        """Number of samples whose L5-S1 load is good data."""
        return int(np.count_nonzero(self.spine_status == SolveStatus.OK))

    def excitation(self, dynamics: ActivationDynamics | None = None) -> Array:
        """Return the excitations (n, n_m) that produce the activations (equation 4.13).

        Static optimisation solves each sample alone.  An excitation outside 0 to 1 means that the
        activation changes faster than a muscle can (`activation_dynamics.impossible_fraction`).
        NaN beside samples whose activations are NaN.

        Parameters
        ----------
        dynamics : ActivationDynamics, optional
            Time constants; those of young adults if omitted.

        Raises
        ------
        InputArrayError
            If there are fewer than three samples.
        """
        return (dynamics or ActivationDynamics()).excitation(self.time, self.activation)

    @property
    def peak_compression(self) -> float:
        """Largest L5-S1 compression of the good samples [N]; NaN if there is none."""
        good = self.compression[self.spine_status == SolveStatus.OK]
        return float(good.max()) if good.size else float('nan')


class JoinedParts:
    """Joins the analyses of consecutive parts of a lift when they arrive.

    Parameters
    ----------
    n
        Number of samples of the lift.
    """

    def __init__(self, n: int) -> None:
        self._n = n
        self._arrays: dict[str, NDArray[Any]] = {}
        self._reports: dict[str, list[SolveReport]] = {'reports': [], 'spine_reports': []}
        self._first: MuscleAnalysis | None = None

    def __len__(self) -> int:
        """Return the number of samples so far."""
        return len(self._reports['reports'])

    def add(self, part: MuscleAnalysis) -> None:
        """Add the next part: of the same lift, person and options as the first."""
        if self._first is None:
            self._first = part
            values = {field.name: getattr(part, field.name) for field in fields(part)}
            self._arrays = {
                name: np.empty((self._n, *value.shape[1:]), value.dtype)
                for name, value in values.items()
                if isinstance(value, np.ndarray)
            }
        place = slice(len(self), len(self) + len(part))
        for name, array in self._arrays.items():
            array[place] = getattr(part, name)
        for name, reports in self._reports.items():
            reports.extend(getattr(part, name))

    def whole(self) -> MuscleAnalysis:
        """Return the analysis of the whole lift.

        Raises
        ------
        InputArrayError
            If samples are missing.
        """
        if self._first is None or len(self) != self._n:
            raise InputArrayError(f'{len(self)} of {self._n} samples have been analysed')
        values: dict[str, Any] = {name: tuple(own) for name, own in self._reports.items()}
        values.update(self._arrays)
        return replace(self._first, **values)
