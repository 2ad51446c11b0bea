"""Seams are not felt: the force of a slide is that of the surface, however it is cut.

The truth is that of planes and of the facets' own geometry. It is held at the level
of contacts; what clustering makes of them is measured by sliding_table.py.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from cell_mesh import cell_mesh
from press_rig import GAINS, Gains
from press_tools import MODELS
from scipy.spatial.transform import Rotation
from slide_rig import cut, feel, line, make_slide_tools, slide, velocity
from slide_scenes import (
    fifty_pieces,
    fifty_pieces_path,
    pitted_block,
    pitted_block_path,
)
from wrench_chain import METHODS

from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh

TOOLS = make_slide_tools()
UP = np.array([0.0, 0.0, 1.0])
T = GAINS["default"].tolerance_m
# A facet that was pressed on is held beyond its sides until the next one has taken
# over: there its plane is as much as this above the surface, m.
HELD = 1.5e-4
TURN = np.deg2rad(0.5)  # and its normal this much farther turned


@pytest.fixture(scope="module")
def plate():
    return fifty_pieces()


@pytest.fixture(scope="module")
def pitted():
    return pitted_block()


def assert_a_plane_is_felt(tool, solid, path, height, R_WT, n=UP, least=1):
    """Every contact has the plane's normal, the nearest its distance."""
    for contacts in slide(tool, solid, path, n, R_WT, T):
        assert len(contacts) >= least
        np.testing.assert_allclose(contacts.nhat_BA_W - n, 0, atol=1e-12)
        assert contacts.distance.min() == pytest.approx(height, abs=1e-12)


HEIGHTS = (1e-3, 0.0, -5e-4, -1.2e-3)


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("tool", TOOLS)
def test_a_face_cut_into_fifty_pieces_is_one_plane(plate, tool, height):
    path = fifty_pieces_path(height)
    turned = Rotation.from_rotvec([0, 0, 0.7]).as_matrix()
    assert_a_plane_is_felt(TOOLS[tool], plate, path, height, turned)


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("tool", ["box", "ball", "edge"])
def test_coplanar_pieces_of_a_decomposition_are_one_plane(pitted, tool, height):
    """Between rows of pits, a tool's lowest feature never over one of them."""
    path = pitted_block_path(height)
    assert_a_plane_is_felt(TOOLS[tool], pitted, path, height, np.eye(3))


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("method", METHODS)
def test_the_chain_feels_no_ripple(plate, tool, method):
    # The octree so coarse that all contacts are one cluster.
    gains = Gains(delta_m=0.04)
    for height in HEIGHTS:
        path = fifty_pieces_path(height)
        for contacts in slide(TOOLS[tool], plate, path, UP, np.eye(3), T):
            felt = feel(contacts, method, gains, velocity(path))
            expected = gains.stiffness_N_per_m * (T - height)
            assert felt.force_W[2] == pytest.approx(expected, rel=1e-5)
            assert np.abs(felt.force_W[:2]).max() < 1e-3 * expected


def lowest(tool, n):
    """How far the tool's origin is above the plane it rests on with normal n, m."""
    return -float((TOOLS[tool].vertices @ n).min())


@pytest.mark.parametrize("depth", [-1e-3, 5e-4])
@pytest.mark.parametrize("tool", ["box", "ball", "edge"])
def test_in_a_hollow_edge_floor_and_wall_are_felt_and_nothing_between(tool, depth):
    """Along the floor into the wall: normals of the two planes alone."""
    cells = {(i, j, k) for i, j, k in product(range(6), range(4), range(3)) if i < 1}
    cells |= set(product(range(6), range(4), (0,)))
    solid = decompose(cell_mesh(cells, 0.01), cache=False).core
    wall = np.array([1.0, 0.0, 0.0])
    floor_z, wall_x = 0.01 - depth, 0.01 + lowest(tool, wall)
    path = line([0.04, 0.022, floor_z], [wall_x - depth, 0.02, floor_z])
    met = False
    for p, contacts in zip(
        path, slide(TOOLS[tool], solid, path, UP, np.eye(3), T), strict=True
    ):
        of_floor = np.abs(contacts.nhat_BA_W - UP).max(axis=1) < 1e-12
        of_wall = np.abs(contacts.nhat_BA_W - wall).max(axis=1) < 1e-12
        assert (of_floor | of_wall).all()
        assert contacts.distance[of_floor].min() == pytest.approx(-depth, abs=1e-12)
        gap = p[0] - wall_x
        if gap < T:
            met = True
            assert contacts.distance[of_wall].min() == pytest.approx(gap, abs=1e-12)
        else:
            assert not of_wall.any()
    assert met


@pytest.mark.parametrize("tool", ["ball", "spike", "box"])
def test_a_thin_wall_is_felt_from_one_side_alone(tool):
    """A wall of 3 mm, the tool 1.2 mm inside: the far side is within the tolerance."""
    cells = product(range(20), range(10), (0,))
    solid = decompose(cell_mesh(cells, [4e-3, 4e-3, 3e-3]), cache=False).core
    height = -1.2e-3
    path = line([0.02, 0.015, 3e-3 + height], [0.06, 0.025, 3e-3 + height])
    assert_a_plane_is_felt(TOOLS[tool], solid, path, height, np.eye(3))


@pytest.fixture(scope="module")
def globe():
    return load_mesh(MODELS / "sphere.obj", scale=1.0)


@pytest.mark.parametrize("method", ["octree", "shared"])
def test_a_tessellated_ball_is_felt_as_far_as_its_facets_are_tilted(globe, method):
    """A tip at a constant distance from the center of 1,280 pieces of a sphere.

    Its facets' circles subtend an angle t: the surface is between R cos t and R, and
    its normals within t of the radius.
    """
    a, b, c = np.swapaxes(globe.vertices[globe.triangles], 0, 1)
    center = (globe.vertices.min(axis=0) + globe.vertices.max(axis=0)) / 2
    radius = np.linalg.norm(globe.vertices - center, axis=1).max()
    n = np.cross(b - a, c - a)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    planes = np.einsum("ij,ij->i", n, a - center)
    tilt, sagitta = np.arccos(planes.min() / radius), radius - planes.min()
    solid = cut(globe, np.arange(len(globe.triangles)))
    tip = TOOLS["spike"]
    turn = np.linspace(-0.4, 0.4, 800)
    for height in (1e-3, -1e-3):
        radial = np.stack([np.sin(turn), 0.3 * np.sin(2 * turn), np.cos(turn)], axis=1)
        radial /= np.linalg.norm(radial, axis=1, keepdims=True)
        path = center + (radius + height) * radial
        forces = []
        for u, contacts in zip(
            radial, slide(tip, solid, path, UP, np.eye(3), T), strict=True
        ):
            nearest = np.argmin(contacts.distance)
            assert contacts.nhat_BA_W[nearest] @ u > np.cos(tilt + TURN)
            # The distance from the polyhedron, by all its planes.
            truth = (n @ ((radius + height) * u) - planes).max()
            held = HELD if height < 0 else 1e-9
            assert truth - held < contacts.distance[nearest] < truth + sagitta / 20
            felt = feel(contacts, method, Gains(delta_m=0.04), np.zeros(3)).force_W
            forces.append(felt)
            assert felt @ u > np.cos(tilt + TURN) * np.linalg.norm(felt)
        forces = np.linalg.norm(forces, axis=1)
        explained = sagitta + held
        assert np.ptp(forces) < GAINS["default"].stiffness_N_per_m * explained
