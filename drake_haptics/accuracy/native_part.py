"""The part of a tick that runs inside the core: query, clusters, wrench."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics.decomposition import Decomposition


@dataclass(frozen=True, eq=False)
class NativePart:
    """What the core is asked in each tick, without Drake. Pickles.

    Attributes:
        tool: Pieces of the tool.
        objects: Pieces of what it meets.
        X_WO: (m, 7) poses [qw qx qy qz x y z] of the objects, m.
        search_m: How far contacts are looked for, m.
        tolerance_m: How far they push, m.
        cluster_size_m: δ of the octree, m; None where contacts share stiffness.
        stiffness_N_per_m: (m,) of each object, N/m.
        damping_Ns_per_m: (m,) of each object, N·s/m.
    """

    tool: Decomposition
    objects: tuple[Decomposition, ...]
    X_WO: np.ndarray
    search_m: float
    tolerance_m: float
    cluster_size_m: float | None
    stiffness_N_per_m: np.ndarray
    damping_Ns_per_m: np.ndarray

    def make_tracker(self) -> _core.SceneTracker:
        """Returns a tracker that has not been asked yet, its objects in place."""
        tracker = _core.SceneTracker(self.tool, self.objects, self.search_m)
        for i, X_WO in enumerate(self.X_WO):
            tracker.set_object_pose(i, X_WO)
        return tracker

    def make_clustering(self) -> Callable[[_core.ContactSet], _core.ClusterSet]:
        """Returns what makes clusters of contacts."""
        cluster: Callable[..., Any] = _core.share_stiffness
        if self.cluster_size_m is not None:
            cluster = partial(_core.cluster_contacts, delta=self.cluster_size_m)
        return partial(cluster, tolerance=self.tolerance_m)

    def make_force(self) -> Callable[..., _core.PenaltyWrench]:
        """Returns what makes a wrench of clusters, the tool's position and velocity."""
        return partial(
            _core.penalty_force,
            p_WO=self.X_WO[:, 4:].copy(),
            V_WO=np.zeros((len(self.X_WO), 6)),
            stiffness=self.stiffness_N_per_m,
            damping=self.damping_Ns_per_m,
        )
