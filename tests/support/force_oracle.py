"""From contacts to wrenches in plain NumPy, one line for each equation."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
from scipy.optimize import nnls

from drake_haptics import _core

# The constants of shared_stiffness.h.
OWN_SHARE = 0.25  # ρ
SAME_PLANE = 1.37e-3  # 1 - cos(3°)
SAME_DIRECTION = 0.293  # 1 - cos(45°)
ALMOST = 1.25
SAME_DEPTH = 0.25
LAYER_SHARE = 0.1
LEAST_EXTENT_M2 = 1e-24


@dataclass(frozen=True)
class Pushes:
    """The push of each cluster.

    Attributes:
        compression: (k,) elastic force over the stiffness, m.
        damping_share: (k,) share of the damping.
        nhat: (k, 3) directions.
        p: (k, 3) places, m.
        objects: (k,) object of each cluster.
    """

    compression: np.ndarray
    damping_share: np.ndarray
    nhat: np.ndarray
    p: np.ndarray
    objects: np.ndarray


def fade(x: np.ndarray, width: object) -> np.ndarray:
    """Returns 1 at 0, falling to 0 from `width` on."""
    x, width = np.broadcast_arrays(x, np.asarray(width, float))
    ratio = np.divide(x, width, out=np.ones_like(width), where=width > 0)
    return np.where(x == 0, 1, np.clip(1 - ratio, 0, 1))


def sameness(contacts: _core.ContactSet, pushing: np.ndarray, t: float) -> np.ndarray:
    """Returns how far contacts share a constraint, pair by pair, 0 to 1."""
    n, p = contacts.nhat_BA_W[pushing], contacts.p_WC[pushing]
    w = t - contacts.distance[pushing]
    flushness, extent = contacts.flushness[pushing], contacts.extent[pushing]
    reach = flushness * extent / (2 * LAYER_SHARE * t) if t > 0 else 0 * w
    apart = np.linalg.norm(p[:, None] - p[None], axis=2) - np.add.outer(reach, reach)
    place = fade(np.maximum(0, apart), t)
    turn = np.maximum(0, 1 - n @ n.T)
    flush = np.outer(flushness, flushness)
    depth = fade(np.abs(w[:, None] - w[None]), SAME_DEPTH * np.maximum.outer(w, w))
    part = np.maximum(
        fade(turn, SAME_PLANE) * flush, fade(turn, SAME_DIRECTION) * place
    )
    same = np.minimum(1, ALMOST * depth * part)
    np.fill_diagonal(same, 1)
    return same


def shares(contacts: _core.ContactSet, pushing: np.ndarray, t: float) -> np.ndarray:
    """∫ E_i / Σ_j (E_j where j is the same to more than θ) dθ over θ from 0 to 1."""
    same = sameness(contacts, pushing, t)
    extent = contacts.extent[pushing] + LEAST_EXTENT_M2
    theta = np.unique([0.0, 1.0, *same.ravel()])
    total = np.zeros(len(pushing))
    for low, high in pairwise(theta):
        total += (high - low) * extent / ((same >= high) @ extent)
    return total


def compliance(n: np.ndarray, m: np.ndarray) -> np.ndarray:
    """C of the elastic skin under contacts along n with shares m."""
    cross = np.linalg.norm(np.cross(n[:, None], n[None]), axis=2)
    angle = np.arctan2(cross, n @ n.T) / (np.pi / 2)
    common = np.where(angle < 1, (1 + 4 * angle) * (1 - angle) ** 4, 0)
    np.fill_diagonal(common, 1)
    return (1 - OWN_SHARE) * common + OWN_SHARE * np.diag(1 / m)


def skin_forces(C: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The minimum of ½ λᵀ C λ - wᵀ λ over λ >= 0, as a least squares problem."""
    L = np.linalg.cholesky(C)
    return nnls(L.T, np.linalg.solve(L, w))[0]


def skin_forces_of_all_sets(C: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Returns the same minimum by trying every set of contacts that may push."""
    for choice in product((False, True), repeat=len(w)):
        chosen = np.array(choice, dtype=bool)
        force = np.zeros(len(w))
        force[chosen] = np.linalg.solve(C[np.ix_(chosen, chosen)], w[chosen])
        overlap = w - C @ force
        slack = 1e-12 * np.abs(w).max()
        if (force >= -slack).all() and (overlap[~chosen] <= slack).all():
            return force
    raise AssertionError("no set of contacts satisfies the conditions")


def shared(contacts: _core.ContactSet, t: float) -> Pushes:
    """Contacts that share stiffness, object by object."""
    pushing = np.flatnonzero(contacts.distance < t)
    objects = contacts.object_index[pushing]
    n, w = contacts.nhat_BA_W[pushing], t - contacts.distance[pushing]
    compression = np.zeros(len(pushing))
    for o in np.unique(objects):
        on = np.flatnonzero(objects == o)
        m = shares(contacts, pushing[on], t)
        compression[on] = skin_forces(compliance(n[on], m), w[on])
    damping_share = compression / np.maximum(w, LAYER_SHARE * t)
    return Pushes(compression, damping_share, n, contacts.p_WC[pushing], objects)


def octree(contacts: _core.ContactSet, label: np.ndarray, t: float) -> Pushes:
    """The representatives (Eq. 3 to 5) of clusters that are given by labels."""
    count = int(label.max(initial=-1)) + 1
    n, p = np.zeros((2, count, 3))
    w, objects = np.zeros(count), np.zeros(count, dtype=int)
    for k in range(count):
        member = label == k
        weight = (t - contacts.distance[member])[:, None]
        mean = (weight * contacts.nhat_BA_W[member]).sum(axis=0)
        n[k] = mean / np.linalg.norm(mean)
        p[k] = (weight * contacts.p_WC[member]).sum(axis=0) / weight.sum()
        w[k] = t - contacts.distance[member].min()
        objects[k] = contacts.object_index[member][0]
    return Pushes(w, np.ones(count), n, p, objects)


def wrenches(
    pushes: Pushes,
    p_WTo: np.ndarray,
    V_WT: np.ndarray,
    p_WO: np.ndarray,
    V_WO: np.ndarray,
    k: np.ndarray,
    kv: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The wrench (6,) on the tool and (m, 6) on the objects (Eq. 6 to 10)."""
    F, F_objects = np.zeros(6), np.zeros((len(k), 6))
    for compression, share, n, p, o in zip(
        pushes.compression,
        pushes.damping_share,
        pushes.nhat,
        pushes.p,
        pushes.objects,
        strict=True,
    ):
        v_A = V_WT[3:] + np.cross(V_WT[:3], p - p_WTo)
        v_B = V_WO[o, 3:] + np.cross(V_WO[o, :3], p - p_WO[o])
        v = (v_A - v_B) @ n
        f = (k[o] * compression - (kv[o] * share * v if v < 0 else 0)) * n
        F += np.concatenate([np.cross(p - p_WTo, f), f])
        F_objects[o] -= np.concatenate([np.cross(p - p_WO[o], f), f])
    return F, F_objects
