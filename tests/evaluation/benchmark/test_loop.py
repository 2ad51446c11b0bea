"""Whole loops are given the same, do the same, and are told as they are."""

from __future__ import annotations

import json
import math
import time
from dataclasses import asdict, replace

import numpy as np
import pytest
from fake_clock import FakeClock
from page_parts import read_part, read_table
from write_docs import PAGE, show_tables, with_tables

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.benchmark.benchmark import (
    BenchFigures,
    Effort,
    make_tables,
)
from drake_haptics.evaluation.benchmark.loop import runs, simulated_ticks
from drake_haptics.evaluation.benchmark.loop.figures import (
    BACKEND,
    EMPTY,
    MUJOCO,
    NATIVE,
    OURS,
    PLANT,
    SCENE,
    STOCK,
    LoopFigures,
    loop_tables,
)
from drake_haptics.evaluation.benchmark.loop.problem import (
    Loop,
    LoopCourse,
    LoopProblem,
    make_problem,
)
from drake_haptics.evaluation.benchmark.loop.runs import make_loops, run_loops
from drake_haptics.evaluation.benchmark.loop.this_package import NativeLoop, ThisLoop
from drake_haptics.evaluation.measuring.timing import TickTimes

# The spoon comes in and begins to scrape.
_SECONDS = 1.2


@pytest.fixture(scope="module")
def problem() -> LoopProblem:
    return make_problem(duration_s=_SECONDS)


@pytest.fixture(scope="module")
def loops(problem: LoopProblem) -> dict[str, Loop]:
    return make_loops(problem)[0]


@pytest.fixture(scope="module")
def courses(loops: dict[str, Loop]) -> dict[str, LoopCourse]:
    found = {name: loop.observe() for name, loop in loops.items()}
    return {name: course for name, course in found.items() if course is not None}


def test_only_a_solver_that_drake_lacks_is_missing(
    problem: LoopProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> Loop:
        raise RuntimeError("a defect")

    monkeypatch.setattr(runs, "STOCK", {"gone": "gauss"})
    loops, missing = make_loops(problem)
    assert "gone" not in loops and "no contact solver 'gauss'" in missing["gone"]
    monkeypatch.setattr(runs, "STOCK", {"there": "sap"})
    monkeypatch.setattr(runs, "StockLoop", fail)
    with pytest.raises(RuntimeError, match="a defect"):
        make_loops(problem)


def test_our_loop_repeats_the_recorded_run(
    problem: LoopProblem, courses: dict[str, LoopCourse]
) -> None:
    course = courses[OURS]
    assert course.num_contacts[0] == 0 and course.num_contacts[-1] > 0
    np.testing.assert_allclose(course.X_WT, problem.motion.X_WT, rtol=0, atol=1e-9)


def test_the_native_part_computes_what_the_whole_loop_does(
    courses: dict[str, LoopCourse],
) -> None:
    ours, native = courses[OURS], courses[NATIVE]
    np.testing.assert_allclose(native.X_WT, ours.X_WT, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(native.num_contacts, ours.num_contacts)
    np.testing.assert_allclose(native.nearest_m, ours.nearest_m, rtol=0, atol=1e-9)


def test_a_backend_in_python_moves_the_tool_as_the_recording_does(
    courses: dict[str, LoopCourse],
) -> None:
    ours, backend = courses[OURS], courses[BACKEND]
    np.testing.assert_allclose(backend.X_WT, ours.X_WT, rtol=0, atol=1e-9)


def test_the_simulated_device_moves_the_tool_as_it_was_recorded(
    courses: dict[str, LoopCourse],
) -> None:
    """The recording begins one tick later."""
    ours, scene = courses[OURS], courses[SCENE]
    np.testing.assert_array_equal(ours.num_contacts[1:-1], scene.num_contacts[2:])
    np.testing.assert_allclose(ours.X_WT[1:-1], scene.X_WT[2:], rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", [PLANT, *STOCK, MUJOCO])
def test_others_are_pressed_with_a_like_force_at_a_like_place(
    name: str, courses: dict[str, LoopCourse]
) -> None:
    if name not in courses:
        pytest.skip(f"{name} cannot be run here")
    ours, theirs = courses[OURS], courses[name]
    pressed = ours.force_N > 0.75 * ours.force_N.max()
    assert theirs.num_contacts[pressed].min() > 0
    # They are pressed later, by the tolerance; both hands go on alike.
    apart_m = np.linalg.norm(theirs.X_WT[:, 4:] - ours.X_WT[:, 4:], axis=1)
    assert apart_m.max() < 2e-3
    mean_N = theirs.force_N[pressed].mean()
    assert mean_N == pytest.approx(ours.force_N[pressed].mean(), rel=0.4)


def test_every_loop_starts_again_each_time(
    loops: dict[str, Loop], courses: dict[str, LoopCourse]
) -> None:
    for name, first in courses.items():
        seconds = loops[name].time()
        again = loops[name].observe()
        assert again is not None and len(seconds) == len(first.X_WT)
        np.testing.assert_array_equal(again.X_WT, first.X_WT)


def test_a_paced_loop_waits_for_the_clock_and_waiting_belongs_to_no_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = make_problem(duration_s=0.1)
    clock = FakeClock(reading_s=1e-6)
    monkeypatch.setattr(time, "perf_counter", clock)
    monkeypatch.setattr(
        simulated_ticks,
        "RealTimePacer",
        lambda period_s: RealTimePacer(period_s, clock, clock.sleep),
    )
    start_s = clock()
    seconds = ThisLoop(problem, paced=True).time()
    elapsed_s = clock() - start_s
    assert len(seconds) == len(problem.motion)
    # The first tick, the first of the clock and the last wait for nothing.
    assert elapsed_s > (len(seconds) - 3) * problem.motion.period_s
    # From the reading that begins a tick to the one that ends it.
    np.testing.assert_allclose(seconds, 1e-6)


def test_figures_are_those_of_the_ticks_that_all_touch_in(
    problem: LoopProblem, loops: dict[str, Loop], courses: dict[str, LoopCourse]
) -> None:
    some = {name: loops[name] for name in (OURS, NATIVE, PLANT, EMPTY)}
    figures = run_loops(problem, some, repeats=3)
    assert [f.loop for f in figures] == list(some)
    all_touch = [courses[name].num_contacts[1:] > 0 for name in some if name != EMPTY]
    touching = np.all(all_touch, axis=0)
    for f in figures:
        assert f.in_contact.ticks == touching.sum() > 0
        assert f.all_ticks.ticks == len(problem.motion) - 1
        if f.loop not in courses:
            assert math.isnan(f.apart_m)
            continue
        course = courses[f.loop]
        assert f.deepest_m == -course.nearest_m.min()
        assert math.copysign(1.0, f.deepest_m) == 1.0  # it prints no -0.00 mm
        assert f.median_contacts == np.median(course.num_contacts[1:][touching])
        assert f.loop != OURS or f.apart_m == 0.0


def _figures(loop: str, median_us: float) -> LoopFigures:
    times = TickTimes(9, median_us, 2 * median_us, math.nan)
    return LoopFigures("cup", loop, times, times, 2.0, 7, 1e-4, 1.5, 2.5, 3e-4)


SOME = [_figures(OURS, 60.0), _figures(NATIVE, 6.0), _figures(MUJOCO, 30.0)]


def test_ratios_are_to_the_row() -> None:
    rows = {row[0]: row[-2:] for row in loop_tables(SOME)[0].rows}
    assert rows[OURS] == ("1.00", "0.10")
    assert rows[MUJOCO] == ("2.00", "0.20")


def test_what_has_no_tool_did_nothing_and_each_scene_has_its_tables() -> None:
    times = TickTimes(9, 6.0, 12.0, math.nan)
    empty = LoopFigures("cup", EMPTY, times, times, 0.0, 0, *[math.nan] * 4)
    tables = loop_tables([*SOME, empty, *(replace(f, scene="peg") for f in SOME)])
    assert [(EMPTY in {row[0] for row in table.rows}) for table in tables] == [
        True,
        False,
        False,
        False,
    ]
    assert ["peg" in table.title for table in tables] == [False, False, True, True]


def test_tables_are_rectangular() -> None:
    for table in loop_tables(SOME):
        assert all(len(row) == len(table.header) for row in table.rows)


def test_figures_survive_json() -> None:
    figures = BenchFigures(machine={}, loop=SOME)
    read = BenchFigures.from_dict(json.loads(json.dumps(figures.to_dict())))
    assert asdict(read.loop[0])["in_contact"]["median_us"] == 60.0
    assert math.isnan(read.loop[0].all_ticks.p99_9_us)
    assert make_tables(read)[1].rows == loop_tables(SOME)[1].rows


def shown_below(title: str) -> str:
    """What the page has below the title of a table of another scene, `cup`."""
    section = read_part(PAGE.read_text(encoding="utf-8"))
    below = section.split(f"### {title.replace('cup', 'cup_spoon')}\n")[1]
    return below.split("###")[0]


def rows_below(title: str) -> list[list[str]]:
    """The cells of that table, its head first, without the line below."""
    return read_table(shown_below(title))


def test_the_page_has_the_tables_with_their_headings_and_rows() -> None:
    for table in loop_tables(SOME):
        assert table.note in shown_below(table.title)
        head, *rows = rows_below(table.title)
        assert tuple(head) == table.header
        assert {OURS, NATIVE, MUJOCO} <= {
            name for row in rows for name in names_of(row)
        }


def names_of(row: tuple[str, ...]) -> list[str]:
    """Returns the loops of a row of the page: equal ones share a row."""
    return row[0].split("; ")


def test_tables_of_a_scene_that_the_page_lacks_come_after_all_others() -> None:
    page = PAGE.read_text(encoding="utf-8")
    renamed = [replace(f, scene="another") for f in SOME]
    written = with_tables(page, BenchFigures(machine={}, loop=renamed))
    added = "\n".join(show_tables(BenchFigures(machine={}, loop=renamed)).values())
    assert read_part(written) == f"{read_part(page)}{added}\n"
    again = with_tables(written, BenchFigures(machine={}, loop=renamed))
    assert again == written


def test_our_loop_does_again_what_the_page_tells() -> None:
    """Its contacts, depth and largest force, over the whole motion that was timed."""
    course = NativeLoop(make_problem(duration_s=Effort().loop_s)).observe()
    most, deepest_m = course.num_contacts[1:].max(), 0.0 - course.nearest_m.min()
    median = np.median(course.num_contacts[course.num_contacts > 0])
    head, *rows = rows_below(loop_tables(SOME)[1].title)
    found = [row for row in rows if {OURS, NATIVE} & {*names_of(row)}]
    assert found
    for told in found:
        figures = dict(zip(head, told, strict=True))
        assert figures["contacts"] == f"{median:.0f}–{most}"
        assert figures["deepest"] == f"{1e3 * deepest_m:.2f} mm"
        assert figures["force"].endswith(f" / {course.force_N[1:].max():.2f} N")
