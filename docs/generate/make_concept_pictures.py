"""Makes the pictures of docs/concepts.md.

python docs/generate/make_concept_pictures.py

Each is drawn from the package's own answers, not by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from drake_haptics import (
    BuildHapticDiagram,
    ConvexPair,
    ConvexPolytope,
    SceneTracker,
    decompose,
    find_scene,
    load_mesh,
    load_scene,
    run,
)
from drake_haptics._core import penalty_force, share_stiffness
from drake_haptics.common.colors import (
    ENVIRONMENT,
    FORCE_INK,
    NEAR_CONTACT,
    PENETRATING_CONTACT,
    TOOL,
    piece_color,
)
from drake_haptics.device.gate import LocalGate

_FOLDER = Path(__file__).parents[1]
_MESHES = _FOLDER.parent / "models" / "meshes"
_TOLERANCE_M, _STIFFNESS_N_PER_M = 2e-3, 2e4
_MAX_FORCE_N = 8.5
# Of the heights of the blade: 4.5 mm deep.
_SHOWN = 150


def _save(name: str, draw: Callable[[np.ndarray], None], panels: int = 2) -> None:
    """Draws into axes side by side and writes the picture."""
    figure, axes = plt.subplots(
        1, panels, figsize=(4.3 * panels, 3.3), layout="constrained", squeeze=False
    )
    draw(axes[0])
    figure.savefig(_FOLDER / f"concept_{name}.png", dpi=100)
    plt.close(figure)


def draw_pieces(axes: np.ndarray) -> None:
    """Draws the cup, cut by the plane y = 0: the mesh's outline and the hulls."""
    cup = decompose(load_mesh(_MESHES / "cup.obj"))
    for index, piece in enumerate(cup.pieces):
        for facet, original in zip(piece.facets, piece.facet_original, strict=True):
            segment = _cut(1e3 * piece.vertices[facet])
            if segment is None:
                continue
            color = piece_color(index)
            style = {"color": color, "lw": 2.5} if original else _VIRTUAL
            for ax in axes:
                ax.plot(*segment, **style, solid_capstyle="round")
    for ax, title in zip(axes, ("a cup, cut open", "a corner of it"), strict=True):
        ax.set_aspect("equal")
        ax.set_title(title)
        ax.set_xlabel("x, mm")
        ax.set_ylabel("z, mm")
    axes[1].set_xlim(14.0, 42.0)
    axes[1].set_ylim(-2.0, 18.0)
    axes[1].plot([], [], color=piece_color(0), lw=2.5, label="on the mesh")
    axes[1].plot([], [], **_VIRTUAL, label="virtual: never touched")
    axes[1].legend(loc="upper left", fontsize="small", frameon=False)


_VIRTUAL = {"color": "0.35", "lw": 0.9, "ls": (0, (2, 2))}


def _cut(polygon: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Returns where the plane y = 0 cuts a convex polygon (n, 3): x and z of two."""
    # Off the plane by so little that no vertex is in it.
    y = polygon[:, 1] - 1e-4
    following = np.roll(np.arange(len(y)), -1)
    crossing = np.flatnonzero(y * y[following] < 0.0)
    if len(crossing) != 2:
        return None
    share = y[crossing] / (y[crossing] - y[following[crossing]])
    ends = polygon[crossing]
    points = ends + share[:, None] * (polygon[following[crossing]] - ends)
    return points[:, 0], points[:, 2]


def draw_depth(axes: np.ndarray) -> None:
    """Draws a blade through a plate of 6 mm: both depths, and their ways out."""
    plate = ConvexPolytope(
        [[x, y, z] for x in (-40, 40) for y in (-40, 40) for z in (-6, 0)]
    )
    blade = ConvexPolytope(
        [[x, y, z] for x in (-5, 5) for y in (-5, 5) for z in (0, 1)]
    )
    heights = np.linspace(3.0, -7.0, 201)
    for depth, color in (("tracked", FORCE_INK), ("global", "0.3")):
        pair = ConvexPair(blade, plate, depth=depth)
        found = [pair.query(_lifted(height), np.eye(4)) for height in heights]
        axes[1].plot(
            -heights,
            [contact.distance for contact in found],
            color=color,
            lw=2.2 if depth == "tracked" else 1.4,
            ls="-" if depth == "tracked" else "--",
            label=f'depth="{depth}"',
        )
        _draw_way_out(axes[0], found[_SHOWN], color, depth)
    axes[0].fill_between([-20, 20], -6, 0, color=ENVIRONMENT, lw=0)
    height = heights[_SHOWN]
    axes[0].fill_between([-5, 5], height, height + 1, color=TOOL, lw=0)
    axes[0].set_xlim(-13, 13)
    axes[0].set_ylim(-9, 7)
    axes[0].set_aspect("equal")
    axes[0].set_title("two ways out of a thin plate")
    axes[1].axhline(0.0, color="0.8", lw=0.8, zorder=0)
    axes[1].set_xlabel("the blade below the surface, mm")
    axes[1].set_ylabel("signed distance, mm")
    axes[1].set_title("pushed through")
    axes[1].legend(fontsize="small", frameon=False)


def _lifted(height: float) -> np.ndarray:
    X_WA = np.eye(4)
    X_WA[2, 3] = height
    return X_WA


def _draw_way_out(ax: Axes, contact: object, color: object, name: str) -> None:
    """Draws the way that takes the tool out: by its depth along the normal."""
    way = -contact.distance * contact.nhat_BA_W
    side, middle = (-9.0, -4.0) if name == "tracked" else (9.0, -4.0)
    ax.annotate(
        "",
        xy=(side, middle + way[2]),
        xytext=(side, middle),
        arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2},
    )
    ax.text(side, 1.5, name, ha="center", color=color)


def draw_near(axes: np.ndarray) -> None:
    """Draws a pen coming down on a block: force over distance, and the tolerance."""
    pen = decompose(load_mesh(_MESHES / "pen.obj"))
    block = decompose(load_mesh(_MESHES / "block.obj"))
    scene = SceneTracker(pen, [block], tolerance=_TOLERANCE_M)
    top_m = block.mesh.vertices[:, 2].max()
    tip_m = pen.mesh.vertices[:, 2].min()
    distances, forces = [], []
    for distance in np.linspace(3e-3, -5e-4, 200):
        contacts = scene.query(_lifted(top_m - tip_m + distance))
        clusters = share_stiffness(contacts, _TOLERANCE_M)
        wrench = penalty_force(
            clusters,
            np.zeros(3),
            np.zeros(6),
            np.zeros((1, 3)),
            np.zeros((1, 6)),
            np.array([_STIFFNESS_N_PER_M]),
            np.zeros(1),
        )
        distances.append(1e3 * distance)
        forces.append(wrench.F_To_W[5])
    distances, forces = np.array(distances), np.array(forces)
    ax = axes[0]
    for part, color, label in (
        (distances >= 0, NEAR_CONTACT, "near"),
        (distances <= 0, PENETRATING_CONTACT, "penetrating"),
    ):
        ax.plot(distances[part], forces[part], color=color, lw=2.2, label=label)
    ax.axhline(_MAX_FORCE_N, color="0.6", lw=0.9, ls="--")
    ax.text(-0.5, 4.5, "largest force of the device", color="0.4", ha="right")
    ax.axvline(1e3 * _TOLERANCE_M, color="0.6", lw=0.9, ls=":")
    ax.text(1.95, 44, "contact.tolerance_m", color="0.4")
    ax.invert_xaxis()
    ax.set_xlabel("signed distance, mm")
    ax.set_ylabel("force on the tool, N")
    ax.legend(fontsize="small", frameon=False, loc=(0.05, 0.35))


def draw_clusters(axes: np.ndarray) -> None:
    """Draws the force of the spoon on the cup by shared stiffness and by the octree."""
    for clustering, size_m, color in (
        ("octree", 1e-3, PENETRATING_CONTACT),
        ("shared", None, FORCE_INK),
    ):
        scene = load_scene(find_scene("cup_spoon"))
        scene.contact.clustering = clustering
        scene.contact.cluster_size_m = size_m
        haptic = BuildHapticDiagram(scene)
        coupling = haptic.loop.virtual_coupling
        rows = []

        def note(root, coupling=coupling, rows=rows):
            context = coupling.GetMyContextFromRoot(root)
            force = coupling.GetOutputPort("F_Ho_W_commanded").Eval(context)[3:]
            rows.append((root.get_time(), np.linalg.norm(force)))

        run(haptic, 2.6, on_tick=note)
        time_s, force_N = np.array(rows).T
        shown = time_s > 1.0
        axes[0].plot(
            time_s[shown],
            force_N[shown],
            color=color,
            lw=1.1,
            label=f"clustering: {clustering}" + (", δ = 1 mm" if size_m else ""),
        )
    axes[0].set_xlabel("time, s")
    axes[0].set_ylabel("force on the hand, N")
    axes[0].legend(fontsize="small", frameon=False)


def draw_gate(axes: np.ndarray) -> None:
    """Draws a gate's force when enabled, asked for too much, and left alone."""
    gate = LocalGate(max_force_N=_MAX_FORCE_N, max_torque_Nm=0.2, ttl_s=0.05)
    X_BH, V_BH = np.array([1.0, 0, 0, 0, 0, 0, 0]), np.zeros(6)
    time_ms, asked, shown = np.arange(0, 800), [], []
    gate.release(0)
    for now in time_ms:
        force_N = 5.0 if now < 350 else 12.0
        if 50 <= now < 550:
            gate.show(np.array([0, 0, 0, 0, 0, force_N]), int(now * 1e6))
        asked.append(force_N if 50 <= now < 550 else np.nan)
        shown.append(gate.step(X_BH, V_BH, int(now * 1e6))[5])
    ax = axes[0]
    ax.plot(time_ms, asked, color="0.6", lw=1.2, ls="--", label="asked for")
    ax.plot(time_ms, shown, color=FORCE_INK, lw=2.2, label="shown")
    for at, words in (
        (-30, "enabled"),
        (190, "too much asked for"),
        (560, "host is gone"),
    ):
        ax.text(at, -1.1, words, fontsize="small", color="0.35")
    ax.set_ylim(-1.4, 13)
    ax.set_xlabel("time, ms")
    ax.set_ylabel("force, N")
    ax.legend(fontsize="small", frameon=False, loc="upper left")


def main() -> None:
    """Writes all pictures."""
    mpl.use("agg")
    plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False})
    _save("pieces", draw_pieces)
    _save("depth", draw_depth)
    _save("near", draw_near, panels=1)
    _save("clusters", draw_clusters, panels=1)
    _save("gate", draw_gate, panels=1)


if __name__ == "__main__":
    main()
