"""Tabulates what makes the energy that the penalty law's springs make.

python docs/generate/energy_table.py --points 4
python docs/generate/energy_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from law_runs import Penalty, Place, list_places, run_handle
from law_table import MADE_J, PAGE, POINTS
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from press_cells import SHIPPED
from press_rig import GAINS, PERIOD_S
from scipy.spatial.transform import Rotation
from wrench_chain import push

from drake_haptics import _core

SOURCES = (
    "contacts that begin, end or jump under load",
    "a force at the center of pressure, its depth at the nearest point",
    "shares and normals that change",
    "sampling at 1 kHz, and the damper",
)
# Poses at which the path of a tick is looked at.
PARTS = 8
# A distance changes by up to the motion of the tool's points, and by this, m.
ROUND_OFF_M = 1e-7
_GAINS = GAINS["default"]


class Springs:
    """The contacts of a tool at one pose, and the springs in them, at rest."""

    def __init__(self, tracker: _core.SceneTracker, q_WT: np.ndarray) -> None:
        self.p_WT = q_WT[4:]
        self.contacts = tracker.query(q_WT)
        clusters = _core.share_stiffness(self.contacts, _GAINS.tolerance_m)
        k = _GAINS.stiffness_N_per_m
        self.F_W = push(clusters, k, p_WTo=self.p_WT).wrench_model[:6]
        depth_m = _GAINS.tolerance_m - clusters.distance
        self.held_J = 0.5 * k * float(clusters.compression @ depth_m)
        # By the pair of pieces: place among the contacts, force.
        pieces = zip(self.contacts.piece_A, self.contacts.piece_B, strict=True)
        force_N = k * np.append(clusters.compression, 0.0)[clusters.label]
        self.pairs = {
            pair: (i, float(force_N[i])) for i, pair in enumerate(map(tuple, pieces))
        }

    def lever(self, i: int) -> np.ndarray:
        """Wrench (6,) of a unit force of contact i on the tool at To."""
        n, p = self.contacts.nhat_BA_W[i], self.contacts.p_WC[i] - self.p_WT
        return np.concatenate([np.cross(p, n), n])


def split_energy(place: Place, loop: Penalty) -> np.ndarray:
    """Returns the energy (4,) by SOURCES, J, while most was made.

    The springs are looked at along the very path of the tool, in steps so small that
    their work on it is exact but for what jumps. There contact j with force f, depth d
    and lever G makes f (G · motion + change of −d): nothing, where the force acts at
    the point whose depth is measured.
    """
    work_J = loop.calc_work()
    end = int(np.argmax(work_J - np.minimum.accumulate(work_J)))
    begin = int(np.argmin(work_J[: end + 1]))
    radius_m = float(np.linalg.norm(place.tool.mesh.vertices, axis=1).max())
    tracker = _core.SceneTracker(place.tool.core, [place.pieces], _GAINS.tolerance_m)
    for tick in loop.ticks[:begin]:
        tracker.query(tick.state[:7])
    made_J = np.zeros(len(SOURCES))
    last = Springs(tracker, loop.ticks[begin].state[:7])
    for tick, after in pairwise(loop.ticks[begin : end + 1]):
        motion = PERIOD_S / PARTS * after.state[7:]
        reach_m = np.linalg.norm(motion[3:]) + radius_m * np.linalg.norm(motion[:3])
        for part in range(1, PARTS + 1):
            now = Springs(tracker, displace(tick.state[:7], part * motion))
            step_J = 0.5 * (last.F_W + now.F_W) @ motion + now.held_J - last.held_J
            if has_jumped(last, now, 2 * reach_m + ROUND_OFF_M):
                made_J[0] += step_J
            else:
                lever_J = calc_lever_energy(last, now, motion)
                made_J[1] += lever_J
                made_J[2] += step_J - lever_J
            last = now
    made_J[3] = work_J[end] - work_J[begin] - made_J.sum()
    return made_J


def displace(q_WT: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Returns a pose (7,) moved by [rotation vector (rad); translation (m)]."""
    turn = Rotation.from_rotvec(motion[:3]) * Rotation.from_quat(np.roll(q_WT[:4], -1))
    return np.concatenate([np.roll(turn.as_quat(), 1), q_WT[4:] + motion[3:]])


def has_jumped(last: Springs, now: Springs, reach_m: float) -> bool:
    """Tells whether a distance changed by more than the tool's motion explains."""
    for one, other in ((last, now), (now, last)):
        for pair, (i, _) in one.pairs.items():
            there_m = _GAINS.tolerance_m
            if pair in other.pairs:
                there_m = other.contacts.distance[other.pairs[pair][0]]
            if abs(there_m - one.contacts.distance[i]) > reach_m:
                return True
    return False


def calc_lever_energy(last: Springs, now: Springs, motion: np.ndarray) -> float:
    """Returns what forces make by acting elsewhere than where depth is measured, J."""
    made_J = 0.0
    for pair in last.pairs.keys() & now.pairs.keys():
        (i, before_N), (j, after_N) = last.pairs[pair], now.pairs[pair]
        rise_m = 0.5 * (last.lever(i) + now.lever(j)) @ motion
        rise_m -= now.contacts.distance[j] - last.contacts.distance[i]
        made_J += 0.5 * (before_N + after_N) * rise_m
    return made_J


def measure(motion: str, points: int, solids: Sequence[str]) -> list[str]:
    """Returns the column of a motion: its runs, their energy, the shares by SOURCES."""
    made_J = []
    for place in list_places(motion, points, solids):
        loop = Penalty(place.tool, place.pieces, place.press.q_WH(0.0, 0.0))
        if run_handle(loop, place.press).made_J > MADE_J["penalty"]:
            made_J.append(split_energy(place, loop))
    total_J = np.sum(made_J, axis=0)
    shares = 100 * total_J / total_J.sum()
    return [
        str(len(made_J)),
        f"{1e3 * total_J.sum():.2f} mJ",
        *(f"{round(share)} %" for share in shares),
    ]


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--points", type=int, default=POINTS, help="on each solid")
    args = parser.parse_args()
    motions = ("press", "jab")
    columns = [measure(motion, args.points, SHIPPED) for motion in motions]
    limit = f"runs above {1e3 * MADE_J['penalty']:g} mJ"
    names = [limit, "energy made in them", *(f"of it by {s}" for s in SOURCES)]
    rows = [["", *motions], *map(list, zip(names, *columns, strict=True))]
    table = to_markdown(rows)
    show_parts(PAGE, {"energy": table}, __file__, args.write)


if __name__ == "__main__":
    main()
