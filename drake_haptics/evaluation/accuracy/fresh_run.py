"""Runs a scene in a process of its own, paced by the clock as for a device."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from drake_haptics.common.errors import UserError
from drake_haptics.evaluation.accuracy.tick_cost import time_ticks
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.scene_file import load_scene, write_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import RunError

# A lap that is longer is cut.
_LONGEST_S = 5.0


def measure_p99(scene: Scene) -> float:
    """Runs a scene anew and returns the 99th percentile of its ticks, µs.

    The process, its memory and its caches are new, as they are for whoever runs the
    scene. It runs one lap of the hand's path, at most 5 s of it.

    Raises:
        UserError: The scene cannot be built or diverges.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        write_scene(scene, file)
        done = subprocess.run(
            [sys.executable, "-m", __name__, str(file)],
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines()
        raise UserError(f"the scene does not run: {lines[-1] if lines else '?'}")
    return float(done.stdout)


def _main(file: str) -> None:
    """Prints the figure of a scene file."""
    scene = load_scene(file)
    lap_s = make_hand_path(scene.hand.path).duration_s
    try:
        times = time_ticks(scene, min(lap_s, _LONGEST_S))
    except (UserError, RunError) as error:
        sys.exit(str(error))
    print(repr(times.p99_us))


if __name__ == "__main__":
    _main(sys.argv[1])
