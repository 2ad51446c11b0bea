"""`drake-haptics bench`, as a user runs it."""

import json

import pytest
from command_line import call, invoke


def test_scenes_are_measured_and_written(tmp_path):
    result = call("bench", "scenes", "--quick", "--json", tmp_path / "figures.json")
    assert result.returncode == 0
    # How far it is, where it takes longer than ten seconds.
    assert all(line.startswith("scenes: ") for line in result.stderr.splitlines())
    assert "spoon on cup" in result.stdout and "Scenes" in result.stdout
    assert "Convex pairs" not in result.stdout
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert figures["pairs"] == figures["python"] == []
    assert {s["scene"] for s in figures["scenes"]} >= {"spoon on cup", "peg in hole"}
    assert all(s["near"]["median_us"] > 0 for s in figures["scenes"])


def test_json_alone_goes_to_stdout():
    pytest.importorskip("coal")
    result = call("bench", "python", "--quick", "--json", "-")
    assert result.returncode == 0
    figures = json.loads(result.stdout)
    assert {p["size"] for p in figures["python"]} == {42, 2562}


def test_an_unknown_part_is_a_wrong_call():
    result = call("bench", "paris")
    assert result.returncode == 2 and "paris" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_folder_without_any_of_the_meshes_is_told_at_once(tmp_path):
    result = invoke("bench", "--meshes", str(tmp_path))
    assert result.exit_code == 1 and result.stdout == ""
    assert f"Error: the folder {tmp_path} has none of torus_2000.obj" in result.stderr
