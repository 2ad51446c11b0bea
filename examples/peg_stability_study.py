"""A study that goes on where it stopped: how stiff a peg in a hole can be rendered.

    python examples/peg_stability_study.py [FILE]

The peg of `torus_peg`, made rigid and held with two fingers, leans on the hole. Each
point of the map over stiffness and damping of the coupling is computed in one of
several processes and kept in FILE. Interrupt it and start it again: what is done is
not done again. Pass `executor=distributed.Client(...).get_executor()` to
`calc_z_width`, and the same study runs on a Dask cluster (docs/stability.md).
"""

import argparse
from pathlib import Path

import numpy as np

from drake_haptics import find_scene, load_scene
from drake_haptics.analysis import (
    CouplingGrowth,
    StudyProgress,
    calc_z_width,
    hold_scene,
)


def main(store: Path) -> None:
    """Computes the map and prints the largest stable stiffness of each damping."""
    scene = load_scene(find_scene("torus_peg"))
    scene.contact.stiffness_N_per_m = 1e5
    scene.hand.grip = "light"
    time_s = hold_scene(scene).time_s
    print(f"The hand stops at {time_s:.3f} s. Results are kept in {store}")
    with StudyProgress("stiffness and damping") as progress:
        width = calc_z_width(
            CouplingGrowth(scene, time_s),
            stiffness=np.geomspace(2e3, 3.2e4, 9),
            damping=[0.0, 2.0, 4.0],
            store=store,
            progress=progress,
        )
    print("damping N·s/m   stable up to N/m")
    for damping, stiffness in zip(
        width.damping, width.largest_stable_stiffness(), strict=True
    ):
        print(f"{damping:13.1f} {stiffness:18.0f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="How stiff a peg can be rendered.")
    default = Path("peg_stability_study.jsonl")
    parser.add_argument("file", nargs="?", type=Path, default=default)
    try:
        main(parser.parse_args().file)
    except KeyboardInterrupt as stop:  # it says what is done
        raise SystemExit(str(stop)) from None
