"""Counts what the calls of the device protocol cost; prints the rows of its page.

Each is called some and some more times; the difference is what the calls cost. Needs
gcc and valgrind.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path

import drake_haptics

SOURCE = Path(__file__).with_name("protocol_cost.c")
FEW, MANY = 1000, 11_000


def build(folder: str) -> Path:
    """Compiles the program that makes the calls."""
    program = Path(folder) / "protocol_cost"
    include = f"-I{drake_haptics.get_include()}"
    subprocess.run(
        ["gcc", "-std=c99", "-O2", include, SOURCE, "-o", program, "-lm"], check=True
    )
    return program


def count(program: Path, call: str, times: int) -> int:
    """Returns the instructions of a run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    run = subprocess.run(
        [*command, program, call, str(times)],
        check=True,
        capture_output=True,
        text=True,
    )
    found = re.search(r"Collected : (\d+)", run.stderr)
    if found is None:
        raise RuntimeError(f"valgrind counted nothing:\n{run.stderr}")
    return int(found[1])


def main() -> None:
    """Prints the table's rows."""
    with tempfile.TemporaryDirectory() as folder:
        program = build(folder)
        cost = {
            call: (count(program, call, MANY) - count(program, call, FEW))
            / (MANY - FEW)
            for call in "pucrs"
        }
    cost["r"] -= cost["c"]
    names = {
        "p": "pack a state",
        "u": "unpack and check a state",
        "c": "pack a command",
        "r": "receive a command: check, judge, shorten to the limits",
        "s": "step the gate",
    }
    for call, name in names.items():
        print(f"| {name} | {cost[call]:,.0f} |")


if __name__ == "__main__":
    main()
