"""Rows of the page on sliding, slid again, are those of the page."""

from __future__ import annotations

import pytest
from slide_scenes import (
    fifty_pieces,
    fifty_pieces_path,
    pitted_block,
    pitted_block_path,
)
from sliding_table import HEIGHTS_M, PAGE, TITLES, row

FACES = {
    "50 pieces": (fifty_pieces, fifty_pieces_path),
    "pitted block": (pitted_block, pitted_block_path),
}


def read_rows() -> list[dict[str, str]]:
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    cells = [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")]
    assert cells[0] == TITLES
    return [dict(zip(TITLES, texts, strict=True)) for texts in cells[1:]]


def number(text: str) -> float:
    return float(text.split()[0])


@pytest.mark.parametrize(
    ("face", "tool", "height_m"),
    [
        ("50 pieces", "wide box", HEIGHTS_M[2]),
        ("50 pieces", "edge", HEIGHTS_M[1]),
        ("pitted block", "box", HEIGHTS_M[0]),
    ],
)
def test_a_slide_again_is_that_of_the_page(
    face: str, tool: str, height_m: float
) -> None:
    make, path_at = FACES[face]
    now = dict(zip(TITLES, row(face, make(), path_at, tool, height_m), strict=True))
    key = [now[title] for title in TITLES[:3]]
    [told] = [r for r in read_rows() if [r[title] for title in TITLES[:3]] == key]
    for title in TITLES[3:]:
        # Micrometres, components and percents: the last digits are round-off.
        close = pytest.approx(number(told[title]), rel=1e-2, abs=2e-3)
        assert number(now[title]) == close, title


def test_contacts_that_share_stiffness_feel_no_seam_in_any_row() -> None:
    for told in read_rows():
        assert (told["lost"], number(told["shared"])) == ("0", 0.0)
        assert max(number(told["distance"]), number(told["normal"])) < 1e-9
