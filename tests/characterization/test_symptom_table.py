"""The page on symptoms has the cases of its table, and they are as it says."""

import io
import re
from pathlib import Path

import numpy as np
import pytest
import symptom_run
import symptom_table
from page_parts import read_part, read_table
from rich.console import Console
from symptom_cases import CASES, COUPLING
from symptom_run import Case, Ticks
from symptom_table import HEAD, PAGE, describe_case, make_row

from drake_haptics.cli.status_line import make_summary
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import GravityParameters
from drake_haptics.simulation.statistics import RunStatistics

TEXT = PAGE.read_text(encoding="utf-8")
SECTIONS = list(dict.fromkeys(case.section for case in CASES))
# More is better in these.
RISES = {"ticks in contact, %", "largest force, N"}


def read_row(case):
    """Returns the page's row of a case."""
    place = [x for x in CASES if x.section == case.section].index(case)
    return read_table(read_part(TEXT, case.section))[1 + place]


@pytest.mark.parametrize("section", SECTIONS)
def test_the_page_has_the_cases_of_the_command(section):
    head, *rows = read_table(read_part(TEXT, section))
    assert head == HEAD
    assert [row[:3] for row in rows] == [
        describe_case(case) for case in CASES if case.section == section
    ]


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c.section}-{c.figure}")
def test_each_cure_cures_by_five_times_at_least(case):
    before, after = map(float, read_row(case)[3:])
    if case.figure in RISES:
        before, after = after, before
    assert before > 5.0 * after


def test_a_weight_hangs_below_a_handle_by_its_weight_over_the_stiffness():
    (case,) = (c for c in CASES if "effects.gravity" in c.provoked)
    weight_N = case.provoked["tool.mass_kg"] * np.linalg.norm(
        GravityParameters().acceleration_m_per_s2
    )
    for stiffness, cell in [(case.provoked[COUPLING], 3), (case.cure[COUPLING], 4)]:
        hangs_mm = 1e3 * weight_N / stiffness
        assert float(read_row(case)[cell]) == pytest.approx(hangs_mm, rel=5e-3)
    assert make_row(case) == read_row(case)


@pytest.mark.parametrize("section", ["nothing"])
def test_the_page_says_what_is_measured(section):
    (case,) = (c for c in CASES if c.section == section)
    assert make_row(case) == read_row(case)


def test_a_key_that_is_none_of_a_scene_is_refused():
    case = Case("", "cup_spoon", "", {"contact.stifness_N_per_m": 1.0}, {})
    with pytest.raises(AttributeError, match="stifness"):
        case.make_scene(cured=False)


def test_figures_are_those_of_known_motions():
    """A hand that rests at the end, after a jump of 2 N and of 3 mm."""
    n = 1000
    force, p_WT = np.zeros((n, 3)), np.zeros((n, 3))
    force[100:] = [0.0, 2.0, 0.0]
    force[-100::2, 0] = 0.5
    p_WT[200:, 2] = 3e-3
    depth = np.full(n, -np.inf)
    depth[500:] = 1e-3
    ticks = Ticks(1e-3, force, p_WT, np.zeros((n, 3)), depth, 10, 2e-4)
    found = {name: figure(ticks) for name, figure in symptom_run.FIGURES.items()}
    assert found == pytest.approx(
        {
            "ripple of the force on a hand at rest, N": 0.5,
            "way of the tool under a hand at rest, mm": 0.0,
            "largest jump of the force in one tick, N": 2.0,
            "deepest contact, mm": 1.0,
            "largest force, N": np.hypot(2.0, 0.5),
            "ticks in contact, %": 50.0,
            "ticks at the device's limit, %": 1.0,
            "tool behind the handle, at most, mm": 3.0,
            "tool behind a hand at rest, mm": 3.0,
            "work of a tick, % of its time": 20.0,
        }
    )


def test_the_scenes_can_be_written_and_read(tmp_path):
    symptom_table.write_scenes(tmp_path)
    files = sorted(tmp_path.iterdir())
    assert len(files) == 2 * len(CASES)
    for file, case in zip(files[::2], CASES, strict=True):
        written, meant = load_scene(file), case.make_scene(cured=False)
        for part in ("contact", "coupling", "device", "effects", "hand"):
            assert getattr(written, part) == getattr(meant, part)


def test_figures_that_the_page_names_are_in_the_summary_of_a_run():
    figures = RunStatistics(1e-3).to_dict()
    figures["lateness_us"] = {"p50": 1.0, "p99": 2.0, "p99_9": 3.0, "skipped": 0}
    part = {"in": 1.0, "out": 0.5, "beyond": 1.0}
    figures["energy_J"] = {"device": part, "contact": part}
    console = Console(file=io.StringIO(), width=200)
    console.print(make_summary(figures))
    summary = console.file.getvalue()
    named = set(re.findall(r"(?<!\*)\*([a-z9. ]+)\*(?!\*)", TEXT))
    assert {"whole tick", "late", "device limit", "penetration", "energy"} <= named
    # Words of this page, and of other commands.
    named -= {"shown by", "cured by", "the hand goes through the wall", "not shown"}
    named -= {"pieces", "formula", "error"}
    assert [word for word in named if word not in summary] == []


def test_messages_that_the_page_quotes_are_those_of_the_program():
    package = PAGE.parents[1] / "drake_haptics"
    python = "".join(map(Path.read_text, package.rglob("*.py")))
    # Texts that go on in the next line, and what is filled into them.
    python = re.sub(r"\{[^{}]*\}", "", re.sub(r'"\s*\n?\s*f?"', "", python))
    source = python + "".join(map(Path.read_text, package.rglob("*.js")))
    quoted = re.findall(r'"([^"`]+)"', re.sub(r"`[^`]*`", "", TEXT))
    assert len(quoted) > 5
    for message in quoted:
        for part in message.split("…"):
            assert part.strip() in source, message
