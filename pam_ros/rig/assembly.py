# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rows of several rigs and joints, put together for the kernels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.rig.joint_model import JointModel
from pam_ros.rig.joints import JOINTS, mass
from pam_ros.rig.model import RigModel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Model = RigModel | JointModel


@dataclass(frozen=True)
class Assembly:
    """Rows of *models* one after the other: of each its muscles, then its load.

    A muscle with a load of its own has one row for both. q (rows, parameters), and the effects
    that are present in each row; kind, first and load (joints,), g (joints, width) as
    ``joint_kernel`` describes them; muscle: the row of each muscle, in order.
    """

    q: Array
    present: tuple[tuple[Effect, ...], ...]
    kind: Indices
    first: Indices
    load: Indices
    g: Array
    muscle: Indices

    @property
    def is_plain(self) -> bool:
        """Whether each muscle has a load of its own."""
        return bool(np.all(self.first == self.load))


def assemble(models: Sequence[Model]) -> Assembly:
    """Put the rows of *models* together."""
    q: list[Array] = []
    present: list[tuple[Effect, ...]] = []
    muscles: list[int] = []
    joints = []
    geometry: list[tuple[float, ...]] = []
    for model in models:
        first = len(q)
        if isinstance(model, JointModel):
            q += list(model.rows())
            present += model.present
            kind, g = model.kind, model.geometry
            muscles += range(first, len(q) - 1)
        else:
            q.append(model.row())
            present.append(model.present)
            kind, g = JOINTS.index(mass.JOINT), mass.row(model.load, (model.muscle,))
            muscles.append(first)
        joints.append((kind, first, len(q) - 1))
        geometry.append(g)
    width = max(len(g) for g in geometry)
    kinds, firsts, loads = (np.array(each, dtype=np.int64) for each in zip(*joints, strict=True))
    return Assembly(
        q=np.array(q),
        present=tuple(present),
        kind=kinds,
        first=firsts,
        load=loads,
        g=np.array([g + (0.0,) * (width - len(g)) for g in geometry]),
        muscle=np.array(muscles, dtype=np.int64),
    )
