"""Winds the components of a mesh coherently, and solids outward."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.geometry.mesh.report import Findings, Severity
from drake_haptics.geometry.mesh.topology import (
    find_edges,
    orientation_flips,
    triangle_area_vectors,
    winding_numbers,
)

# Number of points of a nested component that must all be inside the other.
_NESTING_SAMPLES = 12


@dataclass(frozen=True)
class Winding:
    """A coherently wound mesh and the kinds of its components.

    Attributes:
        triangles: (m, 3) triangles with windings repaired.
        component: (m,) component of each triangle, in order of first triangle.
        orientable: (k,) whether the component has two sides.
        closed: (k,) whether every edge of the component is balanced: as many
            triangles run along it one way as the other, and at least two.
        cavity: (k,) whether the component is the wall of a hollow in another.
        volume: (k,) volumes, m³; signed, negative for cavities, meaningless unless
            closed.
        area: (k,) areas, m².
    """

    triangles: np.ndarray
    component: np.ndarray
    orientable: np.ndarray
    closed: np.ndarray
    cavity: np.ndarray
    volume: np.ndarray
    area: np.ndarray

    @property
    def solid(self) -> np.ndarray:
        """(k,) whether the component bounds a solid: closed, and encloses volume."""
        thick = np.abs(self.volume) > 1e-12 * self.area**1.5
        return self.closed & thick


def wind_components(
    vertices: np.ndarray, triangles: np.ndarray, findings: Findings
) -> Winding:
    """Splits a mesh into components, and winds each coherently and solids outward.

    Components are joined across edges with exactly two triangles. Within a component,
    triangles that disagree with the larger area are flipped. A closed component counts
    as a separate solid, even inside another (like a tooth's dentin in its enamel), so
    that it is flipped if it is wound inward. However, an inward one inside an outward
    one is the wall of a cavity and is kept. If the outermost component is wound inward,
    everything inside it is flipped with it.
    """
    m = len(triangles)
    component, flip, orientable = orientation_flips(m, find_edges(triangles))
    k = len(orientable)
    area_vectors = triangle_area_vectors(vertices, triangles)
    areas = np.linalg.norm(area_vectors, axis=1)
    turned_area = np.bincount(component, np.where(flip, areas, 0.0), minlength=k)
    area = np.bincount(component, areas, minlength=k)
    flip ^= (turned_area > area / 2)[component] & orientable[component]
    triangles = _turn_over(triangles, flip)
    closed = _balanced(triangles, component, k) & orientable
    volume = _volumes(vertices, triangles, component, k)
    inverted, cavity = _judge_nesting(vertices, triangles, component, closed, volume)
    triangles = _turn_over(triangles, inverted[component])
    volume = np.where(inverted, -volume, volume)
    _report(findings, component, flip, inverted, cavity)
    return Winding(triangles, component, orientable, closed, cavity, volume, area)


def _turn_over(triangles: np.ndarray, mask: np.ndarray) -> np.ndarray:
    return np.where(mask[:, None], triangles[:, [0, 2, 1]], triangles)


def _balanced(triangles: np.ndarray, component: np.ndarray, k: int) -> np.ndarray:
    """(k,) whether the component's triangles cancel at every edge of it."""
    own = triangles.astype(np.int64) + (component * (triangles.max() + 1))[:, None]
    edges = find_edges(own)
    net = np.bincount(edges.of_halfedge, np.where(edges.forward, 1.0, -1.0))
    balanced = np.ones(k, dtype=bool)
    halfedge_component = np.repeat(component, 3)
    balanced[halfedge_component[net[edges.of_halfedge] != 0]] = False
    return balanced


def _volumes(
    vertices: np.ndarray, triangles: np.ndarray, component: np.ndarray, k: int
) -> np.ndarray:
    """(k,) enclosed volumes, by the divergence theorem about a nearby point."""
    center = vertices.mean(axis=0)
    a, b, c = (vertices[triangles[:, i]] - center for i in range(3))
    signed = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return np.bincount(component, signed, minlength=k)


def _judge_nesting(
    vertices: np.ndarray,
    triangles: np.ndarray,
    component: np.ndarray,
    closed: np.ndarray,
    volume: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Decides which closed components to flip and which are cavities."""
    inverted = np.zeros(len(closed), dtype=bool)
    cavity = np.zeros(len(closed), dtype=bool)
    if not (closed & (volume < 0)).any():
        return inverted, cavity
    containers = _containers(vertices, triangles, component, closed, volume)
    sign = np.where(volume < 0, -1, 1)
    for c in sorted(containers, key=lambda c: len(containers[c])):
        outside = containers[c]
        root = next((d for d in outside if not containers[d]), c)
        final = sign[c] * sign[root]
        depth = sum(-1 if cavity[d] else 1 for d in outside)
        cavity[c] = final < 0 and depth >= 1
        inverted[c] = (sign[c] < 0) != cavity[c]
    return inverted, cavity


def _containers(
    vertices: np.ndarray,
    triangles: np.ndarray,
    component: np.ndarray,
    closed: np.ndarray,
    volume: np.ndarray,
) -> dict[int, list[int]]:
    """Returns the closed components around each closed component."""
    candidates = np.flatnonzero(closed)
    order = np.argsort(component, kind="stable")
    start = np.searchsorted(component[order], np.arange(len(closed) + 1))
    members = {c: order[start[c] : start[c + 1]] for c in map(int, candidates)}
    points = {c: vertices[np.unique(triangles[f])] for c, f in members.items()}
    low = np.array([points[c].min(axis=0) for c in members])
    high = np.array([points[c].max(axis=0) for c in members])
    size = np.abs(volume[candidates])
    containers: dict[int, list[int]] = {c: [] for c in members}
    for i, c in enumerate(members):
        boxed = (low <= low[i]).all(axis=1) & (high >= high[i]).all(axis=1)
        step = max(1, len(points[c]) // _NESTING_SAMPLES)
        for d in map(int, candidates[boxed & (size > size[i])]):
            w = winding_numbers(points[c][::step], vertices, triangles[members[d]])
            if (np.abs(w) > 0.5).all():
                containers[c].append(d)
    return containers


def _report(
    findings: Findings,
    component: np.ndarray,
    flip: np.ndarray,
    inverted: np.ndarray,
    cavity: np.ndarray,
) -> None:
    parts = len(np.unique(component[flip]))
    findings.add(
        "incoherent-winding",
        Severity.REPAIRED,
        int(flip.sum()),
        f"{count(int(flip.sum()), 'triangle')} in {count(parts, 'part')} "
        f"{_are(flip)} wound against the neighbors",
        "turned over, the larger area decides",
    )
    findings.add(
        "inverted-winding",
        Severity.REPAIRED,
        int(inverted.sum()),
        f"{count(int(inverted.sum()), 'closed part')} {_are(inverted)} wound inward",
        "turned outward",
    )
    findings.add(
        "cavities",
        Severity.NOTE,
        int(cavity.sum()),
        f"{count(int(cavity.sum()), 'closed part')} inside another {_are(cavity)}"
        " wound inward",
        "kept, as the walls of cavities",
    )


def _are(which: np.ndarray) -> str:
    return "is" if which.sum() == 1 else "are"
