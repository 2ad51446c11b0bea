"""Tabulates errors of AutoDiff through contact against differences of fresh queries.

python docs/generate/gradient_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from autodiff_check import REACH, derivative_errors
from cell_mesh import cell_mesh
from contact_chain_diagram import ContactChain
from contact_samples import box, pose
from contact_state import METHODS, State, T, keeps_features, random_states
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from press_tools import MODELS
from touching_poses import touching_pose

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh

PAGE = Path(__file__).parents[2] / "docs" / "gradients.md"
STEP = 5e-7
TARGET = 1e-6
# One in so many states goes through Drake too, which takes longer.
DIAGRAM_EVERY = 4
_K = np.arange(36).reshape(6, 6)
# Parts of the wrench model that have one unit.
BLOCKS = {
    "F": [np.arange(3), np.arange(3, 6)],
    **{
        name: [start + _K[r : r + 3, c : c + 3].ravel() for r in (0, 3) for c in (0, 3)]
        for name, start in (("K", 6), ("B", 42))
    },
}


@dataclass(frozen=True)
class Pair:
    """A tool and the object that it touches.

    Attributes:
        name: Name of the pair.
        make: Function that makes the tool and the object.
        touch: Function that returns random poses of the tool.
        moves: Whether the object moves too.
    """

    name: str
    make: Callable[[], tuple[_core.ConvexPieces, _core.ConvexPieces]]
    touch: Callable[..., np.ndarray] = touching_pose
    moves: bool = False


@dataclass
class Row:
    """The measured states of one pair and one method.

    Attributes:
        pair: Name of the pair.
        method: Method of clustering.
        num_states: Number of random contact states.
        num_changing: Number of those whose features change within the differences'
            reach.
        num_unsettled: Number of those with a part whose differences depend on the step.
        errors: Errors of each part, one for each state that is left.
    """

    pair: str
    method: str
    num_states: int = 0
    num_changing: int = 0
    num_unsettled: int = 0
    errors: dict[str, list[float]] = field(
        default_factory=lambda: {name: [] for name in (*BLOCKS, "diagram")}
    )


def shipped(tool: str, solid: str) -> Callable[[], tuple]:
    """Returns a function that makes a pair of shipped meshes."""
    return lambda: tuple(
        decompose(load_mesh(MODELS / f"{name}.obj", scale=1.0)).core
        for name in (tool, solid)
    )


def box_and_cut_plate() -> tuple[_core.ConvexPieces, _core.ConvexPieces]:
    """Returns a box, and a plate whose top, z = 0, is cut into 50 pieces."""
    mesh = cell_mesh(product(range(10), range(5), (0,)), 0.01)
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sides = np.unique(np.round(normals * 1e4), axis=0, return_inverse=True)[1].ravel()
    cells = (corners.mean(axis=1)[:, :2] // 0.01) @ [10, 1]
    _, piece = np.unique(
        np.where(normals[:, 2] > 0, 1000 + cells, sides), return_inverse=True
    )
    plate = _core.assemble_surface_pieces(
        mesh.vertices - [0, 0, 0.01], mesh.triangles, piece.ravel().astype("i4")
    )
    return box([0.032, 0.024, 0.006], [0, 0, 0.003]), plate


def nearly_level(rng: np.random.Generator, *_: object) -> np.ndarray:
    """Returns a pose of the box tilted by 3° at most: faces lie nearly flush."""
    turn = Rotation.from_rotvec([*np.deg2rad(rng.uniform(-3, 3, 2)), rng.uniform(0, 7)])
    x, y, z, w = turn.as_quat()
    place = [rng.uniform(0.03, 0.07), rng.uniform(0.02, 0.03), rng.uniform(-T, T)]
    return pose(place, [w, x, y, z])


PAIRS = (
    Pair("cup_spoon", shipped("spoon", "cup")),
    Pair("torus_peg", shipped("peg", "torus")),
    Pair("hammer_block", shipped("hammer", "block")),
    Pair("sphere_pen", shipped("pen", "sphere")),
    Pair("box on a face in 50 pieces", box_and_cut_plate, nearly_level),
    Pair("cup_spoon, the cup moves too", shipped("spoon", "cup"), moves=True),
)


def make_states(pair: Pair, method: str, count: int) -> list[State]:
    """Returns random states of a pair, always the same."""
    tool, solid = pair.make()
    return random_states(
        tool, solid, method, count, num_objects=1, seed=5, touch=pair.touch
    )


def measure(pair: Pair, method: str, count: int) -> Row:
    """Measures random states of a pair."""
    row = Row(pair.name, method)
    for i, state in enumerate(make_states(pair, method, count)):
        row.num_states += 1
        if not keeps_features(state, REACH * STEP):
            row.num_changing += 1
            continue
        chains = [measure_core(state, pair.moves)]
        if i % DIAGRAM_EVERY == 0:
            chains.append(_of_drake(state, pair.moves))
        for names, errors in zip((BLOCKS, ("diagram",)), chains, strict=False):
            row.num_unsettled += len(errors) < len(names) and names is BLOCKS
            for name, error in errors.items():
                row.errors[name].append(error)
    return row


def measure_core(state: State, moves: bool) -> dict[str, float]:
    """Returns errors of the wrench model's parts, through the core alone."""
    x = state.x[: 26 if moves else 13]

    def evaluate(x: np.ndarray) -> np.ndarray:
        return state.at(np.r_[x, state.x[len(x) :]]).wrench().wrench_model

    answer = state.differentiate_wrench().wrench_model
    answer = _core.AutoDiffVector(answer.value, answer.gradient[:, : len(x)])
    return _largest(derivative_errors(evaluate, answer, x, STEP, _flat_blocks()))


def _of_drake(state: State, moves: bool) -> dict[str, float]:
    """Returns the largest errors through the systems, converted to AutoDiffXd."""
    chain = ContactChain(state, (moves,))
    x = chain.variables(state)
    errors = derivative_errors(
        lambda x: chain.evaluate(x, "wrench_model"),
        chain.differentiate(x, "wrench_model"),
        x,
        STEP,
        _flat_blocks(),
    )
    parts = _largest(errors)
    return {"diagram": max(parts.values())} if len(parts) == len(BLOCKS) else {}


def _flat_blocks() -> dict[tuple[str, int], np.ndarray]:
    return {(name, i): rows for name in BLOCKS for i, rows in enumerate(BLOCKS[name])}


def _largest(errors: dict[tuple[str, int], float]) -> dict[str, float]:
    """Returns the largest of each part that has figures in all units."""
    return {
        name: max(errors[name, i] for i in range(len(blocks)))
        for name, blocks in BLOCKS.items()
        if all((name, i) in errors for i in range(len(blocks)))
    }


TITLES = ("pair", *BLOCKS, "as a diagram")


def make_part(rows: Sequence[Row]) -> str:
    """Returns the page's table, and a sentence on the states.

    A line has the largest error of a pair under all methods of clustering.
    """
    lines = []
    for pair in dict.fromkeys(row.pair for row in rows):
        same = [row for row in rows if row.pair == pair]
        worst = (max(max(row.errors[x]) for row in same) for x in same[0].errors)
        lines.append([pair, *(f"{error:.0e}" for error in worst)])
    changing = max(row.num_changing / row.num_states for row in rows)
    unsettled = max(row.num_unsettled / row.num_states for row in rows)
    total = sum(row.num_states for row in rows)
    return (
        f"{to_markdown([TITLES, *lines])}\n"
        f"Of {total:,} states, {rows[0].num_states} for each pair and method of"
        " clustering, two kinds are left out: where a feature or a decision changes"
        f" within the reach of the differences, {100 * changing:.0f} % at most, and"
        " where differences of two orders disagree,"
        f" {100 * unsettled:.0f} % at most.\n"
    )


def rows(count: int) -> Iterator[Row]:
    """Measures all pairs."""
    for pair, method in product(PAIRS, METHODS):
        print(f"{pair.name}, {method} ...", file=sys.stderr)
        yield measure(pair, method, count)


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--states", type=int, default=300, help="of each pair")
    arguments = parser.parse_args()
    part = make_part(list(rows(arguments.states)))
    show_parts(PAGE, {"chain": part}, __file__, arguments.write)


if __name__ == "__main__":
    main()
