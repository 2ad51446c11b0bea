"""Figure 12: a pen passes over a sphere, in and out of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pair_motion import rotation, unit
from drake_haptics.evaluation.paper.pen_truth import ContactCurves, calc_sphere_contact
from drake_haptics.evaluation.paper.smoothness import Smoothness, measure_smoothness
from drake_haptics.evaluation.shapes.solids import make_pen, make_sphere
from drake_haptics.evaluation.shapes.surface import Surface

_Follow = Callable[[Surface, Surface, np.ndarray], ContactCurves]

RADIUS_M = 0.040
OURS = "drake_haptics"
EXACT = "exact depth"
_SECONDS = 3.0
_RATE_HZ = 1000.0
_ARC_RAD = 2.0
_TILT_RAD = 0.6
# Off by 1.5 mm and 2.5 mm deep in turn.
_MIDDLE_M, _SWING_M = -0.0005, 0.0020


@dataclass(frozen=True)
class PenPass:
    """A pass, by each library and in truth.

    Attributes:
        time_s: (n,) of each tick, s.
        triangles: Of the polyhedron that stands for the sphere.
        corner_deg: Largest angle between neighboring faces of it.
        truth: On a perfect sphere.
        curves: By library; this package's under `OURS`.
        smoothness: By library.
        exact: Of the exact depth of the two polyhedra: what no query can better.
    """

    time_s: np.ndarray
    triangles: int
    corner_deg: float
    truth: ContactCurves
    curves: dict[str, ContactCurves]
    smoothness: dict[str, Smoothness]
    exact: Smoothness

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures, without the curves, ready for JSON."""
        return {
            "ticks": len(self.time_s),
            "triangles": self.triangles,
            "corner_deg": self.corner_deg,
            "smoothness": {n: asdict(s) for n, s in self.smoothness.items()},
            "exact": asdict(self.exact),
        }


def plan_pen_pass(seconds: float = _SECONDS) -> np.ndarray:
    """Returns X_WA (n, 4, 4), the pen's poses a millisecond apart.

    Its tip runs over the sphere in an arc, rising and falling through its surface,
    while the pen leans to one side and the other.

    Args:
        seconds: How long the pass takes, s.
    """
    phase = np.linspace(0.0, 1.0, round(seconds * _RATE_HZ))
    X_WA = np.tile(np.eye(4), (len(phase), 1, 1))
    side_W = unit(np.array([0.2, 1.0, 0.1]))
    top_W = unit(np.cross(np.cross(side_W, [0.0, 0.0, 1.0]), side_W))
    for X, s in zip(X_WA, phase, strict=True):
        out_W = rotation(side_W, _ARC_RAD * (s - 0.5)) @ top_W
        off_m = _MIDDLE_M + _SWING_M * np.cos(4.0 * np.pi * s)
        lean = rotation(side_W, _TILT_RAD * np.cos(2.0 * np.pi * s))
        lean = rotation(np.cross(side_W, out_W), 0.5 * _TILT_RAD) @ lean
        X[:3, 2] = lean @ out_W
        X[:3, 0] = lean @ np.cross(side_W, out_W)
        X[:3, 1] = np.cross(X[:3, 2], X[:3, 0])
        X[:3, 3] = (RADIUS_M + off_m) * out_W
    return X_WA


def measure_pen_pass(
    sphere: Surface | None = None, seconds: float = _SECONDS
) -> PenPass:
    """Follows the contact of the package's pen and a sphere along a pass.

    Args:
        sphere: About the origin; the package's own if not given.
        seconds: How long the pass takes, s.
    """
    pen = make_pen()
    sphere = sphere or make_sphere()
    X_WA = plan_pen_pass(seconds)
    truth = calc_sphere_contact(pen.vertices, pen.triangles, X_WA, RADIUS_M)
    curves = {
        name: follow(pen, sphere, X_WA) for name, follow in _find_libraries().items()
    }
    return PenPass(
        time_s=np.arange(len(X_WA)) / _RATE_HZ,
        triangles=len(sphere.triangles),
        corner_deg=_find_corner(sphere),
        truth=truth,
        curves=curves,
        smoothness={n: measure_smoothness(c, truth) for n, c in curves.items()},
        exact=measure_smoothness(_follow(pen, sphere, X_WA, "global"), truth),
    )


def _follow(
    pen: Surface,
    sphere: Surface,
    X_WA: np.ndarray,
    depth: Literal["tracked", "global"] = "tracked",
) -> ContactCurves:
    """Our own answers."""
    A, B = (ConvexPolytope(body.vertices) for body in (pen, sphere))
    pair = ConvexPair(A, B, depth)
    found = pair.query_trajectory(X_WA, np.eye(4))
    return ContactCurves(found.distance, found.nhat_BA_W, found.p_WC)


def _find_libraries() -> dict[str, _Follow]:
    """Returns what can follow a contact here, by name."""
    found: dict[str, _Follow] = {OURS: _follow}
    try:
        from drake_haptics.evaluation.paper.coal_contact import follow_with_coal
    except ImportError:
        return found
    return {**found, "coal": follow_with_coal}


def _find_corner(surface: Surface) -> float:
    """Returns the largest angle between neighboring faces, degrees."""
    corners = surface.vertices[surface.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    face_of_side = {
        (int(t[k]), int(t[(k + 1) % 3])): i
        for i, t in enumerate(surface.triangles)
        for k in range(3)
    }
    pairs = np.array(
        [(i, face_of_side[b, a]) for (a, b), i in face_of_side.items() if a < b]
    )
    cosine = np.einsum("ni,ni->n", normal[pairs[:, 0]], normal[pairs[:, 1]])
    return float(np.rad2deg(np.arccos(np.clip(cosine, -1.0, 1.0)).max()))
