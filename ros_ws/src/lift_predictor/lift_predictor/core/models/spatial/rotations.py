# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Symbolic segment frames that turn joint by joint, with angular velocity and acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca


@dataclass(frozen=True)
class Turning:
    """A frame in the world and how it turns.

    Attributes
    ----------
    axes : tuple of SX, 3 x 1 each
        Its x, y and z axis in the world.
    rate, change : SX, 3 x 1
        Angular velocity [rad/s] and acceleration [rad/s^2] in the world.
    """

    axes: tuple[Any, Any, Any]
    rate: Any
    change: Any

    @classmethod
    def fixed(cls, heading: Any = 0.0) -> Turning:
        """Return a frame at rest, turned about the vertical by an angle [rad]."""
        c, s = ca.cos(heading), ca.sin(heading)
        return cls(
            (ca.vertcat(c, s, 0.0), ca.vertcat(-s, c, 0.0), ca.vertcat(0.0, 0.0, 1.0)),
            ca.SX(3, 1),
            ca.SX(3, 1),
        )

    def joint(self, axis: int, sign: float, angle: Any, rate: Any, change: Any) -> Turning:
        """Frame after a hinge about one of this frame's own axes, turned by sign times angle."""
        c, s = ca.cos(angle), sign * ca.sin(angle)
        own = list(self.axes)
        a, b = (axis + 1) % 3, (axis + 2) % 3
        own[a] = c * self.axes[a] + s * self.axes[b]
        own[b] = c * self.axes[b] - s * self.axes[a]
        hinge = sign * self.axes[axis]
        return Turning(
            (own[0], own[1], own[2]),
            self.rate + rate * hinge,
            self.change + change * hinge + rate * ca.cross(self.rate, hinge),
        )

    def place(self, local: list[Any]) -> Any:
        """Vector given in this frame, in the world's axes."""
        return sum((x * axis for x, axis in zip(local, self.axes, strict=True)), ca.SX(3, 1))

    def acceleration(self, arm: Any) -> Any:
        """Acceleration of the end of an arm (world axes) relative to its beginning."""
        return ca.cross(self.change, arm) + ca.cross(self.rate, ca.cross(self.rate, arm))

    def spin_moment(self, inertia: list[Any]) -> Any:
        """Moment that this turning needs, for an inertia (xx, yy, zz, xy, xz, yz) in the frame.

        d(I w)/dt in the world's axes [N m].
        """
        xx, yy, zz, xy, xz, yz = inertia
        tensor = ca.vertcat(ca.horzcat(xx, xy, xz), ca.horzcat(xy, yy, yz), ca.horzcat(xz, yz, zz))
        turn = ca.horzcat(*self.axes)
        rate, change = ca.mtimes(turn.T, self.rate), ca.mtimes(turn.T, self.change)
        moment = ca.mtimes(tensor, change) + ca.cross(rate, ca.mtimes(tensor, rate))
        return ca.mtimes(turn, moment)
