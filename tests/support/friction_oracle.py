"""Stick-slip friction written down in plain NumPy, contact by contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass(frozen=True)
class Law:
    """Parameters: μ of each object, static ratio r, break-away and reach, m."""

    coefficient: tuple[float, ...]
    static_ratio: float
    break_away_m: float
    reach_m: float


@dataclass
class Touch:
    """A contact in the world: m, N."""

    object: int
    p: np.ndarray
    n: np.ndarray
    N: float
    z: np.ndarray = field(default_factory=lambda: np.zeros(3))
    load: float = 0.0
    grip: float = 1.0


def matrix(q: np.ndarray) -> np.ndarray:
    """Returns the pose [qw qx qy qz x y z] as (4, 4)."""
    X = np.eye(4)
    X[:3, :3] = Rotation.from_quat(np.roll(q[:4], -1)).as_matrix()
    X[:3, 3] = q[4:]
    return X


def moved(X_last: np.ndarray, X: np.ndarray, t: Touch) -> tuple[np.ndarray, np.ndarray]:
    """Returns the point and the normal of the contact as a body took them along."""
    change = X @ np.linalg.inv(X_last)
    return change[:3, :3] @ t.p + change[:3, 3], change[:3, :3] @ t.n


def closeness(t: Touch, seen: list[tuple[np.ndarray, np.ndarray]], law: Law) -> float:
    """Returns d⁴ = Π d² over the places where a contact is seen."""
    d4 = 1.0
    for p, n in seen:
        d4 *= np.sum((t.p - p) ** 2) / law.reach_m**2 + np.sum((t.n - n) ** 2)
    return d4


def inherit(
    last: list[Touch],
    now: list[Touch],
    X_tool: tuple[np.ndarray, np.ndarray],
    X_objects: list[tuple[np.ndarray, np.ndarray]],
    law: Law,
) -> None:
    """Gives each of `now` its z, load and grip before slip (friction_tracking.h)."""
    bags = np.zeros((len(now), 5))  # load, load·z, load·grip
    for old in last:
        X_object = X_objects[old.object]
        on_tool, on_object = moved(*X_tool, old), moved(*X_object, old)
        turn = X_object[1][:3, :3] @ X_object[0][:3, :3].T
        z = turn @ old.z + on_tool[0] - on_object[0]
        weights = np.array(
            [
                t.N / (1e-24 + closeness(t, [on_tool, on_object], law))
                if t.object == old.object
                else 0.0
                for t in now
            ]
        )
        bag = old.load * np.concatenate([[1.0], z, [old.grip]])
        bags += np.outer(weights / (weights.sum() + old.load), bag)

    k = len(now)
    excess = np.array([bag[0] - t.N for bag, t in zip(bags, now, strict=True)])
    part = np.zeros((k, k))
    for i, a in enumerate(now):
        for j, b in enumerate(now):
            if excess[i] > 0 > excess[j] and a.object == b.object:
                part[i, j] = 1 / (1 + closeness(b, [(a.p, a.n)] * 2, law))
    surplus, lack = np.maximum(excess, 0), np.maximum(-excess, 0)
    wanted, given = part @ lack, surplus @ part
    before = bags.copy()
    for i in range(k):
        for j in range(k):
            if part[i, j] > 0:
                most = max(wanted[i], given[j], surplus[i], lack[j])
                flow = part[i, j] * surplus[i] * lack[j] / most
                bags[j] += before[i] * flow / before[i, 0]
                bags[i] -= before[i] * flow / before[i, 0]

    for bag, t in zip(bags, now, strict=True):
        whole = max(bag[0], t.N)
        z = bag[1:4] / whole
        t.z = z - (z @ t.n) * t.n
        t.grip = (bag[4] + whole - bag[0]) / whole
        t.load = min(whole, 2 * t.N)


def slip(t: Touch, law: Law) -> np.ndarray:
    """Lets a contact slip as far as it must; returns the force on the tool, N.

    The slip is found by bisection: the least one after which the force is within the
    limit that this slip leaves.
    """
    mu = law.coefficient[t.object]
    k = law.static_ratio * mu * t.load / law.break_away_m

    def excess(s: float) -> float:
        grip = max(t.grip - s / law.break_away_m, 0)
        limit = mu * t.N * (1 + grip * (law.static_ratio - 1))
        return k * (length - s) - limit

    length = float(np.linalg.norm(t.z))
    if excess(0.0) > 0:
        low, high = 0.0, length
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        t.z = t.z * (1 - high / length)
        t.grip = max(t.grip - high / law.break_away_m, 0)
    f = -k * t.z
    load_shedding = 1 - np.linalg.norm(f) / (mu * t.N)
    t.grip = min(1, max(t.grip, 2 * load_shedding / (law.static_ratio - 1)))
    return f


def step(
    last: list[Touch],
    now: list[Touch],
    X_tool: tuple[np.ndarray, np.ndarray],
    X_objects: list[tuple[np.ndarray, np.ndarray]],
    law: Law,
) -> np.ndarray:
    """Returns the forces (k, 3) of `now`, N, and fills in what they remember."""
    inherit(last, now, X_tool, X_objects, law)
    return np.array([slip(t, law) for t in now]).reshape(-1, 3)
