# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fields of task and study files."""

from __future__ import annotations

from human_model import fields
from lift_predictor.core.exceptions import PlanError


class Fields(fields.Fields):
    """One mapping of a task or study file; see `human_model.fields`."""

    ERROR = PlanError
