"""docs/record-replay.md: its table is the code's, and its reader reads."""

import re
from pathlib import Path

import numpy as np
import pytest
import tick_log_costs
from page_parts import read_part, read_table
from tick_log_samples import make_rows, pack_rows

from drake_haptics.scene.library import list_scenes
from drake_haptics.tick_log.log_format import COUNTS, REALS

PAGE = tick_log_costs.PAGE.read_text("utf-8")


def test_every_quantity_is_explained_in_order():
    table = PAGE[PAGE.index("| quantity |") : PAGE.index("So `F_Ho_W_rendered`")]
    found = []
    for line in table.splitlines()[2:]:
        cells = line.strip("| ").split(" | ")
        if len(cells) < 3:
            continue
        names = re.findall(r"`(\w+)`", cells[0])
        sizes = [int(x) for x in re.findall(r"\d+", cells[1])]
        found += zip(names, sizes * (len(names) // len(sizes)), strict=True)
    expected = [(name, len(numbers)) for name, numbers in REALS.items()]
    assert found == expected + [(name, 1) for name in COUNTS]


def test_the_reader_on_the_page_reads_a_block():
    code = re.findall(r"```python\n(import struct.*?)```", PAGE, re.DOTALL)[0]
    names = {}
    exec(code, names)
    rows = make_rows(6, first=77)
    first, columns = names["read_block"](pack_rows(rows))
    assert first == 77
    reals = np.array(columns[:43]).T
    np.testing.assert_array_equal(reals, rows.reals)
    np.testing.assert_array_equal(np.array(columns[43:]).T, rows.counts)


def test_logs_that_are_written_again_are_as_large_as_the_page_tells(tmp_path):
    rows = dict(read_table(read_part(PAGE))[1:])
    [low, high] = map(
        int, rows[f"bytes per tick, {len(list_scenes())} scenes"].split(" to ")
    )
    sizes = tick_log_costs.measure_bytes(tmp_path, ["sphere_pen", "can_box"])
    # On a busy machine blocks are shorter, and pack less well.
    for size in sizes.values():
        assert 0.9 * low < size < 1.15 * high
    [slow, fast] = map(float, rows["MB per minute at 1 kHz"].split(" to "))
    # Of rounded bytes, and rounded itself.
    assert [slow, fast] == pytest.approx([0.06 * low, 0.06 * high], abs=0.1)


def test_the_picture_is_there():
    for picture in re.findall(r"!\[.*?\]\((\S+)\)", PAGE):
        assert (Path(__file__).parents[2] / "docs" / picture).is_file()
