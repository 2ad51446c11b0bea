"""Times, ratios and tables of the benchmark are computed as they say."""

from __future__ import annotations

import json
import math
from itertools import count

import numpy as np
import pytest
from bench_samples import EVERYTHING, FIGURES, pair, scene

from drake_haptics.evaluation.benchmark.benchmark import (
    BenchFigures,
    machine_line,
    make_tables,
    missing_lines,
)
from drake_haptics.evaluation.benchmark.pair_tables import (
    COLUMNS,
    geometric_mean,
    growth,
    ratios_to_fastest,
    time_table,
)
from drake_haptics.evaluation.measuring import timing
from drake_haptics.evaluation.measuring.timing import CallTimer, TickTimes, typical


def test_a_library_that_is_alone_is_named_once_in_the_heads() -> None:
    several, alone = time_table(FIGURES), time_table([FIGURES[0], FIGURES[2]])
    assert several.header[2] == "apart: fastest"
    assert [row[2] for row in several.rows] == ["1.00 / 2.00 fast", "5.00 / 10.00 slow"]
    assert alone.header[2] == "apart: slow"
    assert alone.rows[0][2] == "4.00 / 8.00"


def test_a_ratio_is_to_the_fastest_other_library_of_each_pair() -> None:
    ratios = ratios_to_fastest(FIGURES, COLUMNS["apart median"])
    assert ratios["ours"] == pytest.approx([0.1, 0.04])
    assert ratios["fast"] == pytest.approx([1.0, 1.6])
    assert ratios["slow"] == pytest.approx([4.0, 1.0])
    assert geometric_mean(ratios["ours"]) == pytest.approx(math.sqrt(0.004))


def test_without_other_libraries_there_are_no_ratios() -> None:
    assert ratios_to_fastest([pair("ours", 42, 0.1)], COLUMNS["apart p99"]) == {}


def test_growth_is_the_mean_factor_over_the_kinds() -> None:
    figures = [*FIGURES, pair("ours", 42, 1, "slab"), pair("ours", 2562, 8, "slab")]
    grown = growth(figures, "ours", COLUMNS["in depth p99"], 42, 2562)
    assert grown == pytest.approx(math.sqrt(2 * 8))
    assert math.isnan(growth(FIGURES, "ours", COLUMNS["apart p99"], 42, 162))


def test_typical_times_leave_interruptions_out() -> None:
    seconds = np.array([[1.0, 5.0], [3.0, 5.0], [900.0, 5.0], [2.0, 5.0], [0.0, 5.0]])
    np.testing.assert_array_equal(typical(seconds), [2.0, 5.0])
    assert typical(seconds[:1])[0] == 1.0


def test_times_are_summed_up_in_microseconds() -> None:
    times = TickTimes.of(np.arange(101) * 1e-6)
    assert (times.ticks, times.median_us) == (101, pytest.approx(50))
    assert times.p99_us == pytest.approx(99)
    assert TickTimes.of(np.array([])).ticks == 0


def test_a_call_is_charged_less_what_a_trivial_one_costs(monkeypatch) -> None:
    clock = count()
    monkeypatch.setattr(timing.time, "perf_counter", lambda: float(next(clock)))

    def work(ticks: int) -> str:
        for _ in range(ticks):
            next(clock)
        return "done"

    timer = CallTimer(work, (2,))
    assert timer.call((2,)) == ("done", 0.0)
    assert timer.call((9,)) == ("done", 7.0)


def test_figures_survive_json() -> None:
    empty = scene("drake_haptics", TickTimes.of(np.array([])))
    figures = BenchFigures(**{**vars(EVERYTHING), "scenes": [empty]})
    text = json.dumps(figures.to_dict(), allow_nan=False)
    back = BenchFigures.from_dict(json.loads(text))
    assert back.pairs == FIGURES and back.python == EVERYTHING.python
    assert math.isnan(back.scenes[0].near.median_us)
    assert BenchFigures.from_dict(EVERYTHING.to_dict()) == EVERYTHING


def test_tables_show_the_figures() -> None:
    tables = make_tables(EVERYTHING)
    for table in tables:
        assert all(len(row) == len(table.header) for row in table.rows)
    ratios, errors, times, python, scenes = tables
    assert ratios.rows[0][:3] == ("ours", "0.063", "0.063")
    assert errors.rows[0] == ("ours", "1e-12", "0.00 %", "100.00 %", "0.5°", "0")
    assert times.rows[1][0] == "ball, 2562"
    assert times.rows[1][1:3] == ("0.20 / 0.40", "5.00 / 10.00 slow")
    assert python.rows == [("ball, 42", "0.50", "2.00", "0.25")]
    assert scenes.rows[0][-1] == "0.10 / 0.20"


def test_a_part_that_was_not_run_has_no_table() -> None:
    assert make_tables(BenchFigures(machine=EVERYTHING.machine)) == []


def test_the_machine_and_the_missing_are_named() -> None:
    line = machine_line(EVERYTHING)
    assert "abacus, 1 cores" in line and "coal 3" in line
    assert missing_lines(EVERYTHING) == ["not measured: fcl (No module named 'fcl')"]


def test_a_table_in_markdown() -> None:
    text = make_tables(EVERYTHING)[3].to_markdown()
    assert text.startswith("### One pair query from Python\n\n")
    assert "| pair, vertices | drake_haptics, µs | coal, µs | ratio |" in text
    assert "| --- | --: | --: | --: |\n| ball, 42 | 0.50 | 2.00 | 0.25 |\n" in text
