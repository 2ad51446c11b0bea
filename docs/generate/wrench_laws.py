"""The law of the force at contacts that are points: Eq. 1 to 10, one by one.

As in wrench_scenarios.py; k_v is the damping, v the speed of separation along n.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
from contact_samples import box, hull, join_hulls, spike
from wrench_chain import DAMPING_NS_PER_M, Body, Case, place, run_chain, wrench_at
from wrench_scenarios import (
    DISTANCES_M,
    OFFSET,
    RADIUS_M,
    K,
    T,
    X,
    Y,
    Z,
    make_floor,
    make_sphere,
    make_walls,
)

KV = DAMPING_NS_PER_M
AT_ZERO = np.zeros(6)
_PLATE = np.array([0.06, 0.04, 4e-3])
# The plate's frame is at a lower corner of it.
_PLATE_SHAPE = box(_PLATE, _PLATE / 2)


def _post(tip: object, **motion: object) -> Body:
    """A slender post that ends in a tip, upwards."""
    return place(spike([0, 0, 0]), tip, [np.pi, 0, 0], **motion)


def torque_about_a_corner(method: str) -> Iterator[Case]:
    """A plate held at a corner meets a post: τ = r × f."""
    expected, measured = [], []
    for r, d in product(([0.05, 0.03, 0], [0.01, 0.035, 0]), DISTANCES_M):
        p = np.array(r)
        tool = place(_PLATE_SHAPE, d * Z)
        expected.append(wrench_at(p, K * (T - d) * Z))
        measured.append(run_chain(tool, [_post(p)], method).tool)
    yield Case(
        "plate held at its corner, on a post",
        "τ = r × f, f = k (t − d) n",
        "9",
        method,
        np.array(expected),
        np.array(measured),
        float(np.linalg.norm(_PLATE)),
    )


def two_posts(method: str) -> Iterator[Case]:
    """A plate on two posts, level and tilted to either side."""
    middle = np.array([0.03, 0.02, 0])
    tips = [middle + s * 0.02 * X for s in (-1, 1)]
    shape = box(_PLATE, _PLATE[2] / 2 * Z)
    posts = [_post(tip) for tip in tips]
    d = -2e-4
    level = run_chain(place(shape, middle + d * Z), posts, method).tool
    yield Case(
        "plate on two posts, level",
        "f = 2 k (t − d) n, τ = 0 about the middle",
        "6, 9",
        method,
        wrench_at([0, 0, 0], 2 * K * (T - d) * Z),
        level,
        0.02,
    )
    expected, measured = [], []
    for tilt in (0.01, -0.01):
        n = np.array([np.sin(tilt), 0, np.cos(tilt)])
        tool = place(shape, middle + d * Z, [0, tilt, 0])
        measured.append(run_chain(tool, posts, method).tool)
        total = np.zeros(6)
        for tip in tips:
            from_plane = (tool.X_SB[:3, 3] - tip) @ n
            total += wrench_at(tip - tool.X_SB[:3, 3], K * (T - from_plane) * n)
        expected.append(total)
    yield Case(
        "plate on two posts, tilted",
        "Σ k (t − dᵢ) n at the tips",
        "6, 9",
        method,
        np.array(expected),
        np.array(measured),
        0.02,
    )
    yield Case(
        "plate on two posts, mirror images",
        "the wrench is mirrored",
        "6, 9",
        method,
        measured[0] * [1, -1, -1, -1, 1, 1],
        measured[1],
        0.02,
    )


def two_posts_of_one_object(method: str) -> Iterator[Case]:
    """A method merges two contacts with one object along one direction, or does not."""
    d, gap = -2e-4, 0.03
    posts = join_hulls(spike([0, 0, 0]), spike(gap * X))
    # Half a turn about y takes the second tip to −gap.
    solid = place(posts, [0, 0, 0], [0, np.pi, 0])
    tool = place(box(_PLATE, _PLATE[2] / 2 * Z), d * Z - gap / 2 * X)
    w = T - d
    if method == "octree":
        for name, delta, springs in (
            ("two posts of a solid, nearer than δ", 0.04, 1),
            ("two posts of a solid, farther than 2√3 δ", 2e-3, 2),
        ):
            yield Case(
                name,
                f"f = {'2 ' * (springs == 2)}k (t − d) n at the middle",
                "2, 4, 5",
                method,
                wrench_at([0, 0, 0], springs * K * w * Z),
                run_chain(tool, [solid], method, delta).tool,
                gap,
            )
    else:
        # k w = λ₁ + ½ λ₂ = ½ λ₁ + λ₂: the skin that they share is half of it.
        yield Case(
            "two posts of a solid",
            "f = 8/7 k (t − d) n at the middle",
            "6, 9",
            method,
            wrench_at([0, 0, 0], 8 / 7 * K * w * Z),
            run_chain(tool, [solid], method).tool,
            gap,
        )


def groove(method: str) -> Iterator[Case]:
    """Two tips on the two sides of a groove, as one cluster: Eq. 1, 3, 4 and 5."""
    if method != "octree":
        return
    normals = np.array([[0.6, 0, 0.8], [-0.6, 0, 0.8]])
    slopes = np.array([[-0.8, 0, 0.6], [0.8, 0, 0.6]])
    slab = np.array([[x, y, z] for x in (2, 40) for y in (-20, 20) for z in (-20, 0)])
    sides = [
        hull(1e-3 * slab @ np.array([slope, Y, n]))
        for slope, n in zip(slopes, normals, strict=True)
    ]
    d = np.array([-4e-4, 3e-4])
    feet = 0.012 * slopes
    tips = feet + d[:, None] * normals
    tool = place(join_hulls(*(spike(tip - OFFSET) for tip in tips)), OFFSET)
    w = T - d
    n = w @ normals
    p = w @ ((tips + feet) / 2) / w.sum()
    yield Case(
        "two tips in a groove, one cluster",
        "n ∝ Σ (t − dᵢ) nᵢ, p̂ = Σ (t − dᵢ) p̂ᵢ / Σ (t − dᵢ), d = min dᵢ",
        "1, 3, 4, 5, 6, 9",
        method,
        wrench_at(p - OFFSET, K * w.max() * n / np.linalg.norm(n)),
        run_chain(tool, [place(join_hulls(*sides))], method, 0.04).tool,
        0.012,
    )


def action_and_reaction(method: str) -> Iterator[Case]:
    """On objects that move, about any point: the tool and they feel opposite forces."""
    d = np.array([-3e-4, 4e-4, -1e-4])
    half = np.array([5e-3, 5e-3, 1.2e-2])
    rng = np.random.default_rng(0)
    tool = place(box(2 * half, -OFFSET), half + d + OFFSET, V_SB=rng.normal(size=6))
    walls = [
        place(
            hull(wall.shape.vertices - p),
            p,
            V_SB=rng.normal(size=6),
            stiffness_N_per_m=rng.uniform(1e3, 3e3),
            damping_Ns_per_m=rng.uniform(1, 5),
        )
        for wall, p in zip(make_walls(3), 0.1 * rng.normal(size=(3, 3)), strict=True)
    ]
    found = run_chain(tool, walls, method)
    about_S = [
        wrench_at(b.X_SB[:3, 3], F[3:]) + np.concatenate([F[:3], np.zeros(3)])
        for b, F in zip([tool, *walls], [found.tool, *found.objects], strict=True)
    ]
    yield Case(
        "peg and three walls, all moving",
        "F₂ = −F₁, and so the moments about any point",
        "7, 10",
        method,
        -about_S[0],
        np.sum(about_S[1:], axis=0),
        0.1,
    )


def materials(method: str) -> Iterator[Case]:
    """Two posts of different stiffness and damping, met at 50 mm/s."""
    tips, d, v = (np.zeros(3), 0.04 * X + 0.01 * Y), -2e-4, -0.05
    gains = ((1500.0, 2.0), (4000.0, 7.0))
    posts = [
        _post(tip, stiffness_N_per_m=k, damping_Ns_per_m=kv)
        for tip, (k, kv) in zip(tips, gains, strict=True)
    ]
    start = d * Z - 0.01 * (X + Y)
    tool = place(_PLATE_SHAPE, start, V_SB=[0, 0, 0, 0, 0, v])
    yield Case(
        "plate on a soft and a hard post",
        "Σ (kᵢ (t − d) − k_vᵢ v) n",
        "6, 9",
        method,
        sum(
            wrench_at(tip - start, (k * (T - d) - kv * v) * Z)
            for tip, (k, kv) in zip(tips, gains, strict=True)
        ),
        run_chain(tool, posts, method).tool,
        0.04,
    )


def damping(method: str) -> Iterator[Case]:
    """A sphere and a plate that both move: only approach along n is damped."""
    shape, d = hull(make_sphere() - OFFSET), -3e-4
    foot = -OFFSET - RADIUS_M * Z
    # Of tool and plate, [rad/s; m/s], and v = (v₁ − v₂)·n at the contact.
    spin = np.array([-30.0, 0, 0])
    motions = {
        "approaching": ([0, 0, 0, 0.3, 0.1, -0.2], AT_ZERO, -0.2),
        "leaving": ([0, 0, 0, 0.3, 0.1, 0.2], AT_ZERO, 0.2),
        "moving together": ([0, 0, 0, 0, 0, -0.2], [0, 0, 0, 0, 0, -0.2], 0.0),
        "met by the plate": (AT_ZERO, [0, 0, 0, 0, 0, 0.3], -0.3),
        "turning into it": ([*spin, 0, 0, 0], AT_ZERO, float(np.cross(spin, foot) @ Z)),
    }
    for name, (V_tool, V_plate, v) in motions.items():
        tool = place(shape, (d + RADIUS_M) * Z + OFFSET, V_SB=V_tool)
        floor = place(make_floor().shape, V_SB=V_plate)
        yield Case(
            f"sphere and plane, {name}",
            "f = (k (t − d) − k_v v) n" if v < 0 else "f = k (t − d) n",
            "6, 8",
            method,
            wrench_at(foot, (K * (T - d) - KV * min(0.0, v)) * Z),
            run_chain(tool, [floor], method).tool,
            RADIUS_M,
        )
