"""Measures how much the wrench changes on a walk in contact: by query or clusters."""

from __future__ import annotations

import copy
from dataclasses import astuple, dataclass, replace

import numpy as np
from continuity_walk import (
    Tick,
    WalkScene,
    calc_compression,
    calc_rotation,
    calc_turn,
    walk,
)
from press_rig import Gains
from wrench_chain import METHODS, cluster, push

from drake_haptics import _core

# A ratio over this counts as a jump, and a contact's change of so many times the
# motion as the query's doing.
JUMP = 10.0


@dataclass(frozen=True)
class QueryChange:
    """Changes of the query in a step, the input of the rest of the chain, m.

    Each is the change of the contact that changed most.

    Attributes:
        came: Compression of a contact that came or went.
        distance: Change of the distance of a contact that stayed.
        normal: Its compression times the turn of its normal.
        point: Its compression times the shift of its point over L.
        patch: Its compression times the change of its extent, relative to the larger,
            or of its flushness.
    """

    came: float
    distance: float
    normal: float
    point: float
    patch: float


def compare(
    a: _core.ContactSet, b: _core.ContactSet, tolerance_m: float, size_m: float
) -> QueryChange:
    """Returns the changes from the contacts `a` to the contacts `b`."""
    c_a, c_b = calc_compression(a, tolerance_m), calc_compression(b, tolerance_m)
    keys_a, keys_b = _keys(a), _keys(b)
    if np.array_equal(keys_a, keys_b):
        at_a = at_b = np.arange(len(a))
        came = 0.0
    else:
        _, at_a, at_b = np.intersect1d(keys_a, keys_b, True, True)
        came = max(
            np.delete(c_a, at_a).max(initial=0), np.delete(c_b, at_b).max(initial=0)
        )
    c = np.maximum(c_a[at_a], c_b[at_b])
    distance = np.abs(c_a[at_a] - c_b[at_b])
    normal = c * np.linalg.norm(a.nhat_BA_W[at_a] - b.nhat_BA_W[at_b], axis=1)
    point = c * np.linalg.norm(a.p_WC[at_a] - b.p_WC[at_b], axis=1) / size_m
    E_a, E_b = a.extent[at_a], b.extent[at_b]
    extent = np.abs(E_a - E_b) / np.maximum(np.maximum(E_a, E_b), 1e-300)
    patch = c * np.maximum(extent, np.abs(a.flushness[at_a] - b.flushness[at_b]))
    parts = (distance, normal, point, patch)
    return QueryChange(float(came), *(float(x.max(initial=0)) for x in parts))


def _keys(contacts: _core.ContactSet) -> np.ndarray:
    return (
        contacts.object_index.astype(np.int64) << 48
        | contacts.piece_A.astype(np.int64) << 24
        | contacts.piece_B.astype(np.int64)
    )


def elastic_wrench(
    contacts: _core.ContactSet, method: str, gains: Gains, p_WM: np.ndarray
) -> np.ndarray:
    """Returns the chain's torque about M and force (6,) at rest, N·m and N."""
    clusters = cluster(contacts, method, gains.tolerance_m, gains.delta_m)
    return push(clusters, gains.stiffness_N_per_m, p_WTo=p_WM).F_To_W


@dataclass(frozen=True)
class Steps:
    """The steps of a walk through one method, as columns over n steps.

    Attributes:
        moved_m: Largest displacement of a point of the tool, |Δx|.
        force_m: Change of the force, |ΔF| / k.
        torque_m: Change of the torque, |Δτ| / (k L).
        steep: Whether a change above JUMP is spread over the step, and so no jump.
        query_m: (n, 5) columns of QueryChange.
        at: Number of the step in the walk.
    """

    moved_m: np.ndarray
    force_m: np.ndarray
    torque_m: np.ndarray
    steep: np.ndarray
    query_m: np.ndarray
    at: np.ndarray

    @property
    def ratio(self) -> np.ndarray:
        """Ratio (n, 2) of force and torque to the motion."""
        return np.stack([self.force_m, self.torque_m], 1) / self.moved_m[:, None]

    @property
    def chain_gain(self) -> np.ndarray:
        """Ratio (n,) of the wrench to its inputs: contacts and pose."""
        largest = np.maximum(self.moved_m, self.query_m.max(axis=1))
        return np.maximum(self.force_m, self.torque_m) / largest

    @property
    def exceeds(self) -> np.ndarray:
        """Whether (n,) force or torque changed by over JUMP times the motion."""
        return self.ratio.max(axis=1) > JUMP

    @property
    def causes(self) -> np.ndarray:
        """Item of CAUSES (n,) that would explain each step, whatever its ratio."""
        changed = self.query_m > JUMP * self.moved_m[:, None]
        of_query = np.where(changed.any(1), changed.argmax(1), CAUSES.index("clusters"))
        return np.where(self.steep, CAUSES.index("steep"), of_query)


CAUSES = ("came or went", "distance", "normal", "point", "patch", "clusters", "steep")


class _Meter:
    """Wrenches of a scene in units of displacement."""

    def __init__(self, scene: WalkScene, method: str):
        self._scene, self._method = scene, method
        k = scene.gains.stiffness_N_per_m
        self._unit = np.array([k * scene.size_m] * 3 + [k] * 3)

    def read(self, X_WT: np.ndarray, contacts: _core.ContactSet) -> np.ndarray:
        """Returns torque / (k L) and force / k (6,), m."""
        scene, M = self._scene, self._scene.p_TM
        p_WM = X_WT[:3, :3] @ M + X_WT[:3, 3]
        return elastic_wrench(contacts, self._method, scene.gains, p_WM) / self._unit

    def is_steep(self, before: Tick, X_WT: np.ndarray) -> bool:
        """Tells whether no thirty-second part of a step has half of its change."""
        tracker, last = before.tracker, self.read(before.X_WT, before.contacts)
        turn = calc_turn(X_WT[:3, :3] @ before.X_WT[:3, :3].T)
        changes = []
        for s in np.linspace(0, 1, 33)[1:]:
            X = (1 - s) * before.X_WT + s * X_WT
            X[:3, :3] = calc_rotation(s * turn) @ before.X_WT[:3, :3]
            now = self.read(X, tracker.query(X))
            changes.append(_halves(now - last).max())
            last = now
        return max(changes) < 0.5 * sum(changes)


def _halves(change: np.ndarray) -> np.ndarray:
    """Returns the lengths (2,) of the force's and the torque's part."""
    return np.array([np.linalg.norm(change[3:]), np.linalg.norm(change[:3])])


def measure(
    scene: WalkScene, steps: int, methods: tuple[str, ...] = METHODS, seed: int = 0
) -> dict[str, Steps]:
    """Walks, and returns the steps through each method."""
    meters = {method: _Meter(scene, method) for method in methods}
    rows: dict[str, list[tuple[float, ...]]] = {method: [] for method in methods}
    common: list[tuple[float, ...]] = []
    last: Tick | None = None
    before: dict[str, np.ndarray] = {}
    for at, tick in enumerate(walk(scene, steps, seed)):
        now = {m: meter.read(tick.X_WT, tick.contacts) for m, meter in meters.items()}
        if last is not None and not tick.begins:
            change = compare(
                last.contacts, tick.contacts, scene.gains.tolerance_m, scene.size_m
            )
            step = scene.points_T @ (tick.X_WT - last.X_WT)[:3, :3].T
            step += (tick.X_WT - last.X_WT)[:3, 3]
            moved = float(np.linalg.norm(step, axis=1).max())
            common.append((at, moved, *astuple(change)))
            for m, meter in meters.items():
                halves = _halves(now[m] - before[m])
                steep = halves.max() > JUMP * moved and meter.is_steep(
                    replace(last, tracker=copy.copy(last.tracker)), tick.X_WT
                )
                rows[m].append((*halves, steep))
        last, before = replace(tick, tracker=copy.copy(tick.tracker)), now
    at_step, moved_m, *query_m = np.array(common).T
    found = {}
    for m in methods:
        force_m, torque_m, steep = np.array(rows[m]).T
        found[m] = Steps(
            moved_m,
            force_m,
            torque_m,
            steep > 0,
            np.stack(query_m, 1),
            at_step.astype(int),
        )
    return found
