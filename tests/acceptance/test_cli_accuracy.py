"""`drake-haptics accuracy` from end to end."""

import functools
import json
import re
from dataclasses import replace
from pathlib import Path

import command_line
import pytest
from accuracy_samples import make_peers, make_study
from command_line import call

from drake_haptics.cli import accuracy as command
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.run import RunError

ONLY = ["--only", "contact.tolerance_m=0.00025"]


@pytest.fixture
def invoke(monkeypatch, tmp_path):
    """Runs the command in this process, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return functools.partial(command_line.invoke, "accuracy")


@pytest.fixture
def sample(monkeypatch):
    """Takes the place of the study, and notes what it was asked."""
    asked = []

    def study(scene, name, **settings):
        asked.append((scene, name, settings))
        return make_study()

    def add_peers(study, scene, **_):
        return replace(study, peers=make_peers())

    monkeypatch.setattr(command, "run_accuracy_study", study)
    monkeypatch.setattr(command, "add_peers", add_peers)
    return asked


@pytest.fixture
def fresh_runs(monkeypatch):
    """Takes the place of runs in other processes: tolerance and hull save time."""

    def measure(scene):
        saved = 40.0 * (scene.contact.tolerance_m < 5e-4)
        return 300.0 - saved - 100.0 * (scene.tool.decomposition == "hull")

    monkeypatch.setattr(command, "measure_p99", measure)


def test_one_row_from_end_to_end_and_again_from_its_store(invoke):
    arguments = ["sphere_pen", "--quick", *ONLY, "--store", "s.jsonl"]
    first = call("accuracy", *arguments, "--json", "-")
    assert first.returncode == 0, first.stderr
    # A machine that is busy makes it last long enough for a word on how far it is.
    word = r"(errors|times): \d of \d(, about \d+ s left)?: +\d+%\n"
    assert re.sub(word, "", first.stderr) == ""
    study = AccuracyStudy.from_dict(json.loads(first.stdout))
    scene, row = study.rows
    assert scene.is_scene and not row.is_scene
    assert (row.setting.knob, row.setting.label) == ("contact.tolerance_m", "0.25 mm")
    assert row.setting.changes == {"contact.tolerance_m": 2.5e-4}
    # At the scene's poses nothing pushes with the nearer tolerance: the error is all
    # of the force, which is below 4 N.
    assert scene.errors.force_rms_N == 0.0
    assert 0.3 < row.errors.force_rms_N <= row.errors.force_max_N < 4.0
    kept = Path("s.jsonl").read_bytes()
    second = invoke(*arguments, "--json", "second.json")
    assert second.exit_code == 0, second.stderr
    assert Path("s.jsonl").read_bytes() == kept
    assert json.loads(Path("second.json").read_text()) == json.loads(first.stdout)
    assert "†0.25 mm" in second.stdout and "Wrote" not in second.stdout


def test_a_generous_budget_gives_up_nothing_and_its_file_runs(invoke):
    held = invoke("sphere_pen", "--quick", "--budget-us", 1e6, "--write", "held.yaml")
    assert held.exit_code == 0, held.stderr
    assert "sphere_pen as it is holds 1e+06 µs" in held.stdout
    assert "Nothing is given up." in held.stdout
    assert [path.name for path in Path().iterdir()] == ["held.yaml"]
    ran = command_line.invoke("run", "held.yaml", "--headless", "--duration", 0.05)
    assert ran.exit_code == 0, ran.stderr


def test_the_terminal_shows_the_price_list(invoke, sample):
    result = invoke("hammer_block", "--quick", "--instructions")
    assert result.exit_code == 0, result.output
    ((scene, name, settings),) = sample
    assert scene.description.startswith("A hammer") and name == "hammer_block"
    assert settings["quick"] and settings["count_instructions"]
    assert settings["settings"] is None and settings["store"] is None
    lines = [line.split() for line in result.stdout.splitlines()]
    assert ["*", "1", "mm", "150/300", "24.0", "0.004/0.016", "4.0", "0", "0.004",
            "30000"] in lines  # fmt: skip
    text = " ".join(result.stdout.split())
    assert "Knee: tool.max_triangles 200: 8.00 µs in the core" in text
    assert "Errors are against every contact by itself" in text
    assert "† differences of model, not errors: contact.depth:" in text
    assert "not measured: decomposition CoACD: coacd is not installed" in text
    rows = [x for x in result.stdout.splitlines() if "150/300" in x]
    assert 0 < max(map(len, rows)) <= 100
    assert Path("hammer_block-accuracy.html").is_file()
    assert Path("hammer_block-accuracy.png").is_file()


@pytest.mark.parametrize("options", [[], ["--quick"]])
def test_the_page_tells_the_command_that_makes_its_rows_again(invoke, sample, options):
    # A quick motion is another one, and has other errors.
    assert invoke("hammer_block", *options, "--out", "page.html").exit_code == 0
    command = " ".join(["drake-haptics accuracy hammer_block", *options])
    assert Path("page.html").read_text().count(f"<code>{command}</code>") == 2


def test_the_scene_is_cup_spoon_where_none_is_named(invoke, sample):
    assert invoke("--out", "my.page.html").exit_code == 0
    assert sample[0][1] == "cup_spoon"
    assert sorted(path.name for path in Path().iterdir()) == [
        "my.page.html",
        "my.page.png",
    ]


@pytest.mark.parametrize(
    ("arguments", "beside"),
    [([], True), (["--no-peers"], False), (["--quick"], False), (ONLY, False)],
)
def test_other_libraries_are_beside_a_whole_price_list(
    invoke, sample, arguments, beside
):
    result = invoke("hammer_block", *arguments)
    assert result.exit_code == 0, result.output
    assert ("Beside it: MuJoCo 3.3.0, its own contacts" in result.stdout) == beside


def test_only_asks_for_one_setting_in_its_own_words(invoke, sample):
    words = ["--only", "contact.clustering=octree"]
    words += ["--only", "contact.cluster_size_m=0.002"]
    result = invoke("hammer_block", *words)
    assert result.exit_code == 0, result.output
    (setting,) = sample[0][2]["settings"]
    assert (setting.knob, setting.label) == ("contact.clustering", "octree of 2 mm")
    assert list(Path().iterdir()) == []


def test_a_budget_is_held_by_a_scene_file(invoke, sample, fresh_runs):
    result = invoke("cup_spoon", "--budget-us", 280, "--json", "choice.json")
    assert result.exit_code == 0, result.output
    text = " ".join(result.stdout.split())
    assert "cup_spoon holds 280 µs with what follows: p99 260 µs a tick" in text
    assert "given up: contact.tolerance_m from 0.0005 to 0.0002 (0.2 mm)" in text
    assert "Wrote cup_spoon-280-us.yaml: drake-haptics run cup_spoon-280-us.yaml" in (
        text
    )
    assert load_scene("cup_spoon-280-us.yaml").contact.tolerance_m == 2e-4
    assert Path("cup_spoon-280-us.yaml").read_text().startswith("# cup_spoon holds 280")
    data = json.loads(Path("choice.json").read_text())
    assert data["holds"] and data["p99_us"] == 260.0
    assert not Path("cup_spoon-accuracy.html").exists()


def test_an_impossible_budget_is_told_with_status_3(invoke, sample, fresh_runs):
    result = invoke("cup_spoon", "--budget-us", 1.5)
    assert result.exit_code == 3
    text = " ".join(result.stdout.split())
    assert "Nothing that may be given up makes cup_spoon hold 1.5 µs: the fastest" in (
        text
    )
    assert "has a p99 of 260 µs" in text and "--explain" in text
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--out", "page.png"], "must not be called page.png"),
        (["--out", "nowhere/page.html"], "--out: there is no folder nowhere"),
        (["--only", "contact.depth"], "contact.depth: is not of the form KEY=VALUE"),
        (
            ["--only", "contact.deep=1"],
            "is not a key of a scene; did you mean 'contact.depth'",
        ),
        (["--only", "contact.tolerance_m=-1"], "contact.tolerance_m must not be neg"),
    ],
)
def test_a_mistake_is_one_line(invoke, arguments, words):
    result = invoke("hammer_block", *arguments)
    assert result.exit_code == 1
    (line,) = result.stderr.splitlines()
    assert line.startswith("Error: ") and words in line
    assert result.stdout == "" and list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--write", "x.yaml"], "--write needs --budget-us"),
        (["--budget-us", "9", "--out", "x.html"], "neither --out nor --only"),
        (["--budget-us", "9", *ONLY], "neither --out nor --only"),
        ([*ONLY, "--out", "x.html"], "--only writes no page"),
        (["--budget-us", "0"], "0.0 is not in the range x>0"),
    ],
)
def test_options_that_do_not_go_together(invoke, arguments, words):
    result = invoke("hammer_block", *arguments)
    assert result.exit_code == 2 and words in result.stderr


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (KeyboardInterrupt(), 130, "Stopped."),
        (RunError("stopped at 0.1 s: it diverged", None), 1, "Error: stopped at 0.1 s"),
    ],
)
def test_what_goes_wrong_is_told_in_a_line(invoke, monkeypatch, error, code, words):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(command, "run_accuracy_study", fail)
    result = invoke("hammer_block")
    assert result.exit_code == code
    (line,) = result.stderr.splitlines()
    assert line.startswith(words)


def test_one_setting_that_is_not_available_is_an_error(invoke):
    result = invoke("sphere_pen", "--quick", "--only", "tool.mesh=nope.obj")
    assert result.exit_code == 1 and result.stdout == ""
    assert "Error: --only: tool.mesh nope.obj: " in result.stderr
    assert "no such file" in result.stderr
