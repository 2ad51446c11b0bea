"""Counts the instructions of the contact query tick by tick, over a paper's scenario.

python tests/benchmarks/query_ticks.py [SCENARIO ...]

Needs valgrind and gcc; some minutes for each scenario. The poses are those of the tool
in the scenario's loop (drake_haptics/evaluation/paper/scenarios.py). Every tick is
queried, and every 29th is counted, so that all parts of the way are among them: the
core and its binding alone, not Python. What depth adds is the row of ticks in depth
beside that of ticks with contacts apart; how even the ticks are is p99 by p50.
"""

from __future__ import annotations

import ctypes
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from library_counts import count_core, read_profile

from drake_haptics import SceneTracker, _core

_EVERY = 29
_MARKS = Path(__file__).with_name("callgrind_marks.c")


def record(name: str, file: Path) -> None:
    """Writes shapes and poses of a scenario to an .npz file."""
    from drake_haptics.evaluation.paper.exploration import build_loop
    from drake_haptics.evaluation.paper.scenarios import scenario_makers
    from drake_haptics.simulation.run import run

    scenario = scenario_makers(None)[name]()
    haptic = build_loop(scenario, scenario.path.duration_s)
    tool = haptic.loop.haptic_tool
    port = tool.GetOutputPort("X_WT")
    X_WT: list[np.ndarray] = []
    run(
        haptic,
        scenario.path.duration_s,
        on_tick=lambda c: X_WT.append(port.Eval(tool.GetMyContextFromRoot(c)).copy()),
    )
    arrays = {
        "X_WT": np.array(X_WT),
        "tolerance_m": np.array(scenario.contact.tolerance_m),
    }
    shapes = [scenario.tool.core, *(o.decomposition for o in scenario.objects)]
    # Objects that are alike share one shape.
    distinct = {id(shape): shape for shape in shapes}
    numbers = {key: i for i, key in enumerate(distinct)}
    for key, shape in distinct.items():
        number = numbers[key]
        arrays[f"vertices_{number}"] = shape.vertices
        arrays[f"triangles_{number}"] = shape.triangles
        arrays[f"labels_{number}"] = shape.piece_of_triangle
    arrays["shapes"] = np.array([numbers[id(shape)] for shape in shapes])
    arrays["X_WO"] = np.array([_matrix(o.X_WO) for o in scenario.objects])
    np.savez(file, allow_pickle=False, **arrays)


def _matrix(X_WO: object) -> np.ndarray:
    """Returns a pose as (4, 4)."""
    as_matrix = getattr(X_WO, "GetAsMatrix4", None)
    return np.asarray(X_WO if as_matrix is None else as_matrix(), dtype=float)


def query_counted(file: Path, marks: Path) -> None:
    """Queries all poses; of those counted, callgrind writes a profile each."""
    data = np.load(file)
    shapes = {
        number: _core.assemble_surface_pieces(
            *(data[f"{part}_{number}"] for part in ("vertices", "triangles", "labels"))
        )
        for number in set(data["shapes"].tolist())
    }
    tool, *objects = (shapes[number] for number in data["shapes"].tolist())
    tracker = SceneTracker(tool, objects, float(data["tolerance_m"]))
    for i, X_WO in enumerate(data["X_WO"]):
        tracker.set_object_pose(i, X_WO)
    callgrind = ctypes.CDLL(str(marks))
    callgrind.start()
    for tick, X_WT in enumerate(data["X_WT"]):
        if tick % _EVERY:
            tracker.query(X_WT)
            continue
        callgrind.toggle()
        contacts = tracker.query(X_WT)
        callgrind.toggle()
        distance = contacts.distance
        kind = "none" if len(distance) == 0 else "deep" if min(distance) < 0 else "near"
        callgrind.dump(f"tick {tick} {kind}".encode())


def measure(file: Path, folder: Path) -> dict[str, list[int]]:
    """Returns instructions of the ticks counted, by what contacts they have."""
    marks = folder / "marks.so"
    subprocess.run(["gcc", "-shared", "-fPIC", _MARKS, "-o", marks], check=True)
    command = [
        *("valgrind", "--tool=callgrind", "--instr-atstart=no", "--collect-atstart=no"),
        *("--dump-line=no", f"--callgrind-out-file={folder / 'profile'}"),
        *(sys.executable, __file__, "--counted", str(file), str(marks)),
    ]
    subprocess.run(command, capture_output=True, check=True)
    found: dict[str, list[int]] = {"none": [], "near": [], "deep": []}
    for profile in folder.glob("profile.*"):
        text = profile.read_text(errors="replace")
        if named := re.search(r"Trigger: Client Request: tick \d+ (\w+)", text):
            found[named[1]].append(count_core(read_profile(profile)))
    return found


def main() -> None:
    """Prints a table for each scenario named, or for the spoon in the cup."""
    if sys.argv[1:2] == ["--counted"]:
        query_counted(Path(sys.argv[2]), Path(sys.argv[3]))
        return
    for name in sys.argv[1:] or ["spoon in cup"]:
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            record(name, folder / "poses.npz")
            found = measure(folder / "poses.npz", folder)
        found["all"] = [count for counts in found.values() for count in counts]
        print(f"| {name}: instructions per tick | ticks | p50 | p99 | max | p99/p50 |")
        print(f"| --- |{' --: |' * 5}")
        for kind, counts in found.items():
            if not counts:
                continue
            p50, p99 = np.percentile(counts, [50, 99])
            print(
                f"| {kind} | {len(counts)} | {p50:,.0f} | {p99:,.0f} |"
                f" {max(counts):,} | {p99 / p50:.1f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
