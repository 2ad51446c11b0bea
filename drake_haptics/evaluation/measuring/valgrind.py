"""Counts the instructions of a part of a Python program.

Other programs do not disturb the count, and the rest of the program is not counted.
"""

from __future__ import annotations

import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from drake_haptics.common.errors import HapticsError
from drake_haptics.evaluation.measuring.timing import steady_memory


def require_valgrind() -> None:
    """Checks that instructions can be counted.

    Raises:
        HapticsError: valgrind is not installed.
    """
    if shutil.which("valgrind") is None:
        raise HapticsError(
            "instructions are counted with valgrind, which is not installed here:"
            " install it (apt-get install valgrind), or do without instructions"
        )


def count_instructions(arguments: Sequence[str]) -> int:
    """Runs Python with arguments and counts the instructions within `counted`.

    The count includes some 6e5 instructions for switching it on and off.

    Raises:
        subprocess.CalledProcessError: The program failed.
        RuntimeError: valgrind counted nothing.
    """
    said = run_callgrind(arguments, "/dev/null")
    found = re.search(r"Collected : (\d+)", said)
    if found is None:
        raise RuntimeError(f"valgrind counted nothing:\n{said}")
    return int(found[1])


def count_with_data(module: str, data: Any) -> int:
    """Counts a module that runs with data, which it reads by `read_data`.

    Raises:
        subprocess.CalledProcessError: The program failed.
        RuntimeError: valgrind counted nothing.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "data"
        file.write_bytes(pickle.dumps(data))
        return count_instructions(["-m", module, str(file)])


def read_data() -> Any:
    """Returns the data that `count_with_data` has passed to this program."""
    return pickle.loads(Path(sys.argv[1]).read_bytes())


def run_callgrind(arguments: Sequence[str], profile: str) -> str:
    """Runs Python under callgrind, which writes a profile, and returns its messages.

    Raises:
        subprocess.CalledProcessError: The program failed.
    """
    command = [
        *("valgrind", "--tool=callgrind", "--instr-atstart=no"),
        *(f"--callgrind-out-file={profile}", sys.executable, *arguments),
    ]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env=environment
    )
    return done.stderr


@contextmanager
def counted() -> Iterator[None]:
    """Counts its block, in a program under `count_instructions`.

    A collection of what the program made before is not counted: whether one falls into
    the block depends on all that was imported.
    """
    with steady_memory():
        _switch("on")
        yield
        _switch("off")


def _switch(state: str) -> None:
    """Switches the count of valgrind, under which this program runs."""
    command = ["callgrind_control", "-i", state, str(os.getpid())]
    subprocess.run(command, capture_output=True, check=True)
