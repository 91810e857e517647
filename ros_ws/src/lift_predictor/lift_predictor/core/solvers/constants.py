# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Constants of the interior-point method, for Python and, as macros of the same names, for C.

Names and values are those of Waechter and Biegler (2006) where a section is given.
"""

from __future__ import annotations

from typing import Final

KAPPA_EPSILON: Final = 10.0
KAPPA_MU: Final = 0.2
THETA_MU: Final = 1.5
TAU_LEAST: Final = 0.99
"""Barrier parameter and fraction to the boundary (section 2.1)."""
MULTIPLIER_SCALE: Final = 100.0
"""s_max of the scaled error (equation 6)."""
KAPPA_SIGMA: Final = 1e10
"""Largest distance of bound multipliers from the central path (equation 16)."""
LARGEST_FIRST_MULTIPLIER: Final = 1e3
"""Larger multipliers at the start are cut (section 3.6)."""
KAPPA_SOC: Final = 0.99
SOC_LIMIT: Final = 4
"""Second-order correction (section 2.4)."""
SHORT_STEP: Final = 0.1
SHORT_STEPS: Final = 12
"""The restoration starts after this number of successive steps that bounds cut to this length."""
TINY: Final = 10.0 * 2.0**-52
"""Relative size of a step that is rounding (section 3.9)."""
ACCEPTABLE_FACTOR: Final = 100.0
"""Without further progress, an error of this many tolerances is rounding, not failure."""
MAX_RESTORATIONS: Final = 8
RESTORED_FACTOR: Final = 0.1
RESTORED_PUSH: Final = 1e-8
RESTORED_SLACK_PUSH: Final = 1e-4
"""The restoration ends at this fraction of `infeasible_violation`; distances of its result from
the bounds of variables and constraints."""
BOUND_RELAXATION: Final = 1e-8
"""Relative relaxation of the bounds of constraints, as IPOPT relaxes all bounds: the feasible set
has an interior. Bounds of variables are kept: a solution can be used without a correction."""

GAMMA_THETA: Final = 1e-5
GAMMA_PHI: Final = 1e-8
GAMMA_ALPHA: Final = 0.05
S_THETA: Final = 1.1
S_PHI: Final = 2.3
ETA_PHI: Final = 1e-8
LARGEST_FACTOR: Final = 1e4
SMALL_FACTOR: Final = 1e-4
"""Filter of the line search (section 2.3)."""
ROUNDING: Final = 1e-14
"""Relative error of the barrier function that counts as equal."""

FIRST_SHIFT: Final = 1e-4
LEAST_SHIFT: Final = 1e-20
LARGEST_SHIFT: Final = 1e40
FIRST_GROWTH: Final = 100.0
SHIFT_GROWTH: Final = 8.0
SHIFT_DECAY: Final = 3.0
"""Multiples of the identity that are added to the Hessian (algorithm IC)."""
EQUALITY_SHIFT: Final = 1e-8
"""Regularisation of the Schur complement of dependent equality constraints (section 3.1)."""
CONVEXIFICATION: Final = 10.0
"""Weight of the outer products of the equality constraints' gradients, relative to the matrix. The
step is unchanged, as the change of the constraints is prescribed, but a matrix that is positive
definite on their null space becomes positive definite."""

FIRST_DAMPING: Final = 1e-6
DAMPING_GROWTH: Final = 10.0
DAMPING_DECAY: Final = 0.1
LARGEST_DAMPING: Final = 1e12
"""Levenberg-Marquardt damping of the feasibility restoration."""
STATIONARY: Final = 1e-8
"""Projected gradient, relative to the violation, at which a minimum is reached."""
LEAST_GRADIENT_RATIO: Final = 0.1
"""The violation has a minimum that is not zero if, to the first order, a change of the variables
by 1 removes less than this fraction of the squared violation."""
STALLED: Final = 1e-3
STALLED_STEPS: Final = 10
"""The violation has a minimum after this number of successive steps that reduce its square by less
than this fraction."""


def c_macros() -> str:
    """Return the constants as C macros."""
    values = [(name, value) for name, value in globals().items() if name.isupper()]
    return '\n'.join(f'#define {name} {value!r}' for name, value in values)
