"""A study that goes on where it stopped: how stiff a peg in a hole can be rendered.

    python examples/peg_stability_study.py [FILE]

Each point of the map over stiffness and damping of the coupling is computed in a
process of its own choosing and kept in FILE. Interrupt it and start it again: what is
done is not done again. Pass `executor=distributed.Client(...).get_executor()` to
`z_width`, and the same study runs on a Dask cluster (docs/studies.md).
"""

import sys
from pathlib import Path
from tempfile import gettempdir

import numpy as np

from drake_haptics import find_scene, load_scene
from drake_haptics.analysis import CouplingGrowth, find_firmest_contact, z_width


def main(store: Path) -> None:
    """Computes the map and prints the largest stable stiffness of each damping."""
    scene = load_scene(find_scene("torus_peg"))
    time_s = find_firmest_contact(scene)
    print(f"The peg is pressed most at {time_s:.3f} s; results are kept in {store}")
    width = z_width(
        CouplingGrowth(scene, time_s),
        stiffness=np.linspace(2e3, 6e4, 8),
        damping=np.linspace(0.0, 6.0, 3),
        store=store,
        progress=lambda done, total: print(f"\r{done} of {total}", end=""),
    )
    print("\ndamping N·s/m   stable up to N/m")
    for damping, stiffness in zip(
        width.damping, width.largest_stable_stiffness(), strict=True
    ):
        print(f"{damping:13.1f} {stiffness:18.0f}")


if __name__ == "__main__":
    default = Path(gettempdir()) / "peg_stability_study.jsonl"
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else default)
