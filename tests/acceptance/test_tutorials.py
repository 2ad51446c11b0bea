"""Every tutorial runs from start to end, and shows what is kept in its file."""

import re
from pathlib import Path
from runpy import run_path

import nbformat
import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "docs" / "tutorials"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
EXECUTE = run_path(str(FOLDER.parent / "generate" / "execute_tutorials.py"))
AGAIN = "run docs/generate/execute_tutorials.py and look at what has changed"
NUMBER = re.compile(r"[-+]?\d[\d,]*\.?\d*(?:e[-+]?\d+)?")
COLOR = re.compile(r"\x1b\[[\d;]*m")
by_name = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path):
    return nbformat.read(path, as_version=4)


def read_code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def read_text(cell):
    """Returns all that a cell prints, without colors."""
    printed = [
        output.text if output.output_type == "stream" else output.data["text/plain"]
        for output in cell.outputs
        if output.output_type == "stream" or "image/png" not in output.data
    ]
    return COLOR.sub("", "\n".join(printed))


def read_kinds(cell):
    """Returns of what kinds the outputs of a cell are."""
    return [sorted(output.get("data", {output.output_type})) for output in cell.outputs]


def split_numbers(text):
    """Returns a text with a mark for each number, and the numbers."""
    numbers = [float(found.replace(",", "")) for found in NUMBER.findall(text)]
    return NUMBER.sub("#", text), numbers


@by_name
def test_tutorial_shows_what_is_kept(path):
    kept, run = read(path), read(path)
    EXECUTE["execute"](run)  # a cell whose claim does not hold raises
    pairs = zip(read_code_cells(kept), read_code_cells(run), strict=True)
    for number, (old, new) in enumerate(pairs):
        where = f"cell {number}: {AGAIN}"
        assert read_kinds(new) == read_kinds(old), where
        if "varies" in old.metadata.get("tags", []):
            continue
        old_words, old_numbers = split_numbers(read_text(old))
        new_words, new_numbers = split_numbers(read_text(new))
        assert new_words == old_words, where
        np.testing.assert_allclose(new_numbers, old_numbers, rtol=0.02, err_msg=where)


@by_name
def test_outputs_are_of_this_code(path):
    notebook = read(path)
    assert notebook.metadata["code_digest"] == EXECUTE["calc_code_digest"](notebook), (
        AGAIN
    )


@by_name
def test_tutorial_is_complete_and_small(path):
    notebook = read(path)
    cells = read_code_cells(notebook)
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    assert all(cell.source for cell in cells)
    # A cell that cannot fail teaches nothing.
    assert sum("assert " in cell.source for cell in cells) >= 5
    assert "## Try next" in notebook.cells[-1].source
    assert path.stat().st_size < 500_000
