"""Follows the contact of a pen that passes over a sphere (Figure 12)."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from importlib.util import find_spec
from typing import Any, Literal

import numpy as np
import trimesh
from trimesh.triangles import closest_point

from drake_haptics._core import ConvexPair, ConvexPolytope
from drake_haptics.evaluation.benchmark.pairs import rotation, unit
from drake_haptics.evaluation.benchmark.python_pairs import CoalQuery
from drake_haptics.evaluation.models import load_shape
from drake_haptics.geometry.mesh.mesh import Mesh

RADIUS_M = 0.040
OURS = "drake_haptics"
EXACT = "exact depth"
_SECONDS = 3.0
_RATE_HZ = 1000.0
_ARC_RAD = 2.0
_TILT_RAD = 0.6
# The tip alternates between 1.5 mm outside and 2.5 mm deep.
_MIDDLE_M, _SWING_M = -0.0005, 0.0020


@dataclass(frozen=True)
class ContactCurves:
    """One contact, tick by tick.

    Attributes:
        distance_m: (n,) signed distances, negative in penetration, m.
        nhat_BA_W: (n, 3) unit normals out of the sphere into the pen.
        p_WC: (n, 3) means of both witness points, m.
    """

    distance_m: np.ndarray
    nhat_BA_W: np.ndarray
    p_WC: np.ndarray


def calc_sphere_contact(
    vertices: np.ndarray, triangles: np.ndarray, X_WA: np.ndarray, radius_m: float
) -> ContactCurves:
    """Calculates the contact of a convex body and a sphere about the world's origin.

    While the sphere's center is outside the body, the signed distance is that of the
    center from the body minus the radius, even in penetration.

    Args:
        vertices: (v, 3) vertices of the body, in its frame A, m.
        triangles: (t, 3) triangles of its surface.
        X_WA: (n, 4, 4) poses of A.
        radius_m: Radius of the sphere, m.
    """
    corners = vertices[triangles]
    nearest_W = np.empty((len(X_WA), 3))
    for k, X in enumerate(X_WA):
        p_ACenter = -X[:3, :3].T @ X[:3, 3]
        points = closest_point(corners, np.tile(p_ACenter, (len(corners), 1)))
        nearest_A = points[np.linalg.norm(points - p_ACenter, axis=1).argmin()]
        nearest_W[k] = X[:3, :3] @ nearest_A + X[:3, 3]
    far_m = np.linalg.norm(nearest_W, axis=1)
    normal_W = nearest_W / far_m[:, None]
    return ContactCurves(
        distance_m=far_m - radius_m,
        nhat_BA_W=normal_W,
        p_WC=(nearest_W + radius_m * normal_W) / 2,
    )


@dataclass(frozen=True)
class Smoothness:
    """Largest steps from tick to tick beyond those of the truth, and largest errors.

    A step is the change of a value from one tick to the next, minus the step of the
    truth, which the motion explains. A crossing is a step in which the distance changes
    sign.
    """

    point_step_m: float
    normal_step_deg: float
    distance_step_m: float
    crossing_step_m: float
    normal_error_deg: float
    distance_error_m: float
    true_normal_step_deg: float
    true_distance_step_m: float


def measure_smoothness(curves: ContactCurves, truth: ContactCurves) -> Smoothness:
    """Compares the curves of two or more ticks with the truth."""
    off_m = curves.distance_m - truth.distance_m
    steps_m = np.abs(np.diff(off_m))
    inside = curves.distance_m < 0.0
    crossing = inside[1:] != inside[:-1]
    # The chord of two unit vectors, as an angle.
    chord = np.linalg.norm(curves.nhat_BA_W - truth.nhat_BA_W, axis=1).max()
    return Smoothness(
        point_step_m=_largest_step(curves.p_WC - truth.p_WC),
        normal_step_deg=_degrees(_largest_step(curves.nhat_BA_W - truth.nhat_BA_W)),
        distance_step_m=float(steps_m.max()),
        crossing_step_m=float(steps_m[crossing].max(initial=0.0)),
        normal_error_deg=_degrees(2.0 * np.arcsin(min(1.0, chord / 2.0))),
        distance_error_m=float(np.abs(off_m).max()),
        true_normal_step_deg=_degrees(_largest_step(truth.nhat_BA_W)),
        true_distance_step_m=float(np.abs(np.diff(truth.distance_m)).max()),
    )


def _largest_step(values: np.ndarray) -> float:
    """Returns the largest change between successive (n, 3) vectors."""
    return float(np.linalg.norm(np.diff(values, axis=0), axis=1).max())


def _degrees(angle_rad: float) -> float:
    return float(np.rad2deg(angle_rad))


@dataclass(frozen=True)
class PenPass:
    """A pass of the pen: the curves of each library and the truth.

    Attributes:
        time_s: (n,) time of each tick, s.
        triangles: Number of triangles of the polyhedron that approximates the sphere.
        corner_deg: Largest angle between its neighboring faces, degrees.
        truth: Curves on a perfect sphere.
        curves: Curves by library; this package's under `OURS`.
        smoothness: Smoothness by library.
        exact: Smoothness of the exact depth of the two polyhedra.
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

    Its tip moves over the sphere in an arc, rising and falling through its surface,
    while the pen leans from side to side.
    """
    phase = np.linspace(0.0, 1.0, round(seconds * _RATE_HZ))
    X_WA = np.tile(np.eye(4), (len(phase), 1, 1))
    side_W = unit(np.array([0.2, 1.0, 0.1]))
    top_W = unit(np.cross(np.cross(side_W, [0.0, 0.0, 1.0]), side_W))
    for X, s in zip(X_WA, phase, strict=True):
        out_W = rotation(side_W, _ARC_RAD * (0.5 - s)) @ top_W
        off_m = _MIDDLE_M + _SWING_M * np.cos(4.0 * np.pi * s)
        lean = rotation(side_W, -_TILT_RAD * np.cos(2.0 * np.pi * s))
        lean = rotation(np.cross(side_W, out_W), -0.5 * _TILT_RAD) @ lean
        X[:3, 2] = lean @ out_W
        X[:3, 0] = lean @ np.cross(side_W, out_W)
        X[:3, 1] = np.cross(X[:3, 2], X[:3, 0])
        X[:3, 3] = (RADIUS_M + off_m) * out_W
    return X_WA


def measure_pen_pass(divisions: int = 3, seconds: float = _SECONDS) -> PenPass:
    """Follows the contact of the package's pen with a sphere along a pass.

    The sphere is an icosahedron with a number of subdivisions; 3 is the shipped one.
    """
    pen = load_shape("pen")
    ball = trimesh.creation.icosphere(divisions, RADIUS_M)
    sphere = Mesh.from_arrays(np.round(ball.vertices, 9), ball.faces)
    X_WA = plan_pen_pass(seconds)
    truth = calc_sphere_contact(pen.vertices, pen.triangles, X_WA, RADIUS_M)
    curves = {OURS: _follow(pen, sphere, X_WA)}
    if find_spec("coal") is not None:
        curves["coal"] = _follow_with_coal(pen, sphere, X_WA)
    return PenPass(
        time_s=np.arange(len(X_WA)) / _RATE_HZ,
        triangles=len(sphere.triangles),
        corner_deg=_degrees(ball.face_adjacency_angles.max()),
        truth=truth,
        curves=curves,
        smoothness={n: measure_smoothness(c, truth) for n, c in curves.items()},
        exact=measure_smoothness(_follow(pen, sphere, X_WA, "global"), truth),
    )


def _follow(
    pen: Mesh,
    sphere: Mesh,
    X_WA: np.ndarray,
    depth: Literal["tracked", "global"] = "tracked",
) -> ContactCurves:
    A, B = (ConvexPolytope(body.vertices) for body in (pen, sphere))
    found = ConvexPair(A, B, depth).query_trajectory(X_WA, np.eye(4))
    return ContactCurves(found.distance, found.nhat_BA_W, found.p_WC)


def _follow_with_coal(pen: Mesh, sphere: Mesh, X_WA: np.ndarray) -> ContactCurves:
    """Returns coal's answers to warm queries."""
    query = CoalQuery(pen.vertices, sphere.vertices, "CachedGuess")
    rows = []
    for X in X_WA:
        distance_m, found = query(X), query.result
        points = (found.getNearestPoint1() + found.getNearestPoint2()) / 2
        # coal's normal points from A to B.
        rows.append([distance_m, *-found.normal, *points])
    distance, normal, point = np.split(np.array(rows), [1, 4], axis=1)
    return ContactCurves(distance[:, 0], normal, point)
