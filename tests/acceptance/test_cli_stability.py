"""`drake-haptics stability` from end to end."""

import functools
import json
import re
from pathlib import Path

import command_line
import pytest
from command_line import call
from held_samples import analyze_sample

from drake_haptics.cli import stability as command
from drake_haptics.simulation.run import RunError


@pytest.fixture
def invoke(monkeypatch, tmp_path):
    """Runs the command in this process, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return functools.partial(command_line.invoke, "stability")


@pytest.fixture
def sample(monkeypatch):
    """Takes the place of the analysis, and notes what it was asked."""
    asked = []

    def analyze(scene, time_s, **settings):
        asked.append((scene, time_s, settings))
        return analyze_sample()

    monkeypatch.setattr(command, "analyze_scene", analyze)
    return asked


def test_a_scene_from_end_to_end(tmp_path):
    process = call(
        *("stability", "sphere_pen", "--map", "0", "--json", "-"), cwd=tmp_path
    )
    assert process.returncode == 0, process.stderr
    # No more than how far it is, if it takes long.
    lines = process.stderr.splitlines()
    assert all(re.fullmatch(r"(stopping|limit) .*: \d+%", line) for line in lines)
    figures = json.loads(process.stdout)
    assert figures["is_stable"] and figures["is_passive"] and figures["map"] is None
    contact, rotation, wall, turned = figures["limits"]
    assert contact["eigenvalue"] > wall["eigenvalue"]
    for limit in (contact, rotation, wall, turned):
        assert limit["simulated"] == pytest.approx(limit["eigenvalue"], rel=5e-3)
    # A contact gives way; against a wall one axis is the worst direction.
    for limit in (contact, rotation):
        assert limit["eigenvalue"] > limit["one_axis"]
    for limit in (wall, turned):
        assert limit["eigenvalue"] > 0.99 * limit["one_axis"]
        assert limit["eigenvalue"] == pytest.approx(limit["one_axis"], rel=0.1)
        assert limit["one_axis"] == pytest.approx(limit["formula"], rel=0.1)
    files = sorted(path.name for path in tmp_path.iterdir())
    assert files == ["sphere_pen-stability.html", "sphere_pen-stability.png"]


def test_the_terminal_shows_a_table_of_one_line_each(invoke, sample):
    result = invoke("sphere_pen", "--at", 1.5, "--map", 7)
    assert result.exit_code == 0, result.output
    ((_, time_s, settings),) = sample
    assert time_s == 1.5 and settings["map_size"] == 7 and settings["store"] is None
    lines = [line.split() for line in result.stdout.splitlines()]
    # One axis and the formula are of a rigid wall.
    assert ["translation,", "contact,", "N/m", "800", "249,070", "249,070", "–",
            "–"] in lines  # fmt: skip
    assert ["translation,", "wall,", "N/m", "800", "16,744", "16,744", "15,863",
            "15,748"] in lines  # fmt: skip
    assert "what grows first: 56.1 Hz; mostly elbow_joint_w" in " ".join(
        result.stdout.split()
    )
    assert "further delay that is stable: 12.3 ms" in result.stdout
    assert Path("sphere_pen-stability.html").is_file()
    assert Path("sphere_pen-stability.png").is_file()
    table = [x for x in result.stdout.splitlines() if x.startswith("translation, wall")]
    assert 0 < max(map(len, table)) <= 80


def test_out_says_where_the_page_is_written(invoke, sample, tmp_path):
    assert invoke("sphere_pen", "--out", tmp_path / "my.page.html").exit_code == 0
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["my.page.html", "my.page.png"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--at", "1e3"], "Error: --at must be on the hand's path, from 0 to"),
        (["--at", "99"], "Error: --at must be on the hand's path, from 0 to"),
        (["--out", "page.png"], "must not be called page.png"),
        (["--out", "nowhere/page.html"], "--out: there is no folder nowhere"),
    ],
)
def test_a_mistake_is_one_line(invoke, arguments, words, tmp_path):
    result = invoke("hammer_block", *arguments)
    assert result.exit_code == 1
    (line,) = result.stderr.splitlines()
    assert line.startswith("Error: ") and words in line
    assert result.stdout == "" and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--map", "1"], "Invalid value for --map: 0 for no map, else at least 2"),
        (["--at", "nan"], "Invalid value for '--at': nan is not a finite number"),
    ],
)
def test_a_value_that_cannot_be_is_a_wrong_call(invoke, arguments, words):
    result = invoke("hammer_block", *arguments)
    assert result.exit_code == 2 and words in result.stderr


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (KeyboardInterrupt(), 130, "Stopped."),
        (RunError("stopped at 0.1 s: it diverged", None), 1, "Error: stopped at 0.1 s"),
        (ValueError("the tool does not come to rest"), 1, "Error: the tool does not"),
    ],
)
def test_what_goes_wrong_is_told_in_a_line(invoke, monkeypatch, error, code, words):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(command, "analyze_scene", fail)
    result = invoke("hammer_block")
    assert result.exit_code == code
    (line,) = result.stderr.splitlines()
    assert line.startswith(words)


def test_a_store_is_that_of_the_map(invoke, sample):
    """What it keeps: analysis/test_scene_stability.py."""
    assert invoke("hammer_block", "--store", "map.jsonl").exit_code == 0
    assert sample[0][2]["store"] == Path("map.jsonl")
