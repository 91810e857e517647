# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One case of a study: who lifts what with which weighting, and its name by content."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Final

from human_model.subject import Subject
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.problem.maximum_weight import Weighting

FORMAT: Final = 1
"""Raised when the meaning of a case or of a row changes, so that old rows are not taken for it."""


@dataclass(frozen=True, eq=False)
class Case:
    """What is solved in one go.

    Attributes
    ----------
    subject : Subject
        Who.
    task : PlanTask
        What.
    weighting : Weighting or None
        Where the largest mass is asked for.
    """

    subject: Subject
    task: PlanTask
    weighting: Weighting | None

    @cached_property
    def case_id(self) -> str:
        """Hash of everything in the case: the same case has the same id in every study."""
        text = json.dumps(self.to_dict(), sort_keys=True, allow_nan=False)
        return hashlib.sha256(f'{FORMAT}:{text}'.encode()).hexdigest()[:24]

    def to_dict(self) -> dict[str, Any]:
        """Plain data, so that a case can be sent to another machine."""
        return {
            'subject': self.subject.to_dict(),
            'task': asdict(self.task),
            'weighting': None if self.weighting is None else asdict(self.weighting),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Case:
        """Inverse of `to_dict`."""
        weighting = data['weighting']
        return cls(
            Subject.from_dict(data['subject']),
            PlanTask(**data['task']),
            None if weighting is None else Weighting(**weighting),
        )
