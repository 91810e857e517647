# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The pipeline: motion, loads and predicted lifts of one station in, shapes and links out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.motion import BodyMotion, Lift
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array
from human_model.urdf import person_urdf
from lifting_visualization.core import drawing
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.ghost import Ghost, grips, no_ghost
from lifting_visualization.core.link_frames import LinkFrames
from lifting_visualization.core.shapes import Shape, nothing
from lifting_visualization.core.spine_loads import SpineLoads
from lifting_visualization.core.tables import colours

PERSON, BOX, GROUND, SPINE, PATHS = 'person', 'box', 'ground_force', 'l5_s1', 'hand_paths'
#: Numbers in the layer of paths.
MEASURED, PREDICTED = 0, 1


@dataclass(frozen=True)
class Options:
    """Settings of the picture; see `data/parameters.yaml`.

    Attributes
    ----------
    rate : float
        Pictures a second of the data's time at most.
    force_length : float
        Of the ground's forces [m/N].
    compression : SpineScale
    fresh : float
        How far the load may be behind the motion before its arrow is taken away [s].
    pause : float
        Between two showings of a predicted lift [s].
    prefix : str
        Before the names of the links.
    """

    rate: float
    force_length: float
    compression: SpineScale
    fresh: float
    pause: float
    prefix: str


class Visualizer:
    """Holds what is to be seen at one station.

    Parameters
    ----------
    options : Options
    """

    def __init__(self, options: Options) -> None:
        self.options = options
        self.links: LinkFrames | None = None
        self.urdf = ''
        self.ghost: Ghost | None = None
        self._subject: Subject | None = None
        self._box_size = np.zeros(3)
        self._box_orientation = np.array([0.0, 0.0, 0.0, 1.0])
        self._drawn = self._load_drawn = self._load_stamp = -np.inf
        self._lift_id = ''
        self._loads: dict[str, SpineLoads] = {}

    def set_subject(self, subject: Subject) -> bool:
        """Take the person; return whether it is another one than before.

        Raises
        ------
        HumanModelError
            If there is no skeleton of such a person.
        """
        if self._subject is not None and self._subject.to_dict() == subject.to_dict():
            return False
        self._subject = self.links = None
        self.links = LinkFrames(Skeleton3D.of(subject), self.options.prefix)
        self.urdf = person_urdf(subject)
        self._subject = subject
        self._drawn = self._load_drawn = self._load_stamp = -np.inf
        self.ghost = None
        self._loads.clear()
        return True

    def set_box_size(self, size: npt.ArrayLike) -> None:
        """Take depth, width and height of the box [m]."""
        self._box_size = np.asarray(size, np.float64)

    def set_box_orientation(self, quaternion: npt.ArrayLike) -> None:
        """Take the orientation xyzw of the box, world <- box."""
        self._box_orientation = np.asarray(quaternion, np.float64)

    def load_picture(self, loads: SpineLoads) -> list[Shape]:
        """Return the arrow of the last of live loads; without good data there is none.

        Loads come after the motion that they belong to: the arrow is drawn where the disc was.
        """
        now = float(loads.time[-1])
        if not self._due(now, self._load_drawn):
            return []
        self._load_drawn = self._load_stamp = now
        return drawing.compression(
            SPINE,
            loads.position[-1],
            loads.normal[-1],
            float(loads.compression[-1]),
            self.options.compression,
        )

    def transforms(self, motion: BodyMotion) -> Array | None:
        """Return the places (n_q, 7) of the links in the last sample; None without a person.

        Raises
        ------
        PictureError
            If the coordinates are not the skeleton's.
        """
        if self.links is None:
            return None
        return self.links.transforms(motion.coordinates, motion.position[-1])

    def picture(self, motion: BodyMotion, status: int) -> list[Shape]:
        """Return person, box and forces of the last sample; nothing when it is not due yet.

        A sample whose status is not 0 is drawn in grey without forces.

        Raises
        ------
        PictureError
            If a point of the body is missing.
        """
        now = float(motion.time[-1])
        points, names = motion.points[-1], motion.point_names
        if not self._due(now, self._drawn):
            return []
        self._drawn = now
        shapes = drawing.body(
            PERSON, names, points, colours()['person' if status == 0 else 'not_solved']
        )
        shapes.append(
            drawing.box(BOX, motion.box_position[-1], self._box_size, self._box_orientation)
        )
        if status != 0:
            shapes += [nothing(GROUND, k) for k in range(2)]
        else:
            shapes += drawing.ground_forces(
                GROUND,
                motion.ground_force[-1],
                motion.centre_of_pressure[-1],
                self.options.force_length,
            )
        if abs(now - self._load_stamp) > self.options.fresh:
            shapes += [nothing(SPINE, k) for k in range(2)]
        return shapes

    def _due(self, now: float, drawn: float) -> bool:
        # Half a millisecond: stamps are whole microseconds. Time that goes back: a new recording.
        return not 0.0 <= now - drawn < 1.0 / self.options.rate - 0.0005

    def set_measured(self, lift: Lift) -> list[Shape]:
        """Return the path of the hands in a recorded lift."""
        return [drawing.path(PATHS, MEASURED, grips(lift.motion), colours()['person'])]

    def set_predicted(
        self, lift_id: str, motion: BodyMotion | None, box_mass: float
    ) -> list[Shape]:
        """Take a predicted lift, None if there is none; return what changes at once."""
        if motion is None:
            self.ghost = None
            return [*no_ghost(), nothing(PATHS, PREDICTED)]
        self.ghost = Ghost(motion, box_mass, self.options.pause)
        load = self._loads.pop(lift_id, None)
        if load is not None:
            self.ghost.add_loads(load)
        self._lift_id = lift_id
        return [drawing.path(PATHS, PREDICTED, grips(motion), colours()['predicted'])]

    def set_predicted_load(self, lift_id: str, loads: SpineLoads) -> None:
        """Take the loads of a predicted lift, which may come before it."""
        if self.ghost is not None and self._lift_id == lift_id:
            self.ghost.add_loads(loads)
        else:
            self._loads = {lift_id: loads}

    def ghost_picture(self, elapsed: float) -> list[Shape]:
        """Return the predicted lift so long [s] after its showing began."""
        if self.ghost is None:
            return []
        return self.ghost.shapes(elapsed, self.options.compression, self._box_size)
