"""Test the pair query on each hard case against exact arithmetic."""

from __future__ import annotations

import re

import pytest
from hard_cases import HARD_CASES
from hard_cases_table import HEAD, LIBRARIES, PAGE, PART
from page_parts import read_part
from pair_score import score_case

OURS = {name: LIBRARIES[name] for name in ("tracked", "global")}


@pytest.mark.parametrize("case", list(HARD_CASES))
def test_every_answer_is_right(case: str) -> None:
    for name, score in score_case(HARD_CASES[case](), OURS).items():
        assert score.asked > 50
        assert score.wrong == 0, (name, score.complaints)


def test_the_documented_table_has_each_case_once_with_its_numbers_on_the_right() -> (
    None
):
    table = read_part(PAGE.read_text(encoding="utf-8"), PART)
    assert f"\n|---|{'--:|' * (len(HEAD) - 1)}\n" in table
    assert re.findall(r"^\| (.*?) \|", table, re.M)[1:] == list(HARD_CASES)
