"""Pressing with the device's largest force, or jabbing, never goes through a solid."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mesh_samples import box, real_mesh
from press_rig import (
    GAINS,
    LARGEST_FORCE_N,
    PERIOD_S,
    Gains,
    Press,
    run_press,
    sample_presses,
)
from press_tools import MODELS, make_tools
from press_verdict import Verdict, judge
from solid_surface import Overlap, Surface

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

SEED = 0
# Each meets seams, edges and both walls of thin shells.
TOOLS = ("spike", "ball", "box", "spoon")


@cache
def tools():
    return make_tools()


@cache
def solid(path: Path) -> tuple[Mesh, Surface, _core.ConvexPieces]:
    mesh = load_mesh(path, scale=1.0)
    return mesh, Surface(mesh), decompose(mesh).core


def verdicts(path: Path, tool: str, motion: str, gains: str, count: int):
    """Presses on a solid by point: those that met it."""
    mesh, surface, pieces = solid(path)
    presses = sample_presses(mesh, tools()[tool], motion, range(count), SEED)
    overlap = Overlap(tools()[tool].mesh, surface)
    found = {
        i: judge(press, tools()[tool], surface, pieces, GAINS[gains], overlap)
        for i, press in enumerate(presses)
    }
    return {i: v for i, v in found.items() if not v.skipped}


def assert_held(verdict: Verdict, gains: Gains, case: object) -> None:
    assert verdict.finite, case
    assert verdict.lost_tick < 0, case
    assert not verdict.through, case
    assert verdict.inward_tick < 0, case
    # Not deeper than the spring gives way under the largest force, with half as
    # much again for the blow.
    spring_m = LARGEST_FORCE_N / gains.stiffness_N_per_m - gains.tolerance_m
    assert verdict.depth_m < max(0.0, 1.5 * spring_m) + 5e-4, case


@pytest.mark.parametrize(
    ("name", "tool"),
    [
        *((name, tool) for name in ("cup", "spoon") for tool in TOOLS),
        *(("torus", "spike"), ("hammer", "box"), ("hammer", "ball"), ("pen", "spike")),
    ],
)
def test_presses_and_jabs_with_the_default_gains_hold(name: str, tool: str) -> None:
    met = 0
    for motion in ("press", "jab", "oblique", "slide"):
        for i, verdict in verdicts(
            MODELS / f"{name}.obj", tool, motion, "default", 2
        ).items():
            met += 1
            assert_held(verdict, GAINS["default"], (motion, i))
    assert met >= 4


@pytest.mark.parametrize(
    ("name", "tool"),
    [("cup", "spike"), ("cup", "box"), ("cup", "spoon"), ("torus", "ball")],
)
def test_a_press_that_sinks_in_holds(name: str, tool: str) -> None:
    met = 0
    for motion in ("press", "jab"):
        for i, verdict in verdicts(
            MODELS / f"{name}.obj", tool, motion, "sinking", 3
        ).items():
            met += 1
            assert_held(verdict, GAINS["sinking"], (motion, i))
            # It did sink, and the contact knows how far.
            assert verdict.shallow > 0.8, (motion, i)
    assert met >= 4


@pytest.mark.parametrize("name", ["cup_500.obj", "torus_2000.obj", "mug.stl"])
def test_presses_and_jabs_hold_on_real_meshes(name: str) -> None:
    for motion in ("press", "jab"):
        found = verdicts(real_mesh(name), "ball", motion, "default", 2)
        assert found
        for i, verdict in found.items():
            assert_held(verdict, GAINS["default"], (motion, i))


def block_press(tool: str, stop_m: float) -> Press:
    """Straight down onto the middle of a 40 mm cube's top, at 0.1 m/s."""
    return Press(
        p_W=np.array([0.02, 0.02, 0.04]),
        nhat_W=np.array([0.0, 0.0, 1.0]),
        push_W=np.array([0.0, 0.0, -1.0]),
        slide_W=np.zeros(3),
        R_WT=np.eye(3),
        p_TP=tools()[tool].probe(0),
        speed_m_per_s=0.1,
        stop_N=LARGEST_FORCE_N,
        stop_m=stop_m,
    )


def test_docs_numerics_tells_of_a_contact_that_chatters_at_rest() -> None:
    mesh, _, pieces = solid(MODELS / "cup.obj")
    [press] = sample_presses(mesh, tools()["box"], "press", [14], SEED)
    ticks = list(run_press(press, tools()["box"], pieces, GAINS["default"]))
    held = [t for t in ticks if t.phase == "hold"]
    counts = np.array([len(t.contacts) for t in held])
    forces = np.array([np.linalg.norm(t.F_contact_W[3:]) for t in held])
    hand_N = np.ptp([t.F_coupling_W[3:] for t in held], axis=0).max()
    page = (
        Path(__file__).parents[2] / "docs" / "verification" / "numerics.md"
    ).read_text("utf-8")
    text = " ".join(page.split())
    assert f"between {counts.min()} and {counts.max()} contacts" in text
    assert f"on {np.count_nonzero(np.diff(counts))} of {len(held)} ticks" in text
    assert f"between {forces.min():.1f} and {forces.max():.1f} N" in text
    assert f"leave {hand_N:.2f} N" in text


@pytest.mark.parametrize("gains", GAINS)
def test_a_spike_on_a_cube_rests_where_the_spring_says(gains: str) -> None:
    mesh = Mesh.from_arrays(*box((0.04, 0.04, 0.04)))
    pieces = decompose(mesh, cache=False).core
    press = block_press("spike", 40e-3)
    ticks = list(run_press(press, tools()["spike"], pieces, GAINS[gains]))
    last = [t for t in ticks if t.phase == "hold"][-1]
    force = -last.F_coupling_W[5]
    assert force == pytest.approx(LARGEST_FORCE_N, rel=0.05)
    assert last.F_contact_W[5] == pytest.approx(force, rel=1e-3)
    g = GAINS[gains]
    assert last.contacts.distance.min() == pytest.approx(
        g.tolerance_m - force / g.stiffness_N_per_m, abs=2e-6
    )
    # The script's own promises: 0.2 s at rest, and out again, free.
    assert sum(t.phase == "hold" for t in ticks) * PERIOD_S == pytest.approx(0.2)
    assert ticks[-1].phase == "away"
    assert len(ticks[-1].contacts) == 0


@pytest.mark.parametrize("tool", ["spike", "ball"])
def test_the_judge_sees_a_tool_that_falls_through(tool: str) -> None:
    """A 10 mm plate whose pieces lack the faces that the tool meets."""
    V, F = box((0.04, 0.04, 0.01), at=(0.0, 0.0, 0.03))
    mesh = Mesh.from_arrays(V, F)
    surface = Surface(mesh)
    sides = mesh.triangles[np.abs(surface.normals[:, 2]) < 0.5]
    pieces = _core.assemble_surface_pieces(
        mesh.vertices, sides, np.arange(len(sides), dtype=np.int32)
    )
    overlap = Overlap(tools()[tool].mesh, surface)
    verdict = judge(
        block_press(tool, 40e-3),
        tools()[tool],
        surface,
        pieces,
        GAINS["default"],
        overlap,
    )
    assert verdict.lost_tick > 0
    whole = decompose(mesh, cache=False).core
    verdict = judge(
        block_press(tool, 40e-3),
        tools()[tool],
        surface,
        whole,
        GAINS["default"],
        overlap,
    )
    assert verdict.lost_tick < 0
    assert not verdict.through


def test_the_judges_geometry_is_that_of_a_box() -> None:
    surface = Surface(Mesh.from_arrays(*box((1.0, 2.0, 3.0))))
    points = np.array([[0.5, 1.0, 2.9], [0.5, 1.0, 3.1], [0.2, 1.0, 1.0]])
    np.testing.assert_array_equal(surface.holds(points), [True, False, True])
    nearest = [surface.distances(p).min() for p in points]
    np.testing.assert_allclose(nearest, [0.1, 0.1, 0.2], atol=1e-12)
    assert surface.distances(np.array([2.0, 3.0, 4.0])).min() == pytest.approx(3**0.5)
    assert surface.inner_depth(points) == pytest.approx(0.2)
    assert surface.facing(points[0], np.array([0, 0, 1.0])) == pytest.approx(1.0)
    assert surface.facing(points[0], np.array([0, 0, -1.0])) == pytest.approx(-1.0)
    straight = np.linspace([0.4, 1.0, 3.5], [0.4, 1.0, -0.5], 42)
    assert surface.is_pierced(straight)
    assert not surface.is_pierced(straight[:30])
    around = np.array([[0.1, 1.0, 3.1], [0.1, 1.0, 2.95], [-0.1, 1.0, 2.9]])
    assert not surface.is_pierced(around)
