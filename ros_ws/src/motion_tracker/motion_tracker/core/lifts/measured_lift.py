# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A whole lift from the recorded frames: gaps bridged, filters of zero phase, in small steps."""

from collections.abc import Iterator, Mapping, Sequence
from copy import copy

import numpy as np
import numpy.typing as npt

from human_model.constants import SIDES
from human_model.motion import POINTS, Lift
from human_model.report import SolveReport, SolveStatus
from human_model.skeleton import Skeleton
from human_model.typing import Array, IntArray
from motion_tracker.core.dynamics import needed_force
from motion_tracker.core.filters import derivatives, zero_phase
from motion_tracker.core.forces.force_plates import GroundReaction, PlateGeometry, ground_reaction
from motion_tracker.core.forces.hand_force import HandForceEstimator
from motion_tracker.core.streams import SampledStream, columns_at
from motion_tracker.core.tracked import FrameRecord, MeasuredLift, TrackerSettings

_HANDS = (POINTS.index('hand_r'), POINTS.index('hand_l'))


#: Reach of the impulse response of the zero-phase filter, in periods of its cutoff: beyond it the
#: response of the two passes of second order is below 1 % of its peak.
_REACH = 0.6


def _unconnected(
    grid: Array, records: Sequence[FrameRecord], reach: float
) -> npt.NDArray[np.bool_]:
    """Whether the box has no place near a sample, or one that jumps, (n,)."""
    found = np.zeros(len(grid), dtype=np.bool_)
    unseen: float | None = None
    for record in records:
        if record.box is None:
            found |= np.abs(grid - record.stamp) <= reach
            continue
        if record.box.jumped and unseen is not None:
            found |= (grid >= unseen - reach) & (grid <= record.stamp + reach)
        if not record.box.doubt:
            unseen = None
        elif unseen is None:
            unseen = record.stamp
    return found


class LiftBuilder:
    """Makes measured lifts of one recording.

    Parameters
    ----------
    skeleton
        Of the person.
    settings
        Of the tracker.
    plates
        Geometry by side.
    wrenches
        Streams of force and moment by side.
    box
        Stream of the box's centre.
    """

    def __init__(
        self,
        skeleton: Skeleton,
        settings: TrackerSettings,
        plates: Mapping[str, PlateGeometry],
        wrenches: Mapping[str, SampledStream],
        box: SampledStream,
    ) -> None:
        self._skeleton = skeleton
        self._settings = settings
        self._plates = plates
        self._wrenches = wrenches
        self._box = box

    def build(
        self,
        lift_id: str,
        start: float,
        end: float,
        records: Sequence[FrameRecord],
        rate: float,
        estimator: HandForceEstimator,
        support: float | None,
        doubt: str = '',
    ) -> Iterator[MeasuredLift | None]:
        """Filter and combine everything between start and end [s], step by step.

        One step takes about a millisecond, so that live frames need not wait for a whole lift.
        The lift uses the state of the estimator at this call, whenever the steps are taken.

        Parameters
        ----------
        lift_id, start, end
            Of the lift [s].
        records
            Marker frames from before the start to after the end.
        rate
            Of the marker frames [Hz].
        estimator
            Of the hand force, with the bias estimated before the lift.
        support
            Height the box was lifted from [m]; None without a box.
        doubt
            Reason why the masses cannot be right, with fields and values; empty without doubt.

        Yields
        ------
        None or MeasuredLift
            The lift at the end of the last step.
        """
        return self._steps(lift_id, start, end, records, rate, copy(estimator), support, doubt)

    def forget(self, before: float) -> None:
        """Remove the samples of plates and box before a stamp [s]; no later lift needs them."""
        for stream in (*self._wrenches.values(), self._box):
            stream.forget(before)

    def _steps(
        self,
        lift_id: str,
        start: float,
        end: float,
        records: Sequence[FrameRecord],
        rate: float,
        estimator: HandForceEstimator,
        support: float | None,
        doubt: str,
    ) -> Iterator[MeasuredLift | None]:
        stamps = np.array([record.stamp for record in records])
        count = int(np.floor((stamps[-1] - stamps[0]) * rate + 1e-6)) + 1
        grid = stamps[0] + np.arange(count) / rate
        inside = (grid >= start - 1e-9) & (grid <= end + 1e-9)
        times = grid[inside]
        good = np.array([record.solution.ok for record in records])
        status, bridged = self._status(grid, stamps, good, records)
        status = status[inside]
        yield None
        usable = (
            good if good.sum() >= 2 else np.array([record.solution.used > 0 for record in records])
        )
        rows = np.array([record.solution.q for record in records])[usable]
        even = columns_at(grid, stamps[usable], rows)
        yield None
        q = zero_phase(even, rate, self._settings.motion_cutoff)
        yield None
        qd, qdd = derivatives(q, rate)
        q, qd, qdd = q[inside], qd[inside], qdd[inside]
        yield None
        feet = {}
        for name in SIDES:
            feet[name] = self._foot(name, times)
            yield None
        forces, silent = self._ground(times, feet)
        gaps = np.zeros(len(times), dtype=np.bool_)
        for name in SIDES:
            gaps |= self._wrenches[name].uncertain(times, _REACH / self._settings.plate_cutoff)
        status[(status == 0) & (gaps | bool(silent))] = SolveStatus.TRACKER_NO_GROUND_FORCE
        if doubt:
            status[status == 0] = SolveStatus.TRACKER_MASS_MISMATCH
        places = self._skeleton.points_and_frames(q)
        yield None
        box = self._carried(grid, inside, rate, estimator, records)
        box_doubts: list[str] = []
        if box is not None:
            yield None
            ground = None if silent else forces['ground_force']
            missing = (
                None
                if ground is None
                else (needed_force(self._skeleton, q, qd, qdd)[:, 2] - ground[:, :, 2].sum(axis=1))
            )
            forces['box_position'] = box[0]
            forces['hand_force'] = estimator.estimate(
                missing, places[0][:, _HANDS], *box, support, None
            )
            doubtful = _unconnected(grid, records, _REACH / self._settings.motion_cutoff)[inside]
            if missing is not None and estimator.bias is not None:
                missing = np.where(gaps, np.nan, missing)
                apart = estimator.bias - missing + forces['hand_force'][:, :, 2].sum(axis=1)
                doubtful |= np.abs(apart) > estimator.balance_limit()
            if doubtful.any():
                box_doubts.append(f'load of the box in doubt in {int(doubtful.sum())} samples')
                status[doubtful & (status == 0)] = SolveStatus.TRACKER_BAD_INPUT
        elif estimator.box_mass > 0.0:
            box_doubts.append('the box was not seen: its load is not known')
            status[status == 0] = SolveStatus.TRACKER_BAD_INPUT
        yield None
        motion = self._skeleton.body_motion(times, q, qd, qdd, places=places, **forces)
        rms, largest = self._residuals(times, records, stamps, rate)
        yield None
        report = self._report(records, inside, status, bridged, silent, [doubt, *box_doubts])
        lift = Lift(lift_id, 'measured', start, end, estimator.box_mass, motion, report)
        yield MeasuredLift(lift, status, rms, largest)

    def _status(
        self,
        grid: Array,
        stamps: Array,
        good: npt.NDArray[np.bool_],
        records: Sequence[FrameRecord],
    ) -> tuple[IntArray, int]:
        """Status of every grid sample, and how many bad ones were bridged."""
        nearest = np.clip(
            np.searchsorted(stamps, grid - 0.5 * (grid[1] - grid[0])), 0, len(stamps) - 1
        )
        lost = np.abs(stamps[nearest] - grid) > 0.5 * (grid[1] - grid[0])
        codes = np.array([int(record.solution.status) for record in records], dtype=np.int64)
        status = np.where(lost, int(SolveStatus.TRACKER_MARKERS_MISSING), codes[nearest])
        bad = status != 0
        edges = np.flatnonzero(np.diff(np.concatenate([[False], bad, [False]]).astype(int)))
        bridged = 0
        for first, last in zip(edges[::2], edges[1::2], strict=True):
            short = (last - first) * (grid[1] - grid[0]) <= self._settings.longest_gap + 1e-9
            if short and first > 0 and last < len(grid):
                status[first:last] = 0
                bridged += int(last - first)
        # The filter carries what a long gap was bridged with into its neighbours.
        reach = int(np.ceil(_REACH / self._settings.motion_cutoff / (grid[1] - grid[0])))
        for first, last in zip(edges[::2], edges[1::2], strict=True):
            if status[first]:
                near = status[max(0, first - reach) : last + reach]
                near[near == 0] = status[first]
        return status, bridged

    def _foot(self, name: str, times: Array) -> GroundReaction | None:
        """Ground reaction on one foot; None if its plate has no samples for all of the lift."""
        rows = self._wrenches[name].zero_phase_at(
            times, self._settings.plate_cutoff, self._settings.margin
        )
        if rows is None:
            return None
        return ground_reaction(
            rows[:, :3], rows[:, 3:], self._plates[name], self._settings.force_threshold
        )

    def _ground(
        self, times: Array, feet: Mapping[str, GroundReaction | None]
    ) -> tuple[dict[str, Array], list[str]]:
        """Ground reaction by foot, and the plates without samples for all of the lift."""
        n = len(times)
        forces = {
            'ground_force': np.zeros((n, 2, 3)),
            'centre_of_pressure': np.full((n, 2, 3), np.nan),
            'free_moment': np.zeros((n, 2, 3)),
        }
        for side, foot in enumerate(feet.values()):
            if foot is not None:
                forces['ground_force'][:, side] = foot.force
                forces['centre_of_pressure'][:, side] = foot.centre_of_pressure
                forces['free_moment'][:, side] = foot.free_moment
        return forces, [name for name, foot in feet.items() if foot is None]

    def _carried(
        self,
        grid: Array,
        inside: npt.NDArray[np.bool_],
        rate: float,
        estimator: HandForceEstimator,
        records: Sequence[FrameRecord],
    ) -> tuple[Array, Array] | None:
        """Box position (n, 3) [m] and acceleration (n, 3) [m/s^2]; None if there is no box."""
        if estimator.box_mass == 0.0:
            return None
        found = [(record.stamp, record.box.position) for record in records if record.box]
        if len(found) < 2 or len(found) < 0.5 * len(records):
            return None
        stamps, rows = np.array([at for at, _ in found]), np.array([row for _, row in found])
        box = zero_phase(columns_at(grid, stamps, rows), rate, self._settings.motion_cutoff)
        return box[inside], derivatives(box, rate)[1][inside]

    def _residuals(
        self, times: Array, records: Sequence[FrameRecord], stamps: Array, rate: float
    ) -> tuple[Array, Array]:
        rms, largest = np.full(len(times), np.nan), np.full(len(times), np.nan)
        at = np.searchsorted(times, stamps - 0.5 / rate)
        for index, record in zip(at, records, strict=True):
            if index < len(times) and abs(times[index] - record.stamp) <= 0.5 / rate:
                rms[index] = record.solution.rms
                largest[index] = record.solution.maximum
        return rms, largest

    def _report(
        self,
        records: Sequence[FrameRecord],
        inside: npt.NDArray[np.bool_],
        status: IntArray,
        bridged: int,
        silent: Sequence[str],
        doubts: Sequence[str],
    ) -> SolveReport:
        solutions = [record.solution for record in records]
        words = [
            f'{int(inside.sum())} samples, markers '
            f'{1000 * np.sqrt(np.nanmean([s.rms**2 for s in solutions])):.1f} mm rms'
        ]
        if bridged:
            words.append(f'{bridged} bad frames bridged by interpolation')
        bad = status[status != 0]
        worst = SolveStatus.OK
        if bad.size:
            codes, counts = np.unique(bad, return_counts=True)
            worst = SolveStatus(int(codes[np.argmax(counts)]))
            words.append(f'{bad.size} samples are not good data')
            reasons = [s.message for s in solutions if s.message]
            if reasons:
                words.append(reasons[0])
        if silent:
            words.append(
                'no complete ground reaction: samples missing of the '
                + ' and the '.join(f'{name} plate' for name in silent)
            )
        words += [doubt for doubt in doubts if doubt]
        return SolveReport(
            status=worst,
            message='; '.join(words),
            iterations=sum(s.iterations for s in solutions),
            objective=float(np.nanmean([s.objective for s in solutions])),
            primal_residual=float(np.nanmax([s.maximum for s in solutions])),
            dual_residual=float(np.nanmax([s.stationarity for s in solutions])),
        )
