# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Status of live samples: settling filters and masses in doubt."""

import numpy as np

from human_model.report import SolveStatus
from motion_tracker.core.forces.mass_watch import MassCheck, MassWatch
from motion_tracker.core.inverse_kinematics.solution import IKSolution


class LiveStatus:
    """Memory of one recording: settling filters, and masses that the plates do not confirm.

    Parameters
    ----------
    watch
        Of the person's weight.
    settling
        Time a filter needs to forget how it started [s].
    """

    def __init__(self, watch: MassWatch, settling: float) -> None:
        self._watch = watch
        self._settling = settling
        self._settled, self._reason = -np.inf, ''
        self._doubted, self._doubt = -np.inf, ''

    def settle(self, start: float, reason: str) -> None:
        """Mark samples from the stamp ``start`` [s] until the filters have forgotten it."""
        self._settled, self._reason = start + self._settling, reason

    def settling(self, stamp: float) -> bool:
        """Whether the filters have not yet forgotten how they started."""
        return stamp < self._settled

    def weigh(
        self, stamp: float, vertical: float, need: float, carried_mass: float | None, rate: float
    ) -> MassCheck | None:
        """Take one sample for the `MassWatch`; return the check when its result is new."""
        if self.settling(stamp):
            return None
        check = self._watch.push(vertical, need, carried_mass, rate)
        if not self._watch.agrees:
            self._doubted, self._doubt = stamp, str(self._watch.check)
        return check

    def doubt_since(self, start: float) -> str:
        """Why samples after the stamp ``start`` [s] had masses in doubt; empty if none had."""
        return self._doubt if self._doubted >= start else ''

    def judge(
        self, stamp: float, solution: IKSolution, silent: str, box: str = ''
    ) -> tuple[SolveStatus, str]:
        """Return the status of a sample and why it is not good.

        Parameters
        ----------
        stamp
            Of its marker frame [s].
        solution
            Of its marker frame.
        silent
            The plates without samples, in words; empty if both have some.
        box
            Reason why the load of the box cannot be right; empty without doubt.
        """
        if not solution.ok:
            return solution.status, solution.message
        if silent:
            return SolveStatus.TRACKER_NO_GROUND_FORCE, f'no samples of {silent}'
        if self.settling(stamp):
            return SolveStatus.TRACKER_FILTER_SETTLING, self._reason
        if not self._watch.agrees:
            return SolveStatus.TRACKER_MASS_MISMATCH, str(self._watch.check)
        if box:
            return SolveStatus.TRACKER_BAD_INPUT, f'load of the box: {box}'
        return solution.status, solution.message
