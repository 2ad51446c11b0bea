"""What the contacts of a tick take inside the core."""

from __future__ import annotations

import time
from typing import cast

import numpy as np

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.measuring.native_part import NativePart
from drake_haptics.evaluation.measuring.timing import CallTimer, TickTimes, typical
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.systems.contact.contact_query import DepthSearch

# As often each tick is timed; but no pass begins later than this, s.
_PASSES = 3
_LONGEST_S = 1.0
# Where nothing touches the tool, m.
_FAR_M = 1e3


def make_native_part(haptic: HapticDiagram) -> NativePart:
    """Returns what the systems of a scene ask the core.

    Effects are no part of it, and what a loop leaves out under load is not left out.
    """
    scene, effects = haptic.scene, haptic.scene.effects
    contact, items = scene.contact, scene.environment
    stiffness = [item.material.stiffness_N_per_m for item in items]
    damping = [item.material.damping_Ns_per_m for item in items]
    query_hz = contact.query_rate_hz
    braking_m = 0.0 if effects.braking is None else effects.braking.distance_m
    return NativePart(
        tool=haptic.tool,
        objects=haptic.environment,
        X_WO=np.array(
            [pose_to_vector(item.pose.to_rigid_transform()) for item in items]
        ),
        search_m=max(contact.tolerance_m, braking_m),
        depth=cast(DepthSearch, contact.depth),
        max_walk_steps=contact.max_walk_steps,
        query_every=None
        if query_hz is None
        else round(scene.device.rate_hz / query_hz),
        tolerance_m=contact.tolerance_m,
        cluster_size_m=contact.cluster_size_m,
        stiffness_N_per_m=np.array(
            [contact.stiffness_N_per_m if k is None else k for k in stiffness]
        ),
        damping_Ns_per_m=np.array(
            [contact.damping_Ns_per_m if b is None else b for b in damping]
        ),
    )


def time_native(part: NativePart, motion: RecordedMotion) -> TickTimes:
    """Times query, clusters and wrench of a recorded motion, without Python.

    The query is timed inside the core; of carrying, clusters and wrench what a call
    takes more than one without contacts. Each tick counts with the middle of several
    passes, so that the percentiles are those of the work, not of what disturbed it.

    Args:
        part: What the core is asked.
        motion: Of the tool.
    """
    far = np.array([1.0, 0.0, 0.0, 0.0, _FAR_M, 0.0, 0.0])
    nothing, _ = part.make_search().look(far)
    cluster = CallTimer(part.make_clustering(), (nothing,))
    none = part.make_clustering()(nothing)
    force = CallTimer(part.make_force(), (none, far[4:], np.zeros(6)))
    passes: list[np.ndarray] = []
    begin_s = time.perf_counter()
    while len(passes) < _PASSES and time.perf_counter() < begin_s + _LONGEST_S:
        passes.append(np.zeros(len(motion)))
        search = part.make_search()
        carry = CallTimer(search.carry, (nothing, far))
        for tick, X_WTool in enumerate(motion.X_WTool):
            found, query_s = search.look(X_WTool)
            contacts, carry_s = carry.call((found, X_WTool))
            clusters, cluster_s = cluster.call((contacts,))
            _, force_s = force.call((clusters, X_WTool[4:], motion.V_WTool[tick]))
            # A call without contacts is the least there is, but for the clock's ticks.
            passes[-1][tick] = query_s + carry_s + cluster_s + force_s
    return TickTimes.of(np.maximum(typical(np.array(passes)), 0.0))
