"""Counts the instructions of a part of a Python program.

No other program disturbs such a count. What comes before and after the part is run but
not counted, so that importing and building do not blur it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from drake_haptics.errors import UserError


def require_valgrind() -> None:
    """Checks that instructions can be counted.

    Raises:
        UserError: valgrind is not installed.
    """
    if shutil.which("valgrind") is None:
        raise UserError(
            "instructions are counted with valgrind, which is not installed here:"
            " install it (apt-get install valgrind), or do without instructions"
        )


def count_instructions(arguments: Sequence[str]) -> int:
    """Runs this Python with these arguments and counts what `counted` encloses.

    Turning the count on and off is in it, some 6e5 instructions.

    Raises:
        subprocess.CalledProcessError: the program failed.
        RuntimeError: valgrind counted nothing.
    """
    command = [
        *("valgrind", "--tool=callgrind", "--instr-atstart=no"),
        *("--callgrind-out-file=/dev/null", sys.executable, *arguments),
    ]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env=environment
    )
    found = re.search(r"Collected : (\d+)", done.stderr)
    if found is None:
        raise RuntimeError(f"valgrind counted nothing:\n{done.stderr}")
    return int(found[1])


@contextmanager
def counted() -> Iterator[None]:
    """Counts its block, in a program under `count_instructions`."""
    _switch("on")
    yield
    _switch("off")


def _switch(state: str) -> None:
    """Tells the valgrind that this program runs under."""
    command = ["callgrind_control", "-i", state, str(os.getpid())]
    subprocess.run(command, capture_output=True, check=True)
