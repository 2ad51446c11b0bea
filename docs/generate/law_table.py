"""Tabulates what a peg with 0.1 mm of play does under each law of contact.

python docs/generate/law_table.py --write
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
import warnings
from pathlib import Path

import numpy as np
from boundary_table import to_markdown
from page_stamp import write_page
from pydrake.systems.framework import Context

from drake_haptics import BuildHapticDiagram, find_scene, load_scene, run
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.settings import change_scene
from drake_haptics.scene.validation import SceneWarning

PAGE = Path(__file__).parents[2] / "docs" / "concepts.md"
BEGIN = "<!-- laws: written by docs/generate/law_table.py -->\n"
END = "<!-- end of laws -->\n"
HEAD = [
    "law",
    "goes in, of 30 mm",
    "nearest, mm",
    "largest change of force in a tick, N",
    "tremor of a hand held still, mN",
    "energy made by contact, µJ",
]
LAWS = {
    "`penalty`, the default gains": ["contact.law=penalty"],
    "`penalty`, 100 kN/m from 0.08 mm on": [
        "contact.law=penalty",
        "contact.tolerance_m=8e-5",
        "contact.stiffness_N_per_m=1e5",
    ],
    "`constraint`, a skin of 0.08 mm": [],
}
_SCENE = "peg_in_hole"
# The hole's mouth, m, and when the peg is on its floor and when above the socket, s.
_MOUTH_M, _DOWN_S, _UP_S = 0.035, 1.6, 3.9
_HELD_S, _LISTENED_TICKS = 1.0, 400
# What a hand feels as a tremor, Hz.
_BAND_HZ = (80.0, 400.0)


def run_noting(scene: Scene, duration_s: float) -> tuple[np.ndarray, np.ndarray, dict]:
    """Returns heights (n,), m, forces (n, 3), N, and figures of a run."""
    haptic = BuildHapticDiagram(scene)
    pose, wrench = (
        haptic.diagram.GetOutputPort(name) for name in ("X_WT", "F_Ho_W_commanded")
    )
    heights, forces = [], []

    def note(context: Context) -> None:
        heights.append(float(pose.Eval(context)[6]))
        forces.append(np.array(wrench.Eval(context)[3:]))

    statistics = run(haptic, duration_s, energy=True, on_tick=note)
    return np.array(heights), np.array(forces), dict(statistics.to_dict())


def hold_down(scene: Scene) -> Scene:
    """Returns the scene with a hand that stops where the peg is on the floor."""
    waypoints = [w for w in scene.hand.path.waypoints if w.time_s <= _DOWN_S]
    path = dataclasses.replace(scene.hand.path, periodic=False, waypoints=waypoints)
    return dataclasses.replace(scene, hand=dataclasses.replace(scene.hand, path=path))


def calc_tremor(forces: np.ndarray, period_s: float) -> float:
    """Returns the rms (N) of what of forces (n, 3) is in the band of a tremor."""
    spectrum = np.fft.rfft(forces - forces.mean(axis=0), axis=0) / len(forces)
    hertz = np.fft.rfftfreq(len(forces), period_s)
    felt = spectrum[(_BAND_HZ[0] <= hertz) & (hertz <= _BAND_HZ[1])]
    return float(np.sqrt(2.0 * (np.abs(felt) ** 2).sum()))


def make_row(label: str, settings: list[str]) -> list[str]:
    """Returns the cells of a law."""
    scene = change_scene(load_scene(find_scene(_SCENE)), settings)
    heights, forces, figures = run_noting(scene, _UP_S)
    _, held, _ = run_noting(hold_down(scene), _DOWN_S + _HELD_S)
    tremor_N = calc_tremor(held[-_LISTENED_TICKS:], 1.0 / scene.device.rate_hz)
    depth_m = max(0.0, _MOUTH_M - heights.min())
    steps_N = np.linalg.norm(np.diff(forces, axis=0), axis=1)
    return [
        label,
        f"{1e3 * depth_m:.1f} mm" if depth_m > 0.0 else "does not",
        f"{1e3 * figures['least_distance_m']:.3f}",
        f"{steps_N.max():.2f}",
        f"{1e3 * tremor_N:.2f}",
        f"{1e6 * figures['energy_J']['contact']['beyond']:.0f}",
    ]


def main() -> int:
    """Prints the table, or writes it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="into the page")
    write = parser.parse_args().write
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        rows = [make_row(label, settings) for label, settings in LAWS.items()]
    table = to_markdown(iter([HEAD, *rows]))
    if not write:
        print(table)
        return 0
    page = PAGE.read_text(encoding="utf-8")
    start, end = page.index(BEGIN) + len(BEGIN), page.index(END)
    write_page(PAGE, f"{page[:start]}\n{table}\n{page[end:]}", __file__)
    return 0


if __name__ == "__main__":
    sys.exit(main())
