"""The page on accuracy has all figures, and commands that measure each row again."""

import html
import re
import shlex
from dataclasses import replace

import pytest
from accuracy_samples import make_peers, make_row, make_study
from PIL import Image

from drake_haptics.evaluation.accuracy.page import write_accuracy_page
from drake_haptics.evaluation.accuracy.report import (
    describe_knees,
    describe_verdict,
    get_columns,
    group_rows,
    make_cells,
)
from drake_haptics.evaluation.accuracy.setting import read_setting

STUDY = make_study(peers=make_peers())


def write(study, folder, command="drake-haptics accuracy cup_spoon"):
    write_accuracy_page(study, folder / "page.html", command)
    return (folder / "page.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write(STUDY, tmp_path_factory.mktemp("page"))


def test_sentences_come_before_the_picture_and_it_before_the_table(page):
    words = html.unescape(page)
    order = [
        *describe_verdict(STUDY),
        *describe_knees(STUDY),
        "data:image/png;base64,iVBOR",
        "Price list",
        "Differences of model",
        "Not measured",
        "Other libraries",
        "What the columns mean",
        "How it was measured",
    ]
    places = [words.index(part) for part in order]
    assert places == sorted(places)
    assert "{{" not in page and "{%" not in page


def test_heads_say_what_two_figures_in_a_cell_are(page):
    heads = re.findall(r"<th[^>]*>(\w+)<small>(.*?)</small>", page)
    parts = dict(heads[: len(get_columns(STUDY))])
    row = make_cells(STUDY.rows[0], get_columns(STUDY))
    for column, cell in zip(get_columns(STUDY), row, strict=True):
        assert ("/" in parts[column.head].partition("<br>")[2]) == ("/" in cell)
    assert parts["tick"] == "µs<br>median / p99"
    assert parts["force"] == "N<br>rms / largest"


def read_rows(page):
    """The cells of each row of the price list that has a command."""
    table = page.split("<table>")[1].split("</table>")[0]
    return [
        [html.unescape(re.sub("<.*?>", "", cell)) for cell in row.split("</td>")[:-1]]
        for row in re.findall(r"<tr.*?</tr>", table)
        if "--only" in row
    ]


def test_every_row_has_its_figures_and_a_command_that_asks_for_it(page):
    columns = get_columns(STUDY)
    rows = read_rows(page)
    assert len(rows) == len(STUDY.rows)
    grouped = [row for _, group in group_rows(STUDY) for row in group]
    for row, (label, *cells, command) in zip(grouped, rows, strict=True):
        assert label.lstrip("*† ") == row.setting.label
        assert tuple(cells) == make_cells(row, columns)
        words = shlex.split(command)
        assert set(words[::2]) == {"--only"}
        assert read_setting(words[1::2]).changes == row.setting.changes


def test_bars_are_as_long_as_times_and_decades_of_error(page):
    shares = re.findall(r'class="bar (\w+)" style="--share: ([\d.]+)%"', page)
    times = [float(share) for kind, share in shares if kind == "time"]
    errors = [float(share) for kind, share in shares if kind == "error"]
    assert times[:3] == [77.4, 77.4, 100.0]  # 24 and 31 µs of 31
    assert errors[2] == 0.0 and max(errors) == 100.0
    # 4 mN is 0.602 of the 3.380 decades from 1 mN to 2.4 N.
    assert errors[0] == pytest.approx(100 * 0.602 / 3.380, abs=0.1)


def test_the_picture_is_beside_the_page(tmp_path):
    write(STUDY, tmp_path)
    with Image.open(tmp_path / "page.png") as picture:
        assert picture.width > 1200 and picture.height > 800


def test_names_are_escaped(tmp_path):
    row = make_row("<b>knob</b>", "<i>one</i>", 1.0, 1.0, 1.0, is_scene=True)
    odd = replace(make_study(row), scene="<u>x</u>", description="<script>1</script>")
    command = shlex.join(["accuracy", "a 'scene' & <file>.yaml"])
    page = write(odd, tmp_path, command)
    for tag in ("<b>knob", "<i>", "<u>", "<script>", "<file>", "a <processor>"):
        assert tag not in page
    assert command in html.unescape(page)


def test_a_study_without_peers_or_models_has_no_section_of_them(tmp_path):
    page = write(make_study(make_row("a", "b", 1.0, 1.0, 1.0)), tmp_path)
    for words in ("Other libraries", "Differences of model", "Not measured"):
        assert words not in page


def test_a_page_cannot_take_its_pictures_name(tmp_path):
    with pytest.raises(ValueError, match=r"must not be called page\.png"):
        write_accuracy_page(STUDY, tmp_path / "page.png", "cup_spoon")
    assert list(tmp_path.iterdir()) == []
