"""docs/accuracy.md has all scenes, settings and columns of its price lists."""

from __future__ import annotations

import re
import shlex

import pytest
from accuracy_samples import make_study
from accuracy_table import (
    ADVICE_NAME,
    COLUMNS_NAME,
    ERRORS,
    PAGE,
    SCENES,
    get_picture,
    make_columns,
    make_prices,
    measure_errors,
    with_errors,
)
from command_line import invoke
from page_parts import find_part, read_part, read_table, replace_part

from drake_haptics.evaluation.accuracy.knobs import AS_IT_IS, list_settings
from drake_haptics.evaluation.accuracy.report import COLUMNS
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

TEXT = PAGE.read_text(encoding="utf-8")
FIRST = next(iter(SCENES))


def rows_of(page: str, name: str) -> list[list[str]]:
    """Returns the cells of the table of a part, headings first."""
    return read_table(read_part(page, name))


@pytest.mark.parametrize("name", SCENES)
def test_every_setting_has_a_row_with_all_columns(name: str) -> None:
    head, *rows = rows_of(TEXT, name)
    assert head[:2] == ["key", "setting"]
    assert head[2:] == [f"{column.head}, {column.unit}" for column in COLUMNS]
    assert all(len(row) == len(head) for row in rows)
    written = [(knob, label.strip("*† ")) for knob, label, *_ in rows]
    assert written[0] == (AS_IT_IS.knob, AS_IT_IS.label)
    expected = [
        (setting.knob, setting.label)
        for setting in list_settings(load_scene(find_scene(name)))
        if setting.knob.startswith(SCENES[name])
    ]
    # The scene's own settings are those of its first row.
    assert set(written[1:]) < set(expected)
    own = [key for key in expected if key not in written]
    assert [knob for knob, _ in own] == list(
        dict.fromkeys(k for k, _ in expected if k != AS_IT_IS.knob)
    )


@pytest.mark.parametrize(
    ("name", "knob", "label"),
    [
        ("cup_spoon", "tool.decomposition", "one hull"),
        ("rubbed_sphere", "effects.shading", "no shading"),
    ],
)
def test_errors_that_are_measured_again_are_those_of_the_page(
    name: str, knob: str, label: str
) -> None:
    """To mend it: accuracy_table.py --write --errors KNOB."""
    again = measure_errors(name, lambda x: (x.knob, x.label) == (knob, label))
    [cells] = again.values()
    [told] = [r for r in rows_of(TEXT, name) if (r[0], r[1].strip("*† ")) in again]
    for now, then in zip(cells, told[ERRORS], strict=True):
        # Force has two figures; the last digit is round-off.
        for figure, text in zip(now.split("/"), then.split("/"), strict=True):
            assert float(figure) == pytest.approx(float(text), rel=0.02, abs=2e-3)


def test_errors_of_some_knobs_replace_those_of_their_rows_and_nothing_else() -> None:
    key = ("tool.decomposition", "one hull")
    renewed = with_errors(TEXT, "cup_spoon", {key: ["7/8", "9", "10", "11"]})
    lines = zip(TEXT.splitlines(), renewed.splitlines(), strict=True)
    [(before, after)] = [(x, y) for x, y in lines if x != y]
    assert "| tool.decomposition | one hull | " in before
    assert after.split(" | ")[2:4] == before.split(" | ")[2:4]
    assert " | 7/8 | 9 | 10 | 11 | " in after


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_has_its_sentences(name: str) -> None:
    part = read_part(TEXT, name)
    assert "A tick of the scene as it is takes" in part
    assert "Errors are against" in part
    assert "read ratios" in part


@pytest.mark.parametrize("name", SCENES)
def test_the_advice_is_that_of_the_price_list(name: str) -> None:
    lines = read_part(TEXT, ADVICE_NAME).splitlines()
    [advice] = [x for x in lines if x.startswith(f"- **{name}**: ")]
    assert read_part(TEXT, name).strip().startswith(advice.partition(": ")[2])


def test_the_columns_are_those_of_today() -> None:
    assert read_part(TEXT, COLUMNS_NAME).strip() == make_columns().strip()


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_of_a_scene_is_there(name: str) -> None:
    picture = get_picture(name)
    assert picture.name in TEXT and picture.is_file()


def test_commands_that_are_shown_have_options_that_exist() -> None:
    asked = re.findall(r"^drake-haptics (accuracy .*?)(?: +#.*)?$", TEXT, re.MULTILINE)
    assert len(asked) == 4
    known = invoke("accuracy", "--help").stdout
    for line in asked:
        for word in shlex.split(line):
            assert not word.startswith("--") or word in known


def test_new_figures_replace_the_old_ones_and_nothing_else() -> None:
    prices = make_prices(make_study())
    renewed = replace_part(TEXT, prices, FIRST)
    assert "tool.max_triangles" in rows_of(renewed, FIRST)[-2][0]
    assert "**as it is**" in prices and "0.5 mm †" in prices and "| CoACD |" in prices
    for page in (TEXT, renewed):
        assert page.count(FIRST) > 1
    before, after = (page[: find_part(page, FIRST).start] for page in (TEXT, renewed))
    assert before == after
