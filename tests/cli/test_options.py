"""Files that commands write are neither their inputs nor one another."""

import shutil

import pytest
from command_line import invoke

from drake_haptics.scene.library import find_mesh, find_scene

RUN = ["run", "scene.yaml", "--headless", "--duration", "0.002"]
MESHES = ["run", "--tool", "pen.obj", "--environment", "ball.obj", *RUN[2:]]


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    """Is the folder of work, with a scene, its meshes, a log and a link."""
    folder = tmp_path_factory.mktemp("work")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for copy in ("pen.obj", "other.obj"):
            shutil.copy(find_mesh("pen"), copy)
        shutil.copy(find_mesh("sphere"), "ball.obj")
        scene = find_scene("sphere_pen").read_text()
        scene = scene.replace("../meshes/pen.obj", "pen.obj")
        (folder / "scene.yaml").write_text(
            scene.replace("../meshes/sphere.obj", "ball.obj")
        )
        (folder / "link").symlink_to("scene.yaml")
        assert invoke(*RUN, "--log", "run.tick").exit_code == 0
        shutil.copy("run.tick", "run.csv")
        yield folder


@pytest.mark.parametrize(
    ("arguments", "option", "file"),
    [
        ([*RUN, "--json", "scene.yaml"], "--json", "scene.yaml"),
        ([*RUN, "--write-scene", "scene.yaml"], "--write-scene", "scene.yaml"),
        ([*RUN, "--json", "pen.obj"], "--json", "pen.obj"),
        ([*RUN, "--log", "./ball.obj"], "--log", "ball.obj"),
        ([*RUN, "--record", "link"], "--record", "link"),
        ([*MESHES, "--json", "pen.obj"], "--json", "pen.obj"),
        (
            [*RUN, "--set", "tool.mesh=other.obj", "--json", "other.obj"],
            "--json",
            "other.obj",
        ),
        (
            [*RUN, "--device", "replay:./run.tick", "--log", "run.tick"],
            "--log",
            "run.tick",
        ),
        (["check", "pen.obj", "--json", "pen.obj"], "--json", "pen.obj"),
        (["decompose", "pen.obj", "--out", "pen.obj"], "--out", "pen.obj"),
        (["stability", "scene.yaml", "--json", "scene.yaml"], "--json", "scene.yaml"),
        (
            ["accuracy", "scene.yaml", "--budget-us", "9", "--write", "scene.yaml"],
            "--write",
            "scene.yaml",
        ),
        (["log", "info", "run.tick", "--json", "run.tick"], "--json", "run.tick"),
        (["log", "replay", "run.tick", "--json", "pen.obj"], "--json", "pen.obj"),
        (
            ["log", "replay", "run.tick", "scene.yaml", "--json", "scene.yaml"],
            "--json",
            "scene.yaml",
        ),
        (
            ["log", "diff", "run.tick", "run.csv", "--plot", "run.csv"],
            "--plot",
            "run.csv",
        ),
        (["log", "csv", "run.csv"], "--out", "run.csv"),
    ],
)
def test_an_input_is_not_overwritten(folder, arguments, option, file):
    before = {path: path.read_bytes() for path in folder.iterdir()}
    result = invoke(*arguments)
    assert result.exit_code == 1
    assert (
        result.stderr
        == f"Error: {option}: {file} is an input of this command; give another file\n"
    )
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize(
    ("arguments", "options"),
    [
        ([*RUN, "--json", "a", "--log", "./a"], "--json and --log"),
        (["decompose", "pen.obj", "--out", "a", "--json", "a"], "--out and --json"),
        (["stability", "scene.yaml", "--json", "a", "--store", "a"], "--json and"),
    ],
)
def test_no_two_options_write_one_file(folder, arguments, options):
    result = invoke(*arguments)
    assert result.exit_code == 1
    assert options in result.stderr and "each needs its own file" in result.stderr
    assert not (folder / "a").exists()


@pytest.mark.parametrize(
    ("arguments", "option"),
    [
        ([*RUN, "--log", "-"], "--log"),
        (["decompose", "pen.obj", "--html", "-"], "--html"),
    ],
)
def test_what_cannot_go_to_stdout_is_not_written_to_a_file_of_that_name(
    folder, arguments, option
):
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert f"'{option}': cannot go to stdout: name a file." in result.stderr
    assert not (folder / "-").exists()


def test_an_earlier_output_is_written_anew():
    for _ in range(2):
        assert invoke(*RUN, "--json", "a.json", "--log", "a.tick").exit_code == 0
