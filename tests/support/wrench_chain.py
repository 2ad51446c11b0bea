"""The whole way from bodies to wrenches, and how far a wrench is from a formula."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from drake_haptics import _core

TOLERANCE_M = 1e-3
STIFFNESS_N_PER_M = 2000.0
DAMPING_NS_PER_M = 4.0
# Smaller than the distances between the contacts of all scenarios.
DELTA_M = 2e-3
# Relative; of lengths of 0.3 m against compressions of 1 mm.
ROUND_OFF = 1e-11
AT_REST = np.zeros(6)
# Of clustering.
METHODS = ("octree", "shared")


def _pose(R: Rotation, p: np.ndarray) -> np.ndarray:
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R.as_matrix(), p
    return X


# Scenarios are written in their own frame S, which lies askew in the world: no axis of
# S is one of W, and no origin falls together.
X_WS = _pose(Rotation.from_rotvec([0.4, -0.7, 1.1]), np.array([0.31, -0.17, 0.23]))


@dataclass(frozen=True)
class Body:
    """A body in a scenario.

    Attributes:
        shape: Pieces of the body, in its frame B.
        X_SB: (4, 4) pose of the body.
        V_SB: (6,) spatial velocity of its origin, rad/s and m/s.
        stiffness_N_per_m: Stiffness of an object; nothing for the tool.
        damping_Ns_per_m: Damping of an object; nothing for the tool.
    """

    shape: _core.ConvexPieces
    X_SB: np.ndarray
    V_SB: np.ndarray
    stiffness_N_per_m: float = STIFFNESS_N_PER_M
    damping_Ns_per_m: float = DAMPING_NS_PER_M


def place(
    shape: _core.ConvexPieces,
    p_SB: object = (0.0, 0.0, 0.0),
    rotvec: object = (0.0, 0.0, 0.0),
    V_SB: object = AT_REST,
    **material: float,
) -> Body:
    """A body at a position (m), turned by a rotation vector (rad)."""
    R = Rotation.from_rotvec(np.asarray(rotvec, float))
    X = _pose(R, np.asarray(p_SB, float))
    return Body(shape, X, np.asarray(V_SB, float), **material)


@dataclass(frozen=True)
class Wrenches:
    """The chain's answers, in S: [torque; force], N·m and N.

    Attributes:
        tool: (6,) wrench on the tool at its origin.
        objects: (m, 6) wrenches on each object at its origin.
        clusters: Clusters that were answered, in the world.
        answer: Answer of the core, in the world.
    """

    tool: np.ndarray
    objects: np.ndarray
    clusters: _core.ClusterSet
    answer: _core.PenaltyWrench


def run_chain(
    tool: Body, objects: Sequence[Body], method: str, delta_m: float = DELTA_M
) -> Wrenches:
    """Runs query, clusters and penalty force, from nothing known before.

    Args:
        tool: The tool.
        objects: Objects that it may meet.
        method: "octree" or "shared".
        delta_m: Cluster size of the octree, m.
    """
    tracker = _core.SceneTracker(tool.shape, [o.shape for o in objects], TOLERANCE_M)
    X_WO = [X_WS @ o.X_SB for o in objects]
    for i, X in enumerate(X_WO):
        tracker.set_object_pose(i, X)
    X_WT = X_WS @ tool.X_SB
    contacts = tracker.query(X_WT)
    clusters = cluster(contacts, method, TOLERANCE_M, delta_m)
    found = _core.penalty_force(
        clusters,
        X_WT[:3, 3],
        turned(X_WS[:3, :3], tool.V_SB),
        np.array([X[:3, 3] for X in X_WO]),
        np.array([turned(X_WS[:3, :3], o.V_SB) for o in objects]),
        np.array([o.stiffness_N_per_m for o in objects]),
        np.array([o.damping_Ns_per_m for o in objects]),
    )
    R_SW = X_WS[:3, :3].T
    return Wrenches(
        turned(R_SW, found.F_To_W), turned(R_SW, found.F_objects_W), clusters, found
    )


def push(
    clusters: _core.ClusterSet,
    stiffness_N_per_m: float,
    damping_Ns_per_m: float = 0.0,
    *,
    p_WTo: np.ndarray = AT_REST[:3],
    V_WT: np.ndarray = AT_REST,
) -> _core.PenaltyWrench:
    """Returns the wrench of one object that rests, on a tool at rest or moving."""
    gains = np.array([stiffness_N_per_m]), np.array([damping_Ns_per_m])
    still = np.zeros((1, 3)), np.zeros((1, 6))
    return _core.penalty_force(clusters, p_WTo, V_WT, *still, *gains)


def cluster(
    contacts: _core.ContactSet, method: str, tolerance_m: float, delta_m: float
) -> _core.ClusterSet:
    """Returns the clusters of a method."""
    if method == "octree":
        return _core.cluster_contacts(contacts, delta_m, tolerance_m)
    return _core.share_stiffness(contacts, tolerance_m)


def turned(R: np.ndarray, wrench: np.ndarray) -> np.ndarray:
    """Returns both halves of (..., 6) in another frame."""
    halves = np.asarray(wrench).reshape(*np.shape(wrench)[:-1], 2, 3)
    return (halves @ R.T).reshape(np.shape(wrench))


def wrench_at(p: object, f: object) -> np.ndarray:
    """Returns a force (3,) at a point (3,) as a wrench (6,) about the origin."""
    p, f = np.asarray(p, float), np.asarray(f, float)
    return np.concatenate([np.cross(p, f), f])


@dataclass(frozen=True)
class Case:
    """A wrench beside its closed form.

    Attributes:
        scenario: Names of the bodies that touch.
        formula: The closed form, in words of the paper.
        equations: Numbers of the paper's equations that it tests.
        method: Method of clustering.
        expected: (6,) or (..., 6) expected [torque; force], N·m and N.
        measured: The chain's [torque; force], of the same shape.
        arm_m: Length that makes torques comparable with forces.
        bound: Largest relative error that the formula allows; round-off where it is
            exact.
    """

    scenario: str
    formula: str
    equations: str
    method: str
    expected: np.ndarray
    measured: np.ndarray
    arm_m: float
    bound: float = ROUND_OFF

    @property
    def error(self) -> float:
        """Larger of |Δf| / |f| and |Δτ| / (|f| arm), |f| the largest expected."""
        expected = np.reshape(self.expected, (-1, 6))
        off = np.reshape(self.measured, (-1, 6)) - expected
        scale = np.linalg.norm(expected[:, 3:], axis=1).max()
        torque = np.linalg.norm(off[:, :3], axis=1).max() / self.arm_m
        return float(max(torque, np.linalg.norm(off[:, 3:], axis=1).max()) / scale)
