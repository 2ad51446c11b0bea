"""The pairs of shapes of reported_pairs.yaml.

A rotation of few digits is made orthonormal.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from hard_cases import bodies
from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False)
class ReportedPair:
    """A pair that a thread reports.

    Attributes:
        name: Name of the pair.
        link: Link to the thread.
        reported: Behavior of the library that the thread reports.
        A: (n, 3) vertices of the one body, m.
        B: (m, 3) vertices of the other, m.
        X_WA: (4, 4) pose of A.
        X_WB: (4, 4) pose of B.
        known_m: Signed distance by the thread or by a closed form, m, if there is one.
        known_to_m: Accuracy of `known_m`, m.
    """

    name: str
    link: str
    reported: str
    A: np.ndarray
    B: np.ndarray
    X_WA: np.ndarray
    X_WB: np.ndarray
    known_m: float | None = None
    known_to_m: float = 1e-12


def make_body(shape: dict) -> np.ndarray:
    """Vertices (n, 3), m, of a shape of the file.

    Args:
        shape: Whole extents of a `box`; the corners (n, 2) of a `prism` from z = −0.5
            to 0.5 m, or from x; `vertices`; or what `bodies.disc` takes.
    """
    if "box" in shape:
        return bodies.box(*np.array(shape["box"], float) / 2)
    if "vertices" in shape:
        return np.array(shape["vertices"], float)
    if "sides" in shape:
        return bodies.disc(**shape)
    ((kind, corners),) = shape.items()
    base = np.column_stack([corners, np.full(len(corners), 0.5)])
    prism = np.concatenate([base, base * [1, 1, -1]])
    return prism if kind == "prism" else np.roll(prism, 1, axis=1)


def make_pose(pose: dict) -> np.ndarray:
    """A pose (4, 4) from `p`, m, and a rotation `R` or a quaternion `wxyz`, if any."""
    X = np.eye(4)
    X[:3, 3] = pose["p"]
    if "wxyz" in pose:
        w, x, y, z = pose["wxyz"]
        X[:3, :3] = Rotation.from_quat([x, y, z, w]).as_matrix()
    if "R" in pose:
        given = np.array(pose["R"], float)
        u, _, v = np.linalg.svd(given)
        # Digits that are right stay as they are.
        X[:3, :3] = given if abs(given - u @ v).max() < 1e-14 else u @ v
    return X


def read_pairs() -> list[ReportedPair]:
    """The pairs in the file's order."""
    make = {"A": make_body, "B": make_body, "X_WA": make_pose, "X_WB": make_pose}
    pairs = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text("utf-8"))
    return [
        ReportedPair(**{k: make[k](v) if k in make else v for k, v in pair.items()})
        for pair in pairs
    ]


REPORTED_PAIRS = read_pairs()
