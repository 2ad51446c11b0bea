"""Scenes for walks in contact: flat and in pieces, round, sharp, legged and tight."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import product

import numpy as np
from cell_mesh import cell_mesh
from contact_samples import box, hull, join_hulls, spike
from continuity_walk import Home, WalkScene
from press_rig import GAINS, sample_presses
from press_tools import MODELS, make_tool
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from slide_rig import make_slide_tools
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh

_DOWN = np.array([0.0, 0.0, -1.0])
_START_M = 4e-3


def _home(p_W: object, R: Rotation, push_W: object = _DOWN) -> Home:
    """Returns a home with the tool's origin `_START_M` away from a point."""
    push = np.asarray(push_W, float)
    X = np.eye(4)
    X[:3, :3] = R.as_matrix()
    X[:3, 3] = np.asarray(p_W, float) - _START_M * push
    return Home(X, push)


def _tilted(rng: np.random.Generator, tilt_rad: float) -> Rotation:
    """Returns any heading, tilted a little about any horizontal axis."""
    a = rng.uniform(0, 2 * np.pi)
    tilt = rng.uniform(0, tilt_rad) * np.array([np.cos(a), np.sin(a), 0])
    heading = Rotation.from_rotvec([0, 0, rng.uniform(0, 2 * np.pi)])
    return Rotation.from_rotvec(tilt) * heading


def _scene(
    name: str,
    tool: _core.ConvexPieces,
    solid: _core.ConvexPieces,
    gains: str,
    draw_home: Callable[[np.random.Generator], Home],
    turn_rad: float,
) -> WalkScene:
    points = tool.vertices[ConvexHull(tool.vertices).vertices]
    return WalkScene(
        f"{name}, {gains}", tool, points, solid, GAINS[gains], draw_home, turn_rad
    )


def _on_fifty_pieces(tool: str, tilt_rad: float, gains: str) -> WalkScene:
    """Returns a scene anywhere on the cut face, well inside its rim."""

    def draw_home(rng: np.random.Generator) -> Home:
        xy = rng.uniform([0.025, 0.02], [0.075, 0.03])
        return _home([*xy, TOP_M], _tilted(rng, tilt_rad))

    return _scene(
        f"{tool} on 50 pieces",
        make_slide_tools()[tool],
        fifty_pieces(),
        gains,
        draw_home,
        2 * tilt_rad,
    )


def _box_through_flush(gains: str) -> WalkScene:
    """A box that rocks through flush on a face of one piece."""

    def draw_home(rng: np.random.Generator) -> Home:
        return _home([*rng.uniform(-0.02, 0.02, 2), 0.0], _tilted(rng, 0.005))

    plate = box([0.1, 0.1, 0.02], [0, 0, -0.01])
    tool = make_slide_tools()["box"]
    return _scene("box through flush", tool, plate, gains, draw_home, 0.01)


def _prism_on_plane(gains: str) -> WalkScene:
    """A prism of 16 sides that rolls."""
    turn = 2 * np.pi * np.arange(16) / 16
    rim = 0.01 * np.stack([np.cos(turn), 0 * turn, np.sin(turn)], axis=1)
    y = np.array([0, 8e-3, 0])
    prism = hull(np.concatenate([rim - y, rim + y]))

    def draw_home(rng: np.random.Generator) -> Home:
        roll = Rotation.from_rotvec([0, rng.uniform(0, 2 * np.pi), 0])
        return _home([0, 0, 0.01], _tilted(rng, 0.02) * roll)

    plate = box([0.2, 0.2, 0.02], [0, 0, -0.01])
    return _scene("prism on plane", prism, plate, gains, draw_home, 0.4)


def _ball_over_edge(gains: str) -> WalkScene:
    """A ball on a convex right-angled edge."""
    block = box([0.04, 0.04, 0.04], [-0.02, 0, -0.02])

    def draw_home(rng: np.random.Generator) -> Home:
        push = np.array([-1, 0, -1]) / np.sqrt(2)
        p = [*rng.uniform(-1e-3, 1e-3, 1), rng.uniform(-0.01, 0.01), 0.0]
        return _home(p, Rotation.random(random_state=rng.integers(1 << 31)), push)

    ball = make_slide_tools()["ball"]
    return _scene("ball over edge", ball, block, gains, draw_home, 0.5)


def _legs_on_legs(gains: str) -> WalkScene:
    """Two plates on four legs each, one upside down below the other."""
    size = 4e-3
    top = set(product(range(7), range(4), (1,)))
    legs = set(product((0, 6), (0, 3), (0,)))
    upper = cell_mesh(top | legs, size)
    shift = np.array([3.5, 2.0, 0.0]) * size
    tool = Mesh.from_arrays(upper.vertices - shift, upper.triangles)
    turned = tool.vertices * [1, -1, -1]  # half a turn about x
    solid = Mesh.from_arrays(turned, tool.triangles)

    def draw_home(rng: np.random.Generator) -> Home:
        heading = Rotation.from_rotvec([0, 0, rng.uniform(-0.1, 0.1)])
        tilt = Rotation.from_rotvec([*rng.uniform(-5e-3, 5e-3, 2), 0])
        return _home([*rng.uniform(-1.5e-3, 1.5e-3, 2), 0], tilt * heading)

    return _scene(
        "legs on legs",
        decompose(tool, cache=False).core,
        decompose(solid, cache=False).core,
        gains,
        draw_home,
        0.02,
    )


def _peg_in_hole(gains: str) -> WalkScene:
    """A square peg in a square hole, 0.1 mm wider on each side."""
    cells = set(product(range(3), range(3), (0,))) - {(1, 1, 0)}
    block = cell_mesh(cells, 0.01)
    centered = Mesh.from_arrays(block.vertices - [0.015, 0.015, 0], block.triangles)
    peg = box([9.8e-3, 9.8e-3, 0.03], [0, 0, 0.015])

    def draw_home(rng: np.random.Generator) -> Home:
        return _home(
            [*rng.uniform(-5e-5, 5e-5, 2), rng.uniform(4e-3, 9e-3)], _tilted(rng, 2e-3)
        )

    solid = decompose(centered, cache=False).core
    return _scene("peg in hole", peg, solid, gains, draw_home, 0.01)


def _scattered(gains: str) -> WalkScene:
    """Tips in slabs of many directions, some alike: contacts that only ever glide."""
    rng = np.random.default_rng(0)
    slab = box([0.03, 0.03, 0.01], [0, 0, -0.005]).vertices
    slabs, tips = [], []
    for site in product(range(4), range(3)):
        at = 0.05 * np.array([*site, 0.0])
        turn = rng.choice([0.0, 0.01, 0.04, 0.5, 0.9])
        R = Rotation.from_rotvec(turn * np.array([np.cos(site[0]), np.sin(site[0]), 0]))
        slabs.append(hull(R.apply(slab) + at))
        for _ in range(rng.integers(1, 5)):
            xy = rng.uniform(-1, 1, 2) * rng.choice([3e-4, 8e-3])
            # Of the same depth, of nearly the same, or not.
            tip = [*xy, rng.choice([0.0, 2e-5, 3e-4]) * rng.normal()]
            tips.append(hull(R.apply(spike(tip).vertices) + at))

    def draw_home(rng: np.random.Generator) -> Home:
        small = Rotation.from_rotvec(rng.uniform(-1e-3, 1e-3, 3))
        return _home(rng.uniform(-1e-3, 1e-3, 3), small)

    return _scene(
        "scattered tips", join_hulls(*tips), join_hulls(*slabs), gains, draw_home, 2e-3
    )


def _shipped(tool: str, solid: str, gains: str) -> WalkScene:
    """A shipped tool on its object, pressed at random points of it."""
    mesh = load_mesh(MODELS / f"{solid}.obj", scale=1.0)
    held = make_tool(load_mesh(MODELS / f"{tool}.obj", scale=1.0), _PUSHES[tool])

    def draw_home(rng: np.random.Generator) -> Home:
        [press] = sample_presses(mesh, held, "press", [int(rng.integers(1 << 31))], 0)
        X = np.eye(4)
        X[:3, :3] = press.R_WT
        X[:3, 3] = press.q_WH(0.0, 0.0)[4:]
        return Home(X, press.push_W)

    core = decompose(mesh).core
    return _scene(f"{tool} on {solid}", held.core, core, gains, draw_home, 0.1)


_PUSHES = {
    "spoon": [[0, 0, -1], [-1, 0, -0.3]],
    "hammer": [[0, 1, 0], [1, 0, 0], [0, 0, -1]],
    "peg": [[0, 0, -1], [1, 0, 0]],
    "pen": [[0, 0, -1]],
}

_MAKERS: dict[str, Callable[[str], WalkScene]] = {
    "box": partial(_on_fifty_pieces, "box", 0.01),
    "edge": partial(_on_fifty_pieces, "edge", 0.01),
    "spike": partial(_on_fifty_pieces, "spike", 0.05),
    "ball": partial(_on_fifty_pieces, "ball", 0.2),
    "flush": _box_through_flush,
    "prism": _prism_on_plane,
    "convex-edge": _ball_over_edge,
    "legs": _legs_on_legs,
    "tips": _scattered,
    "peg-hole": _peg_in_hole,
    "spoon-cup": partial(_shipped, "spoon", "cup"),
    "peg-torus": partial(_shipped, "peg", "torus"),
    "hammer-block": partial(_shipped, "hammer", "block"),
    "pen-sphere": partial(_shipped, "pen", "sphere"),
}
_OF_SHIPPED_TOOLS = ("spoon-cup", "peg-torus", "hammer-block", "pen-sphere")
# Its hole is narrower than the default tolerance.
_TIGHT = "peg-hole"


def _list_scenes() -> Iterator[tuple[str, Callable[[], WalkScene]]]:
    """Yields keys and makers: with the default gains, then with softer ones."""
    for key, make in _MAKERS.items():
        if key != _TIGHT:
            yield key, partial(make, "default")
    for key, make in _MAKERS.items():
        gains = "soft" if key in _OF_SHIPPED_TOOLS else "sinking"
        yield f"{key}-{gains}", partial(make, gains)


SCENES = dict(_list_scenes())


@cache
def make_scene(key: str) -> WalkScene:
    """Returns the scene of a key of SCENES."""
    return SCENES[key]()
