"""The scene's law of force on contacts that another library found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics import _core
from drake_haptics.evaluation.accuracy.peers.problem import PeerAnswers, PeerProblem


@dataclass(frozen=True, eq=False)
class FoundContacts:
    """The contacts at each of k ticks, tick after tick, n in all.

    Attributes:
        start: (k + 1,) those of tick i are the rows start[i] to start[i + 1].
        distance: (n,) signed distance, m.
        nhat_BA_W: (n, 3) unit normal out of the object into the tool.
        p_WCa: (n, 3) witness point on the tool, m.
        p_WCb: (n, 3) witness point on the object, m.
        object_index: (n,) which object.
        seconds: (k,) what finding them took, s.
    """

    start: np.ndarray
    distance: np.ndarray
    nhat_BA_W: np.ndarray
    p_WCa: np.ndarray
    p_WCb: np.ndarray
    object_index: np.ndarray
    seconds: np.ndarray


def apply_law(problem: PeerProblem, found: FoundContacts) -> PeerAnswers:
    """Returns what this package's clustering and penalty law make of contacts.

    So that the query alone differs. A contact without a finite normal pushes nothing.
    """
    part, motion = problem.part, problem.motion
    cluster, force = part.make_clustering(), part.make_force()
    F_Tool_W = np.zeros((len(motion), 6))
    distance = np.full(len(motion), np.inf)
    valid = np.isfinite(found.nhat_BA_W).all(axis=1)
    valid &= found.distance < part.tolerance_m
    for k in range(len(motion)):
        rows = np.arange(found.start[k], found.start[k + 1])
        rows = rows[valid[rows]]
        if len(rows) == 0:
            continue
        distance[k] = found.distance[rows].min()
        rows = rows[np.argsort(found.object_index[rows], kind="stable")]
        contacts = _core.contact_set(
            found.distance[rows],
            found.nhat_BA_W[rows],
            found.p_WCa[rows],
            found.p_WCb[rows],
            found.object_index[rows].astype(np.int32),
        )
        wrench = force(
            clusters=cluster(contacts),
            p_WTo=motion.X_WTool[k, 4:],
            V_WTool=motion.V_WTool[k],
        )
        F_Tool_W[k] = wrench.F_Tool_W
    return PeerAnswers(F_Tool_W, distance, part.tolerance_m, found.seconds)
