"""What the contacts of a tick take inside the core."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics.accuracy.figures import TickTimes
from drake_haptics.accuracy.recorded_motion import RecordedMotion
from drake_haptics.accuracy.tool_replay import walk_tool
from drake_haptics.bench.timing import CallTimer, typical
from drake_haptics.scene import Contact, Scene

# As often each tick is timed.
_PASSES = 3


def time_native(scene: Scene, motion: RecordedMotion) -> TickTimes:
    """Times query, clusters and wrench of a recorded motion, without Python.

    The query is timed inside the core; of the other two what a call takes more than
    one without contacts. Each tick counts with the middle of several passes, so that
    the percentiles are those of the work, not of what disturbed it.

    Args:
        scene: Whose contacts are found.
        motion: Of its tool.
    """
    passes = np.array([_time_pass(scene, motion) for _ in range(_PASSES)])
    percentiles = np.percentile(typical(passes), [50, 99, 99.9])
    median, p99, p99_9 = (1e6 * percentiles).tolist()
    return TickTimes(median, p99, p99_9)


def _time_pass(scene: Scene, motion: RecordedMotion) -> list[float]:
    """Returns what each tick took, s."""
    answer = _Answer(scene)
    seconds = []
    for tick in walk_tool(scene, motion):
        loop, root = tick.haptic.loop, tick.root
        query = loop.contact_query
        found = query.get_contacts_output_port().Eval(query.GetMyContextFromRoot(root))
        port = loop.contacts
        contacts = port.Eval(port.get_system().GetMyContextFromRoot(root))
        X_WTool, V_WTool = motion.X_WTool[tick.row], motion.V_WTool[tick.row]
        seconds.append(found.query_seconds + answer.time(contacts, X_WTool, V_WTool))
    return seconds


class _Answer:
    """Clusters and wrench of contacts, timed as the systems call them."""

    def __init__(self, scene: Scene):
        contact, objects = scene.contact, scene.environment
        none = _core.SceneTracker(_FAR, [_FAR], 0.0)
        empty = none.query(np.array([1.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0]))
        self._cluster = CallTimer(_choose_clustering(contact), (empty,))
        stiffness = [item.material.stiffness_N_per_m for item in objects]
        damping = [item.material.damping_Ns_per_m for item in objects]
        rest = np.zeros((len(objects), 6))
        force: Callable[..., Any] = partial(
            _core.penalty_force,
            p_WO=rest[:, :3].copy(),
            V_WO=rest,
            stiffness=np.array(
                [contact.stiffness_N_per_m if k is None else k for k in stiffness]
            ),
            damping=np.array(
                [contact.damping_Ns_per_m if b is None else b for b in damping]
            ),
        )
        no_clusters = _choose_clustering(contact)(empty)
        self._force = CallTimer(force, (no_clusters, np.zeros(3), np.zeros(6)))

    def time(
        self, contacts: _core.ContactSet, X_WTool: np.ndarray, V_WTool: np.ndarray
    ) -> float:
        """Returns how long clusters and wrench took, s."""
        clusters, cluster_s = self._cluster.call((contacts,))
        _, force_s = self._force.call((clusters, X_WTool[4:], V_WTool))
        return max(cluster_s, 0.0) + max(force_s, 0.0)


def _choose_clustering(contact: Contact) -> Callable[[Any], Any]:
    if contact.clustering == "shared":
        return partial(_core.share_stiffness, tolerance=contact.tolerance_m)
    return partial(
        _core.cluster_contacts,
        delta=contact.cluster_size_m,
        tolerance=contact.tolerance_m,
    )


def _make_point() -> _core.Decomposition:
    """Returns something that nothing touches where it is not."""
    corner = np.eye(3)
    triangle = np.array([[0, 1, 2]], dtype=np.int32)
    return _core.assemble_surface_pieces(corner, triangle, np.zeros(1, dtype=np.int32))


_FAR = _make_point()
