"""`drake-haptics paper`, as a person calls it."""

import json

import pytest
from command_line import invoke
from paper_samples import make_evaluation

from drake_haptics.cli import paper as command


@pytest.fixture(scope="module")
def called(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    page, data = folder / "here.html", folder / "here.json"
    arguments = ["--quick", "--out", str(page), "--json", str(data), "table1"]
    result = invoke("paper", *arguments, "figure12")
    assert result.exit_code == 0, result.output
    return result, page, json.loads(data.read_text())


def test_it_says_where_we_agree_and_differ(called):
    result, page, _ = called
    assert "Table 1: convex pieces" in result.output
    assert "Torus (own shape) 54 for 67" in result.output
    assert "--meshes FOLDER" in result.output  # how to have the armadillo
    assert "Distance on a sphere of 1,280 triangles" in result.output
    assert str(page.name) in result.output.replace("\n", "")


def test_only_the_parts_named_are_made(called):
    _, page, data = called
    assert len(data["table1"]) == 6
    assert data["figure11"] == [] and data["analysis"] is None
    text = page.read_text(encoding="utf-8")
    assert 'id="table1"' in text and 'id="figure12"' in text
    assert 'id="figure11"' not in text
    beside = sorted(path.name for path in page.parent.glob("*.png"))
    assert beside == [
        "here-figure12-1280-triangles.png",
        "here-figure12-20480-triangles.png",
    ]


def test_a_folder_without_any_of_the_meshes_is_told(tmp_path):
    arguments = ["--quick", "--meshes", str(tmp_path), "table1"]
    result = invoke("paper", *arguments)
    assert result.exit_code == 1
    assert f"Error: the folder {tmp_path} has none of torus_2000.obj" in result.stderr


def test_json_on_stdout_is_alone(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "evaluate_paper", lambda *_: make_evaluation())
    arguments = ["--json", "-", "--out", str(tmp_path / "p.html"), "table1"]
    result = invoke("paper", *arguments)
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["table1"][0]["model"] == "Torus"


def test_a_wrong_call_is_refused_before_anything_is_measured(tmp_path):
    nowhere = str(tmp_path / "no" / "p.html")
    result = invoke("paper", "--out", nowhere)
    assert result.exit_code == 1 and "there is no folder" in result.output
    result = invoke("paper", "figure13")
    assert result.exit_code == 2 and "figure13" in result.output
