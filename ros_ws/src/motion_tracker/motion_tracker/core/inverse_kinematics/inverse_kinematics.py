# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint coordinates from markers: weighted least squares on the 40-DOF skeleton.

Weak priors determine the coordinates that the markers do not determine. Their weights are small
against the curvature of the marker terms (0.01 m^2 per unit weight, 0.1 m off the axis):

- every coordinate but those of the pelvis' place is drawn to the neutral posture;
- the two spine joints are drawn to share their sum as the lumbar rhythm does
  (``data/spine_prior.csv``): weakly when the lumbar segment carries a marker; firmly when not,
  because then only the sum is seen and its split would follow errors of the trunk's lengths;
- a coordinate that the full marker set determines, but not the markers of this frame, keeps its
  previous value, and the status of the frame is not OK.
"""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from human_model.compiled import point_positions
from human_model.report import SolveStatus
from human_model.skeleton import Skeleton
from human_model.typing import Array
from motion_tracker.core.exceptions import InverseKinematicsError
from motion_tracker.core.inverse_kinematics.judgement import judge
from motion_tracker.core.inverse_kinematics.kernel import fit, marked, misfit
from motion_tracker.core.inverse_kinematics.normal_equations import observed_curvature
from motion_tracker.core.inverse_kinematics.solution import IKSettings, IKSolution, Observed
from motion_tracker.core.inverse_kinematics.spine_prior import spine_prior
from motion_tracker.core.markers.marker_model import MarkerModel
from motion_tracker.core.markers.marker_set import mirror_name

_PLACE = ('pelvis_tx', 'pelvis_ty', 'pelvis_tz', 'pelvis_tilt', 'pelvis_list', 'pelvis_rotation')

#: Greatest number of cached sets of markers.
_CACHED_MARKER_SETS = 256

#: Postures tried when there is no previous frame: standing, half and deep squat, as multiples.
_CROUCH = {'hip_flexion': 1.4, 'knee_angle': 1.5, 'ankle_angle': 0.3}
_STARTS = (0.0, 0.6, 1.2)


class InverseKinematics:
    """Fit of a skeleton to the markers of a `MarkerModel`.

    Parameters
    ----------
    skeleton
        Of the person, 3D.
    model
        Where the markers sit.
    settings
        Weights and limits.
    neutral
        Weights [m^2/rad^2] that draw single coordinates to the neutral posture, in place of
        ``neutral_weight``.

    Raises
    ------
    InverseKinematicsError
        If the markers cannot determine the pelvis.
    """

    def __init__(
        self,
        skeleton: Skeleton,
        model: MarkerModel,
        settings: IKSettings | None = None,
        neutral: Mapping[str, float] | None = None,
    ) -> None:
        self.skeleton = skeleton
        self.model = model
        self.settings = settings or IKSettings()
        tree = skeleton.tree
        self._segment = np.array(
            [skeleton.parameters.index(name) for name in model.segments], dtype=np.int64
        )
        self._body = np.ascontiguousarray(tree.segment_body[self._segment], dtype=np.int64)
        self._local = np.ascontiguousarray(tree.segment_offset[self._segment] + model.offsets)
        self._lower = np.ascontiguousarray(skeleton.limits[:, 0])
        self._upper = np.ascontiguousarray(skeleton.limits[:, 1])
        place = np.array([name in _PLACE for name in skeleton.coordinates])
        self._neutral = np.where(place, 0.0, self.settings.neutral_weight)
        for name, weight in (neutral or {}).items():
            self._neutral[skeleton.index(name)] = weight
        self._place = place
        prior = [(skeleton.index(a), skeleton.index(b), share) for a, b, share in spine_prior()]
        self._pair = np.array([[a, b] for a, b, _ in prior], dtype=np.int64)
        self._share = np.array([share for _, _, share in prior])
        names = model.names
        self._mirror = np.array([names.index(mirror_name(name, names) or name) for name in names])
        blind = 'lumbar' not in model.segments
        self._pair_weight = np.full(
            len(prior), self.settings.blind_spine_weight if blind else self.settings.spine_weight
        )
        self._weights = np.ascontiguousarray(model.weights, dtype=np.float64)
        self._cache: dict[bytes, Observed] = {}
        #: Coordinates that the full marker set determines.
        self.observed = self._observed(self._weights)
        if not self.observed[place].all():
            lost = [skeleton.coordinates[j] for j in np.flatnonzero(place & ~self.observed)]
            raise InverseKinematicsError(
                f'the markers {", ".join(model.names)} do not determine {lost[0]}'
            )

    @property
    def unobservable(self) -> tuple[str, ...]:
        """Coordinates that even the full marker set does not see; they stay at neutral."""
        return tuple(self.skeleton.coordinates[j] for j in np.flatnonzero(~self.observed))

    def _curvature(self, weight: Array) -> Array:
        """Return the curvature (n_q,) of the fit about each coordinate, the others free."""
        curvature: Array = observed_curvature(
            self.skeleton.tree,
            self.skeleton.standing(),
            self._body,
            self._local,
            weight,
            self._pair,
            self._share,
            self._pair_weight,
            self.settings.neutral_weight,
        )
        return curvature

    def _observed(self, weight: Array) -> npt.NDArray[np.bool_]:
        """Coordinates (n_q,) that the markers of positive weight determine."""
        return np.asarray(self._curvature(weight) > self.settings.observed_curvature)

    def _not_converged(self, weight: Array, iterations: int, stationarity: float) -> str:
        """Return why a fit stopped: the coordinate that the markers seen determine least."""
        curvature = np.where(self.observed, self._curvature(weight), np.inf)
        weakest = self.skeleton.coordinates[int(np.argmin(curvature))]
        return (
            f'inverse kinematics did not converge in {iterations} iterations (gradient '
            f'{stationarity:.1e}); the {int((weight > 0).sum())} markers seen determine {weakest} '
            'least'
        )

    def _find_observed(self, weight: Array) -> Observed:
        """Return the coordinates that the markers of positive weight determine (cached)."""
        key = weight.tobytes()
        obs = self._cache.get(key)
        if obs is None:
            unobserved = self.observed & ~self._observed(weight)
            names = tuple(self.skeleton.coordinates[j] for j in np.flatnonzero(unobserved))
            lost = bool(unobserved[self._place].any() or not weight.any())
            obs = Observed(
                unobserved,
                names,
                lost,
                np.where(unobserved, self.settings.unobserved_weight, self._neutral),
            )
            if len(self._cache) >= _CACHED_MARKER_SETS:
                self._cache.clear()
            self._cache[key] = obs
        return obs

    def predict(self, q: npt.ArrayLike) -> Array:
        """Marker positions (n_markers, 3) [m] at coordinates q."""
        return np.asarray(
            point_positions(
                self.skeleton.tree,
                np.ascontiguousarray(q, dtype=np.float64),
                self._segment,
                np.ascontiguousarray(self.model.offsets),
            )
        )

    def solve(self, positions: npt.ArrayLike, previous: npt.ArrayLike | None = None) -> IKSolution:
        """Fit one frame.

        Parameters
        ----------
        positions
            Shape (n_markers, 3) in the order of the model's names, world [m]; NaN where not seen.
        previous
            Coordinates of the frame before, or None.

        Raises
        ------
        InverseKinematicsError
            If the shape is wrong.
        """
        measured = np.ascontiguousarray(positions, dtype=np.float64)
        if measured.shape != (len(self.model.names), 3):
            raise InverseKinematicsError(
                f'positions: shape ({len(self.model.names)}, 3) is needed, got {measured.shape}'
            )
        target, weight = marked(measured, self._weights)
        last = None if previous is None else np.ascontiguousarray(previous, dtype=np.float64)
        obs = self._find_observed(weight)
        if obs.lost:
            return self._lost(weight, last, obs)
        q, position, iterations, converged, value, stationarity = self._best(
            target, weight, last, obs
        )
        residuals, rms, maximum, used = misfit(position, target, weight)
        rejected: tuple[str, ...] = ()
        swapped = ''
        if self._too_far(rms, maximum) or (
            maximum > self.settings.rms_residual and self._crossed_pairs(position, target, weight)
        ):
            crossed = self._sides_exchanged(target, weight, residuals)
            if crossed is not None:
                q, position, target = crossed
                swapped = 'of the left and right side are all exchanged'
            else:
                q, position, weight, rejected, swapped = self._robust(q, target, weight, last, obs)
            residuals, rms, maximum, used = misfit(position, target, weight)
        stopped = '' if converged else self._not_converged(weight, iterations, stationarity)
        status, message = judge(
            self.settings,
            self.model,
            stopped,
            rms,
            maximum,
            residuals,
            used,
            obs,
            swapped,
            rejected,
        )
        return IKSolution(
            q,
            residuals,
            rms,
            maximum,
            used,
            obs.names,
            rejected,
            status,
            message,
            iterations,
            value,
            stationarity,
        )

    def _fit(
        self, start: Array, target: Array, weight: Array, last: Array | None, obs: Observed | None
    ) -> tuple[Array, Array, int, bool, float, float]:
        """Fit from one start; all coordinates count as observed if ``obs`` is None."""
        prior = np.zeros_like(start)
        prior_weight = self._neutral
        if obs is not None:
            prior_weight = obs.prior_weight
            if obs.names and last is not None:
                prior = np.where(obs.unobserved, last, 0.0)
        result: tuple[Array, Array, int, bool, float, float] = fit(
            self.skeleton.tree,
            start,
            self._lower,
            self._upper,
            self._body,
            self._local,
            target,
            weight,
            prior,
            prior_weight,
            self._pair,
            self._share,
            self._pair_weight,
            self.settings.max_iterations,
            self.settings.tolerance,
        )
        return result

    def _best(
        self, target: Array, weight: Array, last: Array | None, obs: Observed | None
    ) -> tuple[Array, Array, int, bool, float, float]:
        if last is not None:
            return self._fit(last, target, weight, last, obs)
        fits = [
            self._fit(start, target, weight, None, obs) for start in self._starts(target, weight)
        ]
        return min(fits, key=lambda result: result[4])

    def _starts(self, target: Array, weight: Array) -> list[Array]:
        """Standing and crouching postures with the pelvis where its markers are."""
        skeleton = self.skeleton
        starts = []
        on_pelvis = np.array([name == 'pelvis' for name in self.model.segments]) & (weight > 0)
        use = on_pelvis if on_pelvis.any() else weight > 0
        for share in _STARTS:
            q = skeleton.vector(
                {
                    f'{name}_{side}': value * share
                    for name, value in _CROUCH.items()
                    for side in 'rl'
                }
            )
            shift = (target[use] - self.predict(q)[use]).mean(axis=0)
            q += skeleton.vector(
                {'pelvis_tx': shift[0], 'pelvis_ty': shift[2], 'pelvis_tz': -shift[1]}
            )
            starts.append(q)
        return starts

    def _too_far(self, rms: float, maximum: float) -> bool:
        return maximum > self.settings.max_residual or rms > self.settings.rms_residual

    def _sides_exchanged(
        self, target: Array, weight: Array, distance: Array
    ) -> tuple[Array, Array, Array] | None:
        """Fit with all left and right names exchanged, if that explains the markers far better.

        Returns coordinates, model positions and the exchanged target, or None.
        """
        if np.median(distance[weight > 0]) < self.settings.rms_residual:
            return None
        crossed, seen = target[self._mirror], weight[self._mirror]
        q, position, *_ = self._best(crossed, seen, None, None)
        _, rms, maximum, _ = misfit(position, crossed, seen)
        if self._too_far(rms, maximum):
            return None
        return q, position, np.where((seen > 0)[:, None], crossed, position)

    def _robust(
        self, q: Array, target: Array, weight: Array, last: Array | None, obs: Observed
    ) -> tuple[Array, Array, Array, tuple[str, ...], str]:
        """Refit without the markers that do not fit; also describe those that look exchanged."""
        scale = self.settings.rms_residual
        start = q if last is None else last
        trust = weight
        position = self.predict(start)
        for _ in range(8):
            distance = np.linalg.norm(position - target, axis=1)
            # Geman and McClure 1987: weight of a redescending estimator.
            trust = weight / (1.0 + (distance / scale) ** 2) ** 2
            start, position, *_ = self._fit(start, target, trust, last, obs)
        distance = np.linalg.norm(position - target, axis=1)
        bad = (weight > 0) & (distance > self.settings.max_residual)
        names = self.model.names
        found = []
        for a, b, straight, crossed in self._crossed_pairs(position, target, weight):
            bad[[a, b]] = True
            found.append(
                f'{names[a]} and {names[b]} look exchanged (residual {straight:.3f} m, '
                f'{crossed:.3f} m when exchanged)'
            )
        good = np.where(bad, 0.0, weight)
        start, position, *_ = self._fit(start, target, good, last, obs)
        return (
            start,
            position,
            good,
            tuple(names[i] for i in np.flatnonzero(bad)),
            '; '.join(found),
        )

    def _crossed_pairs(
        self, position: Array, target: Array, weight: Array
    ) -> list[tuple[int, int, float, float]]:
        """Pairs of markers whose residuals shrink to less than half when they are exchanged.

        Each with the smaller residual as named and the larger when exchanged [m].
        """
        away = np.linalg.norm(target - position, axis=1)
        far = np.flatnonzero((weight > 0) & (away > self.settings.rms_residual))
        pairs = []
        for at, a in enumerate(far):
            for b in far[at + 1 :]:
                crossed = max(
                    float(np.linalg.norm(target[a] - position[b])),
                    float(np.linalg.norm(target[b] - position[a])),
                )
                straight = float(min(away[a], away[b]))
                if crossed < 0.5 * straight:
                    pairs.append((int(a), int(b), straight, crossed))
        return pairs

    def _lost(self, weight: Array, last: Array | None, obs: Observed) -> IKSolution:
        """Answer for a frame whose markers do not even place the pelvis."""
        q = self.skeleton.standing() if last is None else last.copy()
        used = int((weight > 0).sum())
        return IKSolution(
            q,
            np.full(len(weight), np.nan),
            np.nan,
            np.nan,
            used,
            obs.names,
            (),
            SolveStatus.TRACKER_MARKERS_MISSING,
            f'{used} of {len(weight)} markers: the pelvis is not determined',
            0,
            np.nan,
            np.nan,
        )
