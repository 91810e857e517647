# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Converts a model as read into flat arrays for the compiled functions.

Body 0 is the ground; every other body comes after its parent. The vector q holds the independent
coordinates only: a coupled coordinate is a function of one of them, a locked one is constant. The
vector x holds all coordinates of the tree, in the order of the model's joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array, IntArray
from muscle_analyzer.core.exceptions import ModelCompilationError, UnknownNameError
from muscle_analyzer.core.osim.functions import (
    FunctionTable,
    PiecewisePolynomial,
    constant,
    function_table,
    linear,
)
from muscle_analyzer.core.osim.model import GROUND, Joint, OsimModel


class Tree(NamedTuple):
    """Flat arrays of a tree of bodies, in OpenSim's axes.

    Attributes
    ----------
    parent : (n_b,) int array
        Index of the parent body, -1 for the ground.
    parent_rotation, parent_translation : (n_b, 3, 3), (n_b, 3) arrays
        The joint's frame on the parent: parent <- frame.
    child_rotation : (n_b, 3, 3) array
        Joint's moved frame <- child's axes.
    child_translation : (n_b, 3) array
        Origin of the joint's moved frame in the child's axes, in m.
    first_motion : (n_b + 1,) int array
        Elementary motions of body b are first_motion[b] to first_motion[b + 1] - 1: rotations in
        the order in which they act, then translations.
    motion_axis : (n_e, 3) array
    motion_turns : (n_e,) bool array
        True for a rotation.
    motion_coordinate : (n_e,) int array
        Index into x.
    motion_function, coupling_function : (n_e,), (n_x,) int arrays
        Numbers of functions in `functions`.
    independent : (n_x,) int array
        Index into q, or -1 if constant.
    functions : FunctionTable
    mass, mass_center, inertia : (n_b,), (n_b, 3), (n_b, 3, 3) arrays
        In kg, m and kg m^2 (about the mass centre), in the body's axes.
    gravity : (3,) array
        In m/s^2.
    n_independent : (1,) int array
        Number of independent coordinates.
    """

    parent: IntArray
    parent_rotation: Array
    parent_translation: Array
    child_rotation: Array
    child_translation: Array
    first_motion: IntArray
    motion_axis: Array
    motion_turns: NDArray[np.bool_]
    motion_coordinate: IntArray
    motion_function: IntArray
    coupling_function: IntArray
    independent: IntArray
    functions: FunctionTable
    mass: Array
    mass_center: Array
    inertia: Array
    gravity: Array
    n_independent: IntArray


@dataclass(frozen=True, eq=False)
class MultibodyModel:
    """A compiled model and the names behind its indices.

    Attributes
    ----------
    source : OsimModel
        The model it was made from.
    body_names : tuple of str
        'ground' first, parents before children.
    joint_names : tuple of str
        Name of the joint that carries each body ('' for the ground).
    coordinate_names : tuple of str
        The independent coordinates, order of q.
    tree_coordinate_names : tuple of str
        All coordinates, order of x.
    lower, upper : (n_q,) arrays
        Range of the independent coordinates in rad or m; not clamped ones have theirs too.
    default : (n_q,) array
        Default values.
    tree : Tree
    """

    source: OsimModel
    body_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    coordinate_names: tuple[str, ...]
    tree_coordinate_names: tuple[str, ...]
    lower: Array
    upper: Array
    default: Array
    tree: Tree

    def body_index(self, name: str) -> int:
        """Return a body's index, or raise UnknownNameError."""
        return _index(self.body_names, name, 'body')

    def coordinate_index(self, name: str) -> int:
        """Return an independent coordinate's index, or raise UnknownNameError."""
        return _index(self.coordinate_names, name, 'independent coordinate')


def _index(names: Sequence[str], name: str, what: str) -> int:
    try:
        return names.index(name)
    except ValueError:
        raise UnknownNameError(f'there is no {what} {name!r}') from None


def compile_model(model: OsimModel) -> MultibodyModel:
    """Compile a model.

    Raises
    ------
    ModelCompilationError
        If the bodies are no tree with the ground as root, or couplers depend on each other.
    """
    joints = _ordered_joints(model)
    names = [c.name for joint in model.joints for c in joint.coordinates]
    functions: list[PiecewisePolynomial] = [linear(1.0, 0.0)]
    independent, coupling = _couple(model, names, functions)
    motions = _Motions(names, functions)
    first_motion = [0, 0]
    for joint in joints:
        motions.add(joint)
        first_motion.append(len(motions.axis))
    body_names = (GROUND, *(joint.child.body for joint in joints))
    bodies = [model.body(name) for name in body_names[1:]]
    identity = np.eye(3)
    tree = Tree(
        parent=np.array([-1, *(body_names.index(j.parent.body) for j in joints)], dtype=np.int64),
        parent_rotation=np.array([identity, *(j.parent.rotation for j in joints)]),
        parent_translation=np.array([np.zeros(3), *(j.parent.translation for j in joints)]),
        child_rotation=np.ascontiguousarray([identity, *(j.child.rotation.T for j in joints)]),
        child_translation=np.array([np.zeros(3), *(j.child.translation for j in joints)]),
        first_motion=np.array(first_motion, dtype=np.int64),
        motion_axis=np.array(motions.axis).reshape(-1, 3),
        motion_turns=np.array(motions.turns, dtype=np.bool_),
        motion_coordinate=np.array(motions.coordinate, dtype=np.int64),
        motion_function=np.array(motions.function, dtype=np.int64),
        coupling_function=np.array(coupling, dtype=np.int64),
        independent=np.array(independent, dtype=np.int64),
        functions=function_table(functions),
        mass=np.array([0.0, *(body.mass for body in bodies)]),
        mass_center=np.array([np.zeros(3), *(body.mass_center for body in bodies)]),
        inertia=np.array([np.zeros((3, 3)), *(body.inertia for body in bodies)]),
        gravity=model.gravity.copy(),
        n_independent=np.array([1 + max(independent, default=-1)], dtype=np.int64),
    )
    by_name = {c.name: c for joint in model.joints for c in joint.coordinates}
    free = [
        by_name[name]
        for name, q, function in zip(names, independent, coupling, strict=True)
        if q >= 0 and function == 0
    ]
    return MultibodyModel(
        source=model,
        body_names=body_names,
        joint_names=('', *(joint.name for joint in joints)),
        coordinate_names=tuple(c.name for c in free),
        tree_coordinate_names=tuple(names),
        lower=np.array([c.range[0] for c in free]),
        upper=np.array([c.range[1] for c in free]),
        default=np.array([c.default_value for c in free]),
        tree=tree,
    )


def _ordered_joints(model: OsimModel) -> list[Joint]:
    """Return the joints with every parent before its children."""
    carried = [joint.child.body for joint in model.joints]
    for body in model.bodies:
        if carried.count(body.name) != 1:
            raise ModelCompilationError(
                f'{model.source}: body {body.name!r} is the child of {carried.count(body.name)} '
                'joints, want 1'
            )
    ordered: list[Joint] = []
    known = {GROUND}
    waiting = list(model.joints)
    while waiting:
        ready = [joint for joint in waiting if joint.parent.body in known]
        if not ready:
            raise ModelCompilationError(
                f'{model.source}: joint {waiting[0].name!r} does not hang on the ground'
            )
        # Depth first in the file's order, so that limbs stay together.
        ordered.append(ready[0])
        known.add(ready[0].child.body)
        waiting.remove(ready[0])
    return ordered


def _couple(
    model: OsimModel, names: list[str], functions: list[PiecewisePolynomial]
) -> tuple[list[int], list[int]]:
    """Return for every coordinate its index in q (or -1) and the number of its function of q."""
    couplers = {coupler.dependent: coupler for coupler in model.couplers}
    coordinates = {c.name: c for joint in model.joints for c in joint.coordinates}
    locked = {name for name, c in coordinates.items() if c.locked}
    for coupler in model.couplers:
        for reason, wrong in (
            ('is itself coupled', coupler.independent in couplers),
            ('drives a locked coordinate', coupler.dependent in locked),
        ):
            if wrong:
                raise ModelCompilationError(
                    f'{model.source}: coupler {coupler.name!r} {reason}: '
                    f'{coupler.dependent!r} by {coupler.independent!r}'
                )
    free = [name for name in names if name not in couplers and name not in locked]
    independent = []
    coupling = []
    for name in names:
        driver = couplers[name].independent if name in couplers else name
        if driver in locked:
            value = coordinates[driver].default_value
            if name in couplers:
                value = couplers[name].function.derivatives(value)[0]
            functions.append(constant(value))
            independent.append(-1)
            coupling.append(len(functions) - 1)
        elif name in couplers:
            functions.append(couplers[name].function)
            independent.append(free.index(driver))
            coupling.append(len(functions) - 1)
        else:
            independent.append(free.index(name))
            coupling.append(0)
    return independent, coupling


class _Motions:
    """Collects the elementary motions of the joints."""

    def __init__(self, names: list[str], functions: list[PiecewisePolynomial]) -> None:
        self.axis: list[Array] = []
        self.turns: list[bool] = []
        self.coordinate: list[int] = []
        self.function: list[int] = []
        self._names = names
        self._functions = functions

    def add(self, joint: Joint) -> None:
        """Append a joint's motions, leaving out those that are always zero."""
        for turns, axes in ((True, joint.rotations), (False, joint.translations)):
            for axis in axes:
                fixed = axis.function.is_constant()
                if fixed and axis.function.coefficients[0, 0] == 0.0:
                    continue
                self.axis.append(axis.axis)
                self.turns.append(turns)
                moved_by = None if fixed else axis.coordinate
                self.coordinate.append(-1 if moved_by is None else self._names.index(moved_by))
                self.function.append(len(self._functions))
                self._functions.append(axis.function)
