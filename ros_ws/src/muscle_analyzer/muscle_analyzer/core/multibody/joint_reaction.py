# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint reactions from muscle forces: the thesis' equation 4.11 from the hands and head down.

The reaction at a joint is the remainder of the Newton-Euler equations of all bodies that the joint
carries, after weight, external loads and muscle forces (Steele et al. 2012, Gait Posture 35:556).
Wrenches are (moment, force) about the ground's origin in ground axes, like everywhere in this
package.

Muscles enter as the sum of the wrenches of their paths on each body (`paths.body_wrenches`):
intermediate points and wrap surfaces count, not only origin and insertion.
"""

from __future__ import annotations

from typing import NamedTuple

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.multibody.inverse_dynamics import accumulate_subtrees, wrench_at
from muscle_analyzer.core.multibody.kinematics import BodyState
from muscle_analyzer.core.multibody.model import Tree


class NetMoment(NamedTuple):
    """Net moment across a joint at its centre, ground axes, seen from both sides, N m.

    Attributes
    ----------
    top_down : (3,) array
        From the carried side (for L5-S1: trunk, arms, head and box).
    bottom_up : (3,) array
        From all the rest (for L5-S1: plates, legs and pelvis).
    difference : (3,) array
        top_down - bottom_up: the disagreement of plates, masses and motion. Over a lift, the
        quality measure that needs no reference.
    """

    top_down: Array
    bottom_up: Array
    difference: Array


@njit
def joint_reactions(tree: Tree, joint_wrench: Array, muscle_wrench: Array) -> Array:
    """Return the reaction wrench (n_b, 6) of the parent on each body at its joint, equation 4.11.

    Parameters
    ----------
    tree : Tree
    joint_wrench : (n_b, 6) array
        Of `inverse_dynamics`: joint and muscles together.
    muscle_wrench : (n_b, 6) array
        Wrenches of all muscles on the bodies, see `paths.body_wrenches`.
    """
    reaction = muscle_wrench.copy()
    compute_joint_reactions(tree, joint_wrench, reaction)
    return reaction


@kernel
def compute_joint_reactions(tree: Tree, joint_wrench: Array, wrench: Array) -> None:
    """Replace the wrenches (n_b, 6) of all muscles by the `joint_reactions`, in place."""
    accumulate_subtrees(tree.parent, wrench)
    for b in range(wrench.shape[0]):
        for i in range(6):
            wrench[b, i] = joint_wrench[b, i] - wrench[b, i]


@njit
def net_moment(joint_wrench: Array, state: BodyState, body: int, root: int) -> NetMoment:
    """Return the net moment at the joint that carries `body`, from both sides.

    Parameters
    ----------
    joint_wrench : (n_b, 6) array
        Of `inverse_dynamics`.
    state : BodyState
    body : int
        The joint's child (for L5-S1 the fifth lumbar vertebra).
    root : int
        The body whose joint is on the ground (pelvis): its joint wrench is the residual.

    Notes
    -----
    The wrenches of all bodies add up to the residual, so the bottom-up value is the top-down one
    less the residual; both follow from one backward recursion.
    """
    centre = state.joint_position[body]
    top_down = wrench_at(joint_wrench[body], centre)[:3]
    difference = wrench_at(joint_wrench[root], centre)[:3]
    return NetMoment(top_down, top_down - difference, difference)
