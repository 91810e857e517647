# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Forces and constraints of many instants by the sagittal model, from the compiled functions."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.sagittal.grid import CENTRES, NODE_ROWS, REPORT_OUTPUTS
from lift_predictor.core.sagittal.parameters import BODIES, N_JOINTS
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.node_evaluation import evaluate_node

WIDTHS: Final = {
    'torque': N_JOINTS,
    'lower': N_JOINTS,
    'upper': N_JOINTS,
    'ground_force': 2,
    'ground_moment': 1,
    'hand_force': 2,
    'rows': len(NODE_ROWS),
    'effort': 1,
    'centres': 2 * len(CENTRES),
    'segment_angle': len(BODIES),
}
"""Values of each of `REPORT_OUTPUTS`."""


class ReportFunction:
    """The function `report` of the sagittal library.

    Parameters
    ----------
    library : NodeLibrary
        Of `programme.sagittal_library`.
    """

    def __init__(self, library: NodeLibrary) -> None:
        self._library = library

    def __call__(
        self, q: Array, dq: Array, ddq: Array, box_mass: float, parameters: Array
    ) -> dict[str, Array]:
        """Evaluate n instants.

        Parameters
        ----------
        q, dq, ddq : array, shape (n, 6)
            [rad], [rad/s], [rad/s^2].
        box_mass : float
            In the hands [kg].
        parameters : array
            `LiftParameters.pack`.

        Returns
        -------
        dict of array, shape (n, width)
            By the names of `REPORT_OUTPUTS`; units as in `model.chain_state`.
        """
        inputs = np.hstack((q, dq, ddq, np.full((len(q), 1), box_mass)))
        values = evaluate_node(self._library, 'report', inputs, parameters)
        stops = np.cumsum([WIDTHS[name] for name in REPORT_OUTPUTS])
        parts = np.split(values, stops[:-1], axis=1)
        return dict(zip(REPORT_OUTPUTS, parts, strict=True))
