"""What the decomposition makes of many meshes: counts, truth, time and memory.

python docs/generate/decomposition_table.py --meshes cup organ
python docs/generate/decomposition_table.py --write
"""

from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from hull_truth import deepest_outside, deepest_surface, lost_share
from mesh_samples import REAL_MESHES
from page_parts import make_parser, to_markdown
from page_stamp import write_parts
from shapes import SHAPES
from shapes.organ import make_organ

from drake_haptics import Mesh, decompose, load_mesh
from drake_haptics.geometry.mesh.decimation import decimate

PAGE = Path(__file__).resolve().parents[2] / "docs" / "geometry.md"
# Table 1 of Kim, Otaduy, Lin and Manocha, for meshes of the same kind and size.
PAPER = {"torus": 67, "cup": 190, "spoon": 78, "hammer": 425, "organ": 9913}
PAPER |= {
    "torus_2000.obj": 67,
    "cup_500.obj": 190,
    "spoon_336.obj": 78,
    "hammer_1692.obj": 425,
    "armadillo_31240.stl": 9098,
    "digestive_24846.ply": 9913,
}
GENERATED = {**SHAPES, "organ": make_organ}
# Of a mesh: how few triangles at most, and how far its pieces may depart, m.
VARIANTS: dict[str, tuple[str, int | None, float | None]] = {
    "torus, merged 0.5 mm": ("torus", None, 5e-4),
    "torus, merged 1 mm": ("torus", None, 1e-3),
    "torus, 500 triangles": ("torus", 500, None),
    "cup, merged 1 mm": ("cup", None, 1e-3),
    "spoon, merged 1 mm": ("spoon", None, 1e-3),
    "hammer, merged 1 mm": ("hammer", None, 1e-3),
    "organ, merged 1 mm": ("organ", None, 1e-3),
    "organ, 5,000 triangles": ("organ", 5000, None),
    "organ, 5,000 triangles, merged 1 mm": ("organ", 5000, 1e-3),
}
REAL = (
    *list(PAPER)[5:],
    "power_drill.stl",
    "mug.stl",
    "magnifying_glass.stl",
    "gear_base.obj",
    "gear_small.npz",
    "gear_medium.npz",
    "peg_round_8mm.npz",
    "socket_round_8mm.npz",
    "tooth.ply",
    "dental_drill.obj",
    "fcl_env.obj",
    "fcl_rob.obj",
    "bunny_scan_raw.ply",
)
TITLES = (
    "mesh",
    "triangles",
    "pieces",
    "paper's",
    "flat",
    "virtual facets",
    "outside",
    "within",
    "reduced",
    "lost",
    "time",
    "peak memory",
)
# The page has these of meshes in exact pieces, and sums up the others.
SHOWN = ("mesh", "triangles", "pieces", "paper's", "virtual facets", "time")
# And these of what gives up some of the shape.
DEPARTURES = ("mesh", "triangles", "pieces", "outside", "within", "reduced", "time")
# Within this share of the mesh's size a triangle is on its facet.
ON_FACET = 1e-6


def find_mesh(name: str) -> Mesh | None:
    """Returns the mesh of that name, None if it is not beside the repository."""
    if name in GENERATED:
        surface = GENERATED[name]()
        return Mesh.from_arrays(surface.vertices, surface.triangles, name=name)
    path = REAL_MESHES / name
    return load_mesh(path) if path.exists() else None


def measure(name: str, points: int) -> dict[str, Any]:
    """Cuts a mesh; call it in a process of its own, whose peak memory it tells.

    Args:
        name: Name of the mesh.
        points: Number of points of its hulls that are checked.

    Returns:
        Counts and shares; lengths as shares of the mesh's size, its box's diagonal.
    """
    base, max_triangles, error_m = VARIANTS.get(name, (name, None, None))
    mesh = find_mesh(base)
    if mesh is None:
        raise SystemExit(f"no mesh {base}")
    if max_triangles is not None:
        mesh = decimate(mesh, max_triangles)
    start = time.perf_counter()
    if error_m is None:
        pieces = decompose(mesh, cache=False)
    else:
        pieces = decompose(mesh, "merged", error_m=error_m, cache=False)
    seconds = time.perf_counter() - start
    peak_mib = find_peak_mib()
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    report = pieces.report
    is_solid = bool(mesh.solid.all())
    return {
        "mesh": name,
        "triangles": report.triangles,
        "pieces": report.pieces,
        "flat": report.flat_pieces,
        "virtual": report.virtual_facets / report.facets,
        "outside": deepest_outside(pieces, points) / size if is_solid else None,
        "within": deepest_surface(pieces) / size if is_solid else None,
        "reduced": mesh.report.decimation_error_m / size,
        "lost": lost_share(pieces, ON_FACET * size) if error_m is None else None,
        "seconds": seconds,
        "peak_mib": peak_mib,
    }


def find_peak_mib() -> float:
    """Returns the most memory that this process has had, MiB.

    Linux also counts in `ru_maxrss` what the process that started this one had.
    """
    status = Path("/proc/self/status")
    if status.exists():
        (kib,) = re.findall(r"^VmHWM:\s+(\d+) kB$", status.read_text(), re.MULTILINE)
        return int(kib) / 2**10
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


def row(result: dict[str, Any]) -> list[str]:
    """Returns the cells of the table for a result of `measure`."""

    def share(value: float | None) -> str:
        if value is None:
            return "–"
        return "0" if value < 1e-12 else f"{value:.0e}"

    paper = PAPER.get(result["mesh"])
    return [
        result["mesh"],
        f"{result['triangles']:,}",
        f"{result['pieces']:,}",
        f"{paper:,}" if paper else "",
        f"{result['flat']:,}",
        f"{result['virtual']:.0%}",
        share(result["outside"]),
        share(result["within"]),
        share(result["reduced"]),
        share(result["lost"]),
        f"{result['seconds']:.2f} s",
        f"{result['peak_mib']:.0f} MiB",
    ]


def make_parts(rows: Sequence[Sequence[str]]) -> dict[str, str]:
    """Returns the page's two tables, and a sentence on what the first leaves out."""
    by_title = [dict(zip(TITLES, cells, strict=True)) for cells in rows]
    exact = [row for row in by_title if row["mesh"] not in VARIANTS]
    others = [row for row in by_title if row["mesh"] in VARIANTS]
    outside, within, lost = (
        max(_number(row[title]) for row in exact if row[title] != "–")
        for title in ("outside", "within", "lost")
    )
    peak = max(_number(row["peak memory"]) for row in by_title)
    told = (
        f"No hull leaves its solid by more than {outside:.0e} of the mesh's size, none"
        f" buries the surface by more than {within:.0e}, and no more than {lost:.0e} of"
        " the area lies on no facet of its piece. No cut took more than"
        f" {peak:.0f} MiB of memory, with the process that reads the mesh.\n"
    )
    return {
        "meshes": f"{_to_table(SHOWN, exact)}\n{told}",
        "departures": _to_table(DEPARTURES, others),
    }


def _to_table(titles: Sequence[str], rows: Sequence[dict[str, str]]) -> str:
    return to_markdown([titles, *([row[title] for title in titles] for row in rows)])


def _number(cell: str) -> float:
    return float(cell.replace(",", "").split()[0])


def main() -> None:
    """Measures each mesh in a process of its own and prints the table."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--meshes", nargs="*", default=[*GENERATED, *VARIANTS, *REAL])
    parser.add_argument("--measure", metavar="MESH", help="one mesh, in this process")
    parser.add_argument("--points", type=int, default=1000, help="of hulls, per mesh")
    args = parser.parse_args()
    if args.measure:
        print(json.dumps(measure(args.measure, args.points)))
        return
    rows = []
    print("  ".join(TITLES))
    for name in args.meshes:
        if name in REAL and not (REAL_MESHES / name).exists():
            print(f"{name} is not beside the repository: skipped", file=sys.stderr)
            continue
        command = [sys.executable, __file__, "--measure", name]
        command += ["--points", str(args.points)]
        answer = subprocess.run(command, check=True, capture_output=True, text=True)
        rows.append(row(json.loads(answer.stdout)))
        print("  ".join(rows[-1]), flush=True)
    if args.write:
        write_parts(PAGE, make_parts(rows), __file__)


if __name__ == "__main__":
    main()
