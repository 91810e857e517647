# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lift with its person and task: the type that all functions of the front door share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import human_model.motion
from human_model.subject import Subject
from human_model.typing import IntArray

if TYPE_CHECKING:
    from human_model.task import Box, Work


@dataclass(frozen=True, eq=False)
class Lift(human_model.motion.Lift):
    """A lift, measured or predicted, with its person and task.

    Attributes
    ----------
    subject : Subject
    box : Box or None
        The lifted box with its places, where they are known.
    work : Work or None
        How often the task is done; None where no recording gives it.
    status : ndarray, shape (n,), or None
        SolveStatus of the tracker for each sample; None for a predicted lift.
    """

    subject: Subject
    box: Box | None = None
    work: Work | None = None
    status: IntArray | None = None

    @classmethod
    def of(
        cls,
        lift: human_model.motion.Lift,
        subject: Subject,
        box: Box | None = None,
        work: Work | None = None,
        status: IntArray | None = None,
    ) -> Lift:
        """Return a lift of the packages together with its person and task."""
        return cls(
            lift.lift_id, lift.source, lift.start, lift.end, lift.box_mass, lift.motion,
            lift.report, subject, box, work, status,
        )  # fmt: skip
