"""Tabulates how the two laws of contact treat the same tools, solids and handles.

python docs/generate/law_table.py --points 4
python docs/generate/law_table.py --write
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from law_runs import (
    LAWS,
    RANGE_M,
    Constraint,
    Place,
    Run,
    list_hollow_places,
    list_places,
    run_handle,
)
from page_parts import make_parser, to_markdown
from page_stamp import show_parts
from peg_and_hole import peg_and_hole
from press_cells import SHIPPED
from press_rig import COUPLING, PERIOD_S
from press_verdict import find_lost_tick, is_through
from scipy.spatial.transform import Rotation
from solid_surface import Overlap, rotation_of

from drake_haptics import _core

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "contact-laws.md"
POINTS = 20
# Ticks for which a hand is held still, and of them the last that are looked at.
HELD, WATCHED = 2000, 400
# A tool at rest moves by less, m: 1 mN on the hand.
REST_M = 1e-6
BANDS_HZ = ((10.0, 80.0), (80.0, 400.0))
SLIDE_M_PER_S = 0.1
# While a hand turns from pressing to sliding its damper's force changes, ms.
TURNING = 20
LEAST_STEP_N = 0.1
# Ticks in a millisecond of rigid contact, with which slides are compared.
RIGID_TICKS = 8
# Energy that contact may make in a press or a jab, J.
MADE_J = {"penalty": 2e-4, "constraint": 5e-5}
# Play of a peg on each side, m, and the tolerance or skin over it of what is fitted.
PLAYS_M = (3e-3, 2e-3, 1e-3, 5e-4, 4e-4, 3e-4, 2e-4, 1e-4, 5e-5, 2e-5)
FITTED = 0.8
HEAD = ["", "wanted", "`penalty`", "`constraint`"]


def measure_rest(law: str, places: Sequence[Place]) -> np.ndarray:
    """Returns motion, m, and rms forces, N, in BANDS_HZ at rest, of places (n, 3)."""
    found = []
    for place in _with_progress(f"{law}: rests", places):
        loop = LAWS[law](place.tool, place.pieces, place.press.q_WH(0.0, 0.0))
        run = run_handle(loop, place.press, HELD)
        moved_m = np.ptp(run.q_WT[-WATCHED:, 4:], axis=0).max()
        forces = run.f_hand_W[-WATCHED:]
        tremors_N = [calc_tremor(forces, band) for band in BANDS_HZ]
        found.append([moved_m, *tremors_N])
    return np.array(found)


def calc_tremor(forces: np.ndarray, band_Hz: tuple[float, float]) -> float:
    """Returns the rms (N) of the part of forces (n, 3) in a band."""
    spectrum = np.fft.rfft(forces - forces.mean(axis=0), axis=0) / len(forces)
    hertz = np.fft.rfftfreq(len(forces), PERIOD_S)
    felt = spectrum[(band_Hz[0] <= hertz) & (hertz <= band_Hz[1])]
    return float(np.sqrt(2.0 * (np.abs(felt) ** 2).sum()))


@dataclass
class Faults:
    """Presses of one motion: how many met, and the faults in them."""

    met: int = 0
    lost: int = 0
    through: int = 0
    hooked: int = 0
    not_finite: int = 0
    made_J: list[float] = field(default_factory=list)


def measure_presses(
    law: str, motion: str, places: Sequence[Place]
) -> tuple[Faults, list[Run]]:
    """Returns the faults of presses, and the runs that met something."""
    faults, runs = Faults(), []
    for place in _with_progress(f"{law}: {motion}", places):
        press = place.press
        run = run_handle(
            LAWS[law](place.tool, place.pieces, press.q_WH(0.0, 0.0)), press
        )
        overlap = Overlap(place.tool.mesh, place.surface)
        lost = find_lost_tick(run.q_WT, run.F_contact_W, overlap) >= 0
        if not (lost or run.F_contact_W.any()):
            continue
        pressed = np.isin(run.phases, ("in", "slide", "hold"))
        probe = [rotation_of(q) @ press.p_TP + q[4:] for q in run.q_WT[pressed]]
        # All are back where there was room for them.
        gap_m = np.linalg.norm((run.q_WT[-1] - press.q_WH(0.0, 0.0))[4:])
        faults.met += 1
        faults.lost += lost
        faults.through += is_through(press, np.array(probe), place.surface, 0.0)
        faults.hooked += gap_m > 1e-3
        faults.not_finite += not np.isfinite(run.F_contact_W).all()
        faults.made_J.append(run.made_J)
        runs.append(run)
    return faults, runs


def measure_slides(law: str, places: Sequence[Place]) -> np.ndarray:
    """Returns the largest steps (n, 2) of slides that met something, N.

    Columns: under the law, and with rigid contact where the law begins to push.
    """
    found = []
    for place in _with_progress(f"{law}: slides", places):
        press = place.press
        start = place.tool, place.pieces, press.q_WH(0.0, 0.0)
        run = run_handle(LAWS[law](*start), press)
        if not run.F_contact_W.any():
            continue
        period_s = PERIOD_S / RIGID_TICKS
        rigid = Constraint(*start, RANGE_M[law], period_s)
        exact = run_handle(rigid, press, period_s=period_s)
        found.append([calc_step_N(run), calc_step_N(exact, RIGID_TICKS)])
    return np.array(found)


def calc_step_N(run: Run, ticks: int = 1) -> float:
    """Returns the largest change of a sliding hand's force in a millisecond, N.

    What the hand's own motion makes is taken off.

    Args:
        run: A slide.
        ticks: Its ticks in a millisecond.
    """
    forces = run.f_hand_W[run.phases == "slide"][TURNING * ticks :]
    own_N = COUPLING.stiffness_N_per_m * SLIDE_M_PER_S * PERIOD_S
    steps_N = np.linalg.norm(forces[ticks:] - forces[:-ticks], axis=1)
    return max(0.0, float(steps_N.max()) - own_N)


def insert_peg(
    law: str, play_m: float, range_m: float | None = None
) -> tuple[bool, float]:
    """Puts a peg into its hole, askew by 2° and half a millimeter beside.

    Args:
        law: One of LAWS.
        play_m: Play of the peg on each side, m.
        range_m: The law's tolerance or skin. Defaults to the law's own.

    Returns:
        Whether it goes in, and the least distance from the hole on the way, m.
    """
    tool, hole = peg_and_hole(play_m)
    tracker = _core.SceneTracker(tool.core, [hole], play_m)
    turn = Rotation.from_rotvec([np.deg2rad(2), 0, 0]).as_quat()
    start = np.concatenate([np.roll(turn, 1), [5e-4, 3e-4, 0.0225]])
    loop = LAWS[law](tool, hole, start, *([] if range_m is None else [range_m]))
    least_m = play_m
    for way_m in np.minimum(0.05 * PERIOD_S * np.arange(900), 20.5e-3):
        q_WT, _, _ = loop.tick(start - [0, 0, 0, 0, 0, 0, way_m])
        least_m = min(tracker.query(q_WT).distance, default=least_m)
    return bool(start[6] - q_WT[6] > 20.3e-3), float(least_m)


def find_least_play(law: str, fitted: bool) -> str:
    """Returns the least play of PLAYS_M down to which a peg goes in, in words."""
    words = "no play"
    deepest_m = 0.0
    for play_m in PLAYS_M:
        range_m = FITTED * play_m if fitted else None
        is_in, least_m = insert_peg(law, play_m, range_m)
        if not is_in:
            break
        deepest_m = max(deepest_m, -least_m)
        words = f"{1e3 * play_m:g} mm, {1e6 * deepest_m:.0f} µm deep"
    return words


def measure(law: str, points: int, solids: Sequence[str]) -> dict[str, str]:
    """Returns the figures of a law, by the name of the measurement."""
    cells: dict[str, str] = {}

    def places(motion: str, *, steady: bool = False) -> list[Place]:
        return list(list_places(motion, points, solids, steady=steady))

    tremors_N = np.zeros(len(BANDS_HZ))
    for where, pressed in (
        ("on shipped meshes", places("press", steady=True)),
        ("in a hollow", list(list_hollow_places())),
    ):
        found = measure_rest(law, pressed)
        restless = [
            f"{place.solid} by {1e6 * moved_m:.0f} µm"
            for place, moved_m in zip(pressed, found[:, 0], strict=True)
            if moved_m > REST_M
        ]
        cells[f"places without rest {where}"] = ", ".join(
            [f"{len(restless)} of {len(found)}", *restless]
        )
        tremors_N = np.maximum(tremors_N, found[:, 1:].max(axis=0))
    for (low_Hz, high_Hz), tremor_N in zip(BANDS_HZ, tremors_N, strict=True):
        band = f"{low_Hz:g} to {high_Hz:g} Hz"
        cells[f"hand held still, {band}: largest rms"] = f"{1e3 * tremor_N:.2f} mN"
    took_us: list[float] = []
    for motion in ("press", "jab"):
        faults, runs = measure_presses(law, motion, places(motion))
        took_us += [t for run in runs for t in run.time_us]
        counts = (faults.lost, faults.through, faults.hooked, faults.not_finite)
        cells[f"{motion}: lost, through, hooked, NaN"] = (
            f"{', '.join(map(str, counts))} of {faults.met}"
        )
        many = sum(made_J > MADE_J[law] for made_J in faults.made_J)
        cells[f"{motion}: most energy made"] = (
            f"{1e3 * max(faults.made_J):.3f} mJ, {many} of {faults.met} above "
            f"{1e3 * MADE_J[law]:g} mJ"
        )
    for where, chosen in (
        ("through a hollow", list(list_hollow_places(slide=True))),
        ("over shipped meshes", places("slide", steady=True)),
    ):
        steps_N, rigid_N = measure_slides(law, chosen).T
        for what, found_N in (
            ("largest step of the hand's force", steps_N),
            ("the same beyond that of rigid contact", steps_N - rigid_N),
        ):
            many = (found_N > LEAST_STEP_N).sum()
            cells[f"slide {where}: {what}"] = (
                f"{max(0.0, found_N.max()):.2f} N, {many} of {len(found_N)} above "
                f"{LEAST_STEP_N:g} N"
            )
    for name, fitted in (("the default range", False), ("a fitted range", True)):
        cells[f"peg with {name}: goes in down to"] = find_least_play(law, fitted)
    cells["median time of a tick (noisy)"] = f"{np.median(took_us):.0f} µs"
    return cells


# What is wanted of a law, by the beginning of what is measured.
WANTED = {
    "places": "0",
    "hand held": "5 mN",
    "press: lost": "0, 0, 0, 0",
    "jab: lost": "0, 0, 0, 0",
    "press: most": "0.2 mJ, `constraint` 0.05 mJ",
    "jab: most": "0.2 mJ, `constraint` 0.05 mJ",
    "slide through a hollow: the": "0.1 N",
    "slide over shipped meshes: the": "0.1 N",
    "peg with the default": "the range: 2 mm, 0.3 mm",
    "peg with a fitted": "0.02 mm",
}


def make_rows(by_law: Sequence[dict[str, str]]) -> list[list[str]]:
    """Returns the rows of the table, the head first."""
    rows = [HEAD]
    for name in by_law[0]:
        wanted = next((w for what, w in WANTED.items() if name.startswith(what)), "")
        rows.append([name, wanted, *(cells[name] for cells in by_law)])
    return rows


def _with_progress(title: str, places: Sequence[Place]) -> Iterator[Place]:
    for i, place in enumerate(places, 1):
        if sys.stderr.isatty() or i == len(places):
            print(f"{title}: {i} of {len(places)}", file=sys.stderr)
        yield place


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--points", type=int, default=POINTS, help="on each solid")
    args = parser.parse_args()
    by_law = [measure(law, args.points, SHIPPED) for law in LAWS]
    table = to_markdown(make_rows(by_law))
    show_parts(PAGE, {"laws": table}, __file__, args.write)


if __name__ == "__main__":
    main()
