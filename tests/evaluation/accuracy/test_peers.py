"""Other libraries agree with closed forms where there is one, and are told apart."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import trimesh

from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.evaluation.accuracy.peers.problem import (
    PeerAnswers,
    PeerProblem,
    make_peer_problem,
)
from drake_haptics.evaluation.accuracy.peers.run import (
    METHODS,
    PeerMethod,
    run_peer,
    run_peers,
)
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.truth import Truth
from drake_haptics.scene.schema import (
    ContactParameters,
    EnvironmentObject,
    FrictionParameters,
    GravityParameters,
    Scene,
    Tool,
    Waypoint,
)

_STIFFNESS = 2e3
# So small that libraries without a tolerance are held to the same law.
_TOLERANCE_M = 1e-6
_TICKS = 12
_DEEPEST_M = 4e-4
_TOP_M = 0.02  # of the block, above the world's origin


def _scene(folder: Path, tool: trimesh.Trimesh) -> Scene:
    tool.export(folder / "tool.obj")
    trimesh.creation.box([0.2, 0.2, 2 * _TOP_M]).export(folder / "block.obj")
    scene = Scene(
        tool=Tool(mesh=str(folder / "tool.obj"), scale=1.0),
        environment=[EnvironmentObject("block", str(folder / "block.obj"))],
        contact=ContactParameters(
            tolerance_m=_TOLERANCE_M, stiffness_N_per_m=_STIFFNESS, damping_Ns_per_m=0.0
        ),
    )
    scene.hand.path.waypoints = [Waypoint(0.0, [0.0, 0.0, 0.1])]
    return scene


def _problem(folder: Path, tool: trimesh.Trimesh) -> tuple[PeerProblem, np.ndarray]:
    """The tool going down into the block, and how deep its lowest point is (n,), m."""
    motion, depth = _lower(tool)
    haptic = build_without_scene_warnings(_scene(folder, tool))
    return make_peer_problem(haptic, motion, _truth(depth)), depth


def _lower(tool: trimesh.Trimesh) -> tuple[RecordedMotion, np.ndarray]:
    """The motion of `_problem`, and the depth."""
    depth = np.linspace(-1e-4, _DEEPEST_M, _TICKS)
    X_WT = np.zeros((_TICKS, 7))
    X_WT[:, 0] = 1.0
    # Not in the middle: ties between directions are no closed form.
    X_WT[:, 4:6] = 0.011, -0.007
    X_WT[:, 6] = _TOP_M - depth - tool.vertices[:, 2].min()
    rest = np.zeros((_TICKS, 6))
    return RecordedMotion(1e-3, X_WT, rest, X_WT, rest), depth


def _truth(depth: np.ndarray) -> Truth:
    """One spring, straight up."""
    wrench = np.zeros((len(depth), 6))
    wrench[:, 5] = _STIFFNESS * np.maximum(depth + _TOLERANCE_M, 0.0)
    distance = np.where(depth > -_TOLERANCE_M, -depth, np.inf)
    return Truth(wrench, np.zeros(3), distance, _TOLERANCE_M)


@pytest.fixture(scope="module")
def box(tmp_path_factory: pytest.TempPathFactory) -> tuple[PeerProblem, np.ndarray]:
    tool = trimesh.creation.box([0.02, 0.03, 0.04])
    return _problem(tmp_path_factory.mktemp("box"), tool)


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> tuple[PeerProblem, np.ndarray]:
    tool = trimesh.creation.icosphere(subdivisions=2, radius=0.02)
    return _problem(tmp_path_factory.mktemp("ball"), tool)


def _answer(method: PeerMethod, problem: PeerProblem) -> PeerAnswers:
    if find_spec(method.library.lower().replace("drake", "pydrake")) is None:
        pytest.skip(f"{method.library} is not installed")
    return method.load()(problem)


_IDS = [f"{m.library}-{m.function}" for m in METHODS]


@pytest.mark.parametrize("method", METHODS, ids=_IDS)
def test_a_box_on_a_box_is_one_spring(
    method: PeerMethod, box: tuple[PeerProblem, np.ndarray]
) -> None:
    problem, depth = box
    answers = _answer(method, problem)
    wanted = _truth(depth).F_Tcm_W[:, 3:]
    np.testing.assert_allclose(
        answers.F_To_W[:, 3:], wanted, rtol=0, atol=0.02 * wanted.max()
    )
    if np.isfinite(answers.distance).any():
        pressed = depth > 0.0
        np.testing.assert_allclose(
            answers.distance[pressed], -depth[pressed], rtol=0, atol=1e-6
        )


# A compliant ball is softer while little of it touches: no spring.
_SPRINGS = [m for m in METHODS if "hydroelastic" not in m.words]


@pytest.mark.parametrize("method", _SPRINGS, ids=lambda m: f"{m.library}-{m.function}")
def test_a_ball_on_a_plane_is_one_spring_at_its_lowest_corner(
    method: PeerMethod, ball: tuple[PeerProblem, np.ndarray]
) -> None:
    problem, depth = ball
    answers = _answer(method, problem)
    truth = _truth(depth)
    bound = 0.02 * truth.F_Tcm_W.max()
    np.testing.assert_allclose(answers.F_To_W, truth.F_Tcm_W, rtol=0, atol=bound)
    pressed = depth > 0.0
    np.testing.assert_allclose(
        answers.distance[pressed], -depth[pressed], rtol=0, atol=1e-6
    )


def test_the_modulus_makes_forces_like_the_references(
    box: tuple[PeerProblem, np.ndarray],
) -> None:
    problem, _ = box
    hull = next(m for m in METHODS if m.function == "answer_with_hull").load()
    once, twice = hull(problem), hull(replace(problem, f_W=2.0 * problem.f_W))
    np.testing.assert_allclose(twice.F_To_W, 2.0 * once.F_To_W, rtol=1e-12)
    with pytest.raises(ValueError, match="against the reference's"):
        hull(replace(problem, f_W=-problem.f_W))


def test_rows_have_figures_or_say_why_not(tmp_path: Path) -> None:
    tool = trimesh.creation.box([0.02, 0.03, 0.04])
    scene = _scene(tmp_path, tool)
    # An effect that no library has: the truth is found again without it.
    scene.effects.gravity = GravityParameters()
    scene.effects.friction = FrictionParameters()
    scene.environment[0].material.friction_coefficient = 0.5
    motion, depth = _lower(tool)
    seen: list[float] = []
    weighed = replace(_truth(depth), F_Tcm_W=np.ones((_TICKS, 6)))
    rows = run_peers(
        scene, motion, weighed, progress=lambda what, share: seen.append(share)
    )
    assert len(rows) == len(METHODS) == len(seen) - 1 and seen == sorted(seen)
    for row, method in zip(rows, METHODS, strict=True):
        assert row.library.startswith(method.library)
        assert row.method.startswith(method.words)
        assert (row.native is None) == (row.errors is None) == bool(row.failure_reason)
        if row.errors is not None:
            assert row.errors.force_max_N < 0.02 * _STIFFNESS * _DEEPEST_M
            assert np.isnan(row.errors.energy_created_J)


def test_what_fails_says_why(box: tuple[PeerProblem, np.ndarray]) -> None:
    problem, depth = box
    absent = PeerMethod("No-such-abacus", "with_abacus", "answer", "beads")
    row = run_peer(absent, problem, _truth(depth))
    assert row.library == "No-such-abacus" and row.native is row.errors is None
    assert row.failure_reason == "no-such-abacus is not installed"
    broken = replace(absent, library="NumPy")
    assert "with_abacus" in run_peer(broken, problem, _truth(depth)).failure_reason


def test_drake_has_one_stiffness_for_a_surface(
    box: tuple[PeerProblem, np.ndarray],
) -> None:
    problem, depth = box
    part = replace(problem.part, stiffness_N_per_m=np.array([1e3, 2e3]))
    on_pieces = next(m for m in METHODS if m.function == "answer_on_pieces")
    row = run_peer(on_pieces, replace(problem, part=part), _truth(depth))
    assert row.errors is None and "differ in stiffness" in row.failure_reason
