"""Slides of the page on sliding, made again, are those of the page."""

from __future__ import annotations

import pytest
from page_parts import read_part, read_table
from slide_scenes import fifty_pieces, fifty_pieces_path
from sliding_table import HEAD, HEIGHTS_M, PAGE, make_seams, slide_over

TEXT = read_part(PAGE.read_text(encoding="utf-8"), "seams")


def test_slides_again_are_those_of_the_page() -> None:
    """One tool of the table at all heights."""
    solid = fifty_pieces()
    slides = [
        slide_over("50 pieces", solid, fifty_pieces_path, "edge", height_m)
        for height_m in HEIGHTS_M
    ]
    for one in slides:
        assert one.lost == 0
        assert one.shared < 1e-5
        assert max(1e6 * one.distance_m, one.normal) < 1e-9
    _, now = read_table(make_seams(slides))
    head, *rows = read_table(TEXT)
    assert head == HEAD
    [told] = [row for row in rows if row[:2] == ["50 pieces", "edge"]]
    for here, there in zip(now[2:], told[2:], strict=True):
        # The last digit is round-off.
        assert float(here[:-2]) == pytest.approx(float(there[:-2]), rel=1e-2, abs=0.1)


def test_contacts_that_share_stiffness_feel_no_seam() -> None:
    words = " ".join(TEXT.split())
    assert "24 slides: 0 ticks without a contact" in words
    assert "the normal force ripples by 0.000 %" in words
