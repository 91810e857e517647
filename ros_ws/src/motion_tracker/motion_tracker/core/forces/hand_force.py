# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Force of the box on the hands, from the plates before lift-off and from the box after it.

While the box still stands on something, part of its weight does too, and the plates under the
feet feel only what the hands take: the vertical hand force is what the body's weight and inertia
need less what the ground gives, less the bias this difference had while the hands were away from
the box (the plates and the segment masses never agree exactly). Once the box has risen, the
force is -m (g + a). The two are blended over the first centimetres of the rise, and the first
fades in with the hands' approach, so that the force has no step as long as its inputs have none.
Noise of the first estimate: that of the ground force and of the body's acceleration, a few tens of
newtons; of the second: the box mass times the noise of the filtered acceleration, a few newtons.

Each hand takes the share that balances the box's weight at its centre between the hands, as on a
beam; inner forces, with which the hands squeeze the box, cannot be seen and are taken as zero.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.constants import GRAVITY
from human_model.typing import Array
from motion_tracker.core.exceptions import HandForceError
from motion_tracker.core.forces import hand_force_kernel

#: Difference of the load in the hands by box and by plates that is doubtful [N], and as a share
#: of the weight of the box. Measured: at most 6 N at 7 kg and 12 kg and 10 N at 23.8 kg in the
#: live samples of the simulated recordings.
LEAST_BALANCE = 15.0
BALANCE = 0.15


@dataclass(frozen=True)
class HandForceSettings:
    """Distances and times of the blends.

    Attributes
    ----------
    free_rise : float
        Rise from which on the box is carried by the hands alone [m].
    reach : float
        Distance of the hands from the box, over half its diagonal, at which they can hold it [m].
    fade : float
        Further distance over which the estimate from the plates fades out [m].
    largest_share : float
        The estimate from the plates is limited to this multiple of the box's weight.
    bias_time : float
        Time constant of the bias of the estimate from the plates [s].
    release_time : float
        Time over which the box is handed back to the estimate from the plates after a lift [s].
    """

    free_rise: float = 0.02
    reach: float = 0.05
    fade: float = 0.10
    largest_share: float = 1.5
    bias_time: float = 1.0
    release_time: float = 0.3

    def __post_init__(self) -> None:
        """Check that every number is positive."""
        for name, value in vars(self).items():
            if not (np.isfinite(value) and value > 0):
                raise HandForceError(f'hand_force.{name}: must be positive, got {value}')


class HandForceEstimator:
    """Estimator with the memory of one recording: bias, and the height the box rests at.

    Parameters
    ----------
    box_mass
        kg; 0: nothing is lifted and every force is zero.
    box_size
        Depth, width, height of the box [m].
    settings
        Blends.

    Raises
    ------
    HandForceError
        If mass or size are negative or not finite.
    """

    def __init__(
        self, box_mass: float, box_size: npt.ArrayLike, settings: HandForceSettings | None = None
    ) -> None:
        size = np.asarray(box_size, dtype=np.float64)
        if not (np.isfinite(box_mass) and box_mass >= 0):
            raise HandForceError(f'box_mass: {box_mass} kg is no mass')
        if size.shape != (3,) or not np.all(np.isfinite(size)) or np.any(size < 0):
            raise HandForceError(f'box_size: three lengths are needed, got {size}')
        self.settings = settings or HandForceSettings()
        self.box_mass = box_mass
        self._reach = 0.5 * float(np.linalg.norm(size)) + self.settings.reach
        #: Ground force missing to the body's need while the hands are away from the box [N].
        self.bias: float | None = None
        #: Height of the box at rest [m], from which its rise is counted.
        self.support: float | None = None

    def gate(self, hands: Array, box: Array) -> float:
        """1 while both hands are at the box, 0 while one is well away from it."""
        return float(hand_force_kernel.gate(hands, box, self._reach, self.settings.fade))

    def carried_mass(self, hands: Array, box: Array, support: float | None) -> float | None:
        """Mass the hands carry at rest [kg]; None if the box may stand on something as well.

        Parameters
        ----------
        hands, box
            Grip centres (2, 3) and box centre (3,) [m].
        support
            Height the box was lifted from [m]; None if no lift is under way.
        """
        if self.gate(hands, box) == 0.0:
            return 0.0
        if support is not None and float(box[2]) - support > self.settings.free_rise:
            return self.box_mass
        return None

    def balance_limit(self) -> float:
        """Largest difference of the load in the hands by box and by plates [N].

        The larger of `LEAST_BALANCE` and `BALANCE` times the weight of the box.
        """
        return max(LEAST_BALANCE, BALANCE * self.box_mass * GRAVITY)

    def doubt(self, missing: float | None, force: Array) -> str:
        """Return why the force on the hands (2, 3) [N] contradicts the plates; empty if not.

        ``missing`` as in `observe`.
        """
        if missing is None or self.bias is None or self.box_mass == 0.0:
            return ''
        plates = self.bias - missing
        by_box = -float(force[:, 2].sum())
        if abs(plates - by_box) <= self.balance_limit():
            return ''
        return f'the hands carry {by_box:.0f} N by the box, {plates:.0f} N by the plates'

    def observe(
        self,
        missing: float | None,
        hands: Array,
        box: Array,
        speed: float,
        lifting: bool,
        step: float,
        rest_speed: float,
    ) -> None:
        """Learn the bias and the rest height from one sample.

        Parameters
        ----------
        missing
            Vertical force the body needs less what the plates give [N]; None without plates.
        hands, box
            Grip centres (2, 3) and box centre (3,) [m].
        speed
            Vertical speed of the box [m/s].
        lifting
            Whether a lift is under way.
        step
            Time since the sample before [s].
        rest_speed
            Speed below which the box is at rest [m/s].
        """
        if missing is not None and self.gate(hands, box) == 0.0:
            weight = min(1.0, step / self.settings.bias_time)
            self.bias = (
                missing if self.bias is None else self.bias + weight * (missing - self.bias)
            )
        if not lifting and abs(speed) < rest_speed:
            if self.support is None or abs(box[2] - self.support) > self.settings.free_rise:
                self.support = float(box[2])
            else:
                weight = min(1.0, step / self.settings.bias_time)
                self.support += weight * (float(box[2]) - self.support)

    def estimate(
        self,
        missing: float | Array | None,
        hands: Array,
        box: Array,
        acceleration: Array,
        support: float | None,
        since_end: float | None,
    ) -> Array:
        """Force of the box on the [right, left] hand [N], of one sample or of n at once.

        Parameters
        ----------
        missing
            As in `observe`; (n,) for n samples.
        hands, box, acceleration
            Grip centres (2, 3) [m], box centre (3,) [m] and its acceleration [m/s^2]; or
            (n, 2, 3), (n, 3) and (n, 3).
        support
            Height the box was lifted from [m]; None: not known, nothing is carried.
        since_end
            Time since the end of the last lift was known [s]; None while one is under way or
            none was.

        Returns
        -------
        ndarray (2, 3) or (n, 2, 3)
        """
        shape = hands.shape
        if self.box_mass == 0.0:
            return np.zeros(shape)
        count = 1 if hands.ndim == 2 else len(hands)
        less = np.full(count, np.nan) if missing is None else (self.bias or 0.0) - missing
        force: Array = hand_force_kernel.hand_forces(
            self.box_mass,
            np.asarray(less, dtype=np.float64).reshape(count),
            np.ascontiguousarray(hands).reshape(count, 2, 3),
            np.ascontiguousarray(box).reshape(count, 3),
            np.ascontiguousarray(acceleration).reshape(count, 3),
            np.nan if support is None else support,
            np.nan if since_end is None else since_end,
            self._reach,
            self.settings.fade,
            self.settings.free_rise,
            self.settings.largest_share,
            self.settings.release_time,
        )
        return force.reshape(shape)
