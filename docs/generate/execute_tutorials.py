"""Runs the tutorials from start to end and writes their outputs into them.

    python docs/generate/execute_tutorials.py [NOTEBOOK ...]

All of them where none is named. Needs nbclient and ipykernel, of `drake_haptics[test]`.
The notebooks are kept with their outputs, so that they can be read without running;
tests/acceptance/test_tutorials.py runs them again and compares.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).parents[1] / "tutorials"
_CELL_TIMEOUT_S = 180


def calc_code_digest(notebook: nbformat.NotebookNode) -> str:
    """Returns a digest of all code of a notebook."""
    code = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    return hashlib.sha256("\0".join(code).encode()).hexdigest()


def execute(notebook: nbformat.NotebookNode) -> None:
    """Runs all cells in a new kernel and puts their outputs into the notebook.

    The metadata has a digest of the code of these outputs, as `code_digest`.

    Raises:
        nbclient.exceptions.CellExecutionError: A cell raised.
    """
    client = NotebookClient(
        notebook,
        timeout=_CELL_TIMEOUT_S,
        kernel_name="python3",
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": str(FOLDER)}},
    )
    with tempfile.TemporaryDirectory() as folder:
        # Sockets in a private folder: no ports, and no other reader.
        manager = client.create_kernel_manager()
        manager.transport = "ipc"
        manager.connection_file = str(Path(folder) / "kernel.json")
        client.execute()
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [shown for shown in cell.outputs if not _is_of_fonts(shown)]
    notebook.metadata["code_digest"] = calc_code_digest(notebook)


def _is_of_fonts(output: nbformat.NotebookNode) -> bool:
    """Tells whether Graphviz complains of this machine's fonts."""
    is_stderr = output.output_type == "stream" and output.name == "stderr"
    return is_stderr and output.text.startswith("Fontconfig")


def main(paths: list[Path]) -> None:
    """Executes notebooks in place."""
    for path in paths or sorted(FOLDER.glob("*.ipynb")):
        print(f"{path.name} ...", flush=True)
        notebook = nbformat.read(path, as_version=4)
        execute(notebook)
        # Indented as Jupyter writes it, so that its own saves change nothing.
        nbformat.write(notebook, path)


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
