"""Makes all figures of the pages again: `python docs/generate/make_figures.py`.

Hours, on a machine that does nothing else: times are among the figures. It says what
comes next and how long that takes. Parts of names take some pages alone:

python docs/generate/make_figures.py wrenches stability
python docs/generate/make_figures.py --list

Commit before, and do not edit meanwhile: each page says at which commit it was made.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from mesh_samples import REAL_MESHES

ROOT = Path(__file__).parents[2]
_PROGRAMS = "docs/generate"
# What the command `drake-haptics` runs.
_BENCH = "from drake_haptics.cli import main; main()"
_BENCH_FIGURES = "build/bench.json"
# Real meshes, where they lie beside the repository: scenes of them are left out if not.
_MESHES = ("--meshes", str(REAL_MESHES)) if REAL_MESHES.is_dir() else ()


@dataclass(frozen=True)
class Figures:
    """The figures of a page.

    Attributes:
        page: The file, in the repository.
        commands: Arguments of this Python, run in the repository one after the other.
        minutes: Duration, some minutes on two cores.
        timed: Whether times are among the figures: nothing else may run.
    """

    page: str
    commands: tuple[tuple[str, ...], ...]
    minutes: float
    timed: bool = False

    @property
    def generator(self) -> str:
        """The program, in the repository."""
        return self.commands[-1][0]


def _table(
    page: str, name: str, minutes: float, *options: str, timed: bool = False
) -> Figures:
    command = (f"{_PROGRAMS}/{name}_table.py", "--write", *options)
    return Figures(f"docs/{page}.md", (command,), minutes, timed)


# In this order: the last ones quote those before.
FIGURES = (
    _table("stability-theory", "boundary", 1),
    _table("verification/wrenches", "wrench", 1),
    _table("verification/numerics", "hard_cases", 3),
    _table("verification/continuity", "sliding", 2),
    _table("verification/contact-laws", "law", 4),
    _table("verification/contact-laws", "energy", 2),
    _table("gradients", "gradient", 5),
    _table("gradients", "loop_gradient", 2),
    _table("device-twin", "twin", 5),
    _table("servo", "servo", 3),
    _table("stability", "stability", 3),
    _table("troubleshooting", "symptom", 1),
    _table("verification/continuity", "continuity", 30, "--jobs", "2"),
    _table(
        "verification/contact-laws", "press", 150, "--points", "1000", "--jobs", "2"
    ),
    _table("comparison", "thread", 3, timed=True),
    _table("geometry", "decomposition", 10, timed=True),
    _table("accuracy", "load", 1, timed=True),
    Figures(
        "docs/record-replay.md",
        ((f"{_PROGRAMS}/tick_log_costs.py", "--write"),),
        3,
        timed=True,
    ),
    Figures("docs/effects.md", ((f"{_PROGRAMS}/effect_costs.py", "--write"),), 15),
    _table("accuracy", "accuracy", 15, timed=True),
    _table("paper", "paper", 3, *_MESHES, timed=True),
    Figures(
        "docs/benchmarks.md",
        (
            ("-c", _BENCH, "bench", *_MESHES, "--json", _BENCH_FIGURES),
            (f"{_PROGRAMS}/write_docs.py", _BENCH_FIGURES),
        ),
        20,
        timed=True,
    ),
    # And the README's table, of loops from the same page.
    Figures(
        "docs/benchmarks.md",
        ((f"{_PROGRAMS}/readme_tables.py", "--write"),),
        2,
        timed=True,
    ),
    _table("verification/numerics", "numerics", 0),
)


def main() -> None:
    """Runs the programs one after the other; stops at the first that fails."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="parts of pages' names; all if none")
    parser.add_argument("--list", action="store_true", help="only say what would run")
    arguments = parser.parse_args()
    chosen = [
        figures
        for figures in FIGURES
        if not arguments.names or any(x in figures.page for x in arguments.names)
    ]
    left = sum(figures.minutes for figures in chosen)
    for number, figures in enumerate(chosen, 1):
        alone = ", and nothing else may run" if figures.timed else ""
        print(
            f"{number}/{len(chosen)} {figures.page}: some {figures.minutes:g} min of"
            f" {left:g} that are left{alone}",
            flush=True,
        )
        left -= figures.minutes
        start_s = time.monotonic()
        for command in figures.commands:
            print(f"  python {' '.join(command)}", flush=True)
            if arguments.list:
                continue
            if subprocess.run([sys.executable, *command], cwd=ROOT).returncode:
                sys.exit(f"{figures.page} was not made: the last command failed")
            print(f"  {(time.monotonic() - start_s) / 60:.1f} min", flush=True)


if __name__ == "__main__":
    main()
