"""Everyday failures, each tried: one message that helps, and nothing broken after."""

import json
import os
import subprocess
import sys
from importlib.metadata import PackageNotFoundError

import pytest
import trimesh
from command_line import invoke

from drake_haptics.cli import options
from drake_haptics.geometry.decomposition import approximate as coacd_backend
from drake_haptics.geometry.decomposition import decompose as decomposition
from drake_haptics.scene.library import list_scenes

SCENE = """\
tool: {mesh: tool.obj}
environment: [{name: block, mesh: block.obj}]
hand: {path: {waypoints: [{position_m: [0, 0, 0.061]}]}}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Is the folder of work, with meshes, a scene and a cache of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))
    trimesh.creation.box([0.02, 0.02, 0.02]).export("tool.obj")
    trimesh.creation.box([0.1, 0.1, 0.1]).export("block.obj")
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path


def run_scene(*options):
    return invoke("run", "scene.yaml", "--headless", "--duration", 0.005, *options)


def fails(result, *words, code=1):
    assert result.exit_code == code, result.output
    (line,) = result.stderr.splitlines()
    assert line.startswith("Error: ") and all(word in line for word in words), line
    return True


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
MESHES = {
    "empty.obj": ("", "is empty (0 bytes)"),
    "cloud.obj": (TRIANGLE, "point clouds and curves have no surface"),
    "nan.obj": (TRIANGLE.replace("1 0 0", "nan 0 0") + "f 1 2 3\n", "NaN or infinite"),
    "cut.obj": (TRIANGLE + "f 1 2 9\n", "cannot be read"),
    "picture.jpg": ("x", "trimesh reads no format .jpg"),
    "cut.stl": ("solid cup\nfacet nor", "is cut off: a text STL"),
    "text.stl": (TRIANGLE + "f 1 2 3\n", "is a text file, not an STL"),
}


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("command", ["check", "run"])
def test_a_mesh_file_that_is_none(folder, name, command):
    text, words = MESHES[name]
    (folder / name).write_text(text)
    if command == "check":
        assert fails(invoke("check", name), name, words)
    else:
        options = ["--environment", "block.obj", "--headless"]
        assert fails(invoke("run", "--tool", name, *options), name, words)


def test_a_folder_and_a_file_that_is_not_there(folder):
    (folder / "parts.obj").mkdir()
    assert fails(invoke("check", "parts.obj"), "is a folder")
    assert fails(
        invoke("check", "blok.obj"),
        "no such file",
        str(folder),
        "did you mean 'block.obj'",
    )
    assert fails(invoke("check", "no/block.obj"), "there is no folder no")


def test_one_triangle_and_a_missing_material_will_do(folder):
    (folder / "one.obj").write_text(TRIANGLE + "f 1 2 3\n")
    assert "open surface" in invoke("check", "one.obj").stdout
    text = (folder / "block.obj").read_text()
    (folder / "red.obj").write_text(f"mtllib no.mtl\nusemtl red\n{text}")
    result = invoke("check", "red.obj")
    assert (result.exit_code, result.stderr) == (0, "")
    assert "one solid" in result.stdout


def test_millimeters_are_asked_for_by_every_command(folder):
    big = trimesh.creation.box([200.0, 150.0, 100.0])
    big.export("big.obj")
    for command in ("check", "decompose"):
        result = invoke(command, "big.obj")
        assert result.exit_code == 0, result.output
        assert "200 m is large" in result.stdout and "unit mm" in result.stdout
        assert "large" not in invoke(command, "big.obj", "--unit", "mm").stdout
    (folder / "scene.yaml").write_text(SCENE.replace("block.obj", "big.obj"))
    result = run_scene()
    assert result.exit_code == 0, result.output
    (line,) = [x for x in result.stderr.splitlines() if "big.obj" in x]
    assert line.startswith("Warning: ") and "environment[0].scale: 0.001" in line
    assert ": --environment-scale 0.001)" in line
    # A tool of that size fits into no workspace.
    pair = ["--tool", "big.obj", "--environment", "block.obj", "--headless"]
    assert fails(invoke("run", *pair), "200 m long", "--tool-scale 0.001")


def test_a_scene_with_nothing_in_reach_is_asked_about(folder):
    (folder / "scene.yaml").write_text(SCENE.replace("0.061", "0.5"))
    result = run_scene()
    assert result.exit_code == 0
    (line,) = result.stderr.splitlines()
    assert line.startswith("Warning: no object is within reach")
    (folder / "scene.yaml").write_text(SCENE)
    assert run_scene().stderr == ""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("tool: {mesh", "tool:\n\tmesh: {mesh", ["indent with spaces", "line 2"]),
        ("{name", "name", ["cannot be read as YAML"]),
        ("[{name: block, mesh: block.obj}]", "block.obj", ["environment: expected a"]),
        ("tool.obj", "[1, 2]", ["tool.mesh: expected text, found [1, 2]"]),
        ("mesh: tool.obj", "mesh: tool.obj, mas_kg: 1", ["did you mean 'mass_kg'?"]),
        ("tool.obj", "tol.obj", ["tool.mesh", "no such file", "'tool.obj'"]),
        ("hand:", "device: {preset: omega_7}\nhand:", ["did you mean 'omega_6'?"]),
        (SCENE, "- 1\n- 2\n", ["expected keys, found [1, 2]"]),
        (SCENE, "", ["expected keys, found nothing"]),
    ],
)
def test_a_scene_file_that_is_none(folder, old, new, words):
    (folder / "scene.yaml").write_text(SCENE.replace(old, new))
    assert fails(run_scene(), *words)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ("cup_spon", ["did you mean 'cup_spoon'?", *list_scenes()]),
        ("sceme.yaml", ["no such file", "did you mean 'scene.yaml'?"]),
        ("tool.obj", ["is a mesh, not a scene", "--tool"]),
        ("plant.py", ["is a program, not a scene", "docs/stability.md"]),
    ],
)
def test_a_scene_that_is_not_there(scene, words):
    for command in ("run", "stability", "accuracy", "device"):
        assert fails(invoke(command, scene), *words)


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("mose:", ["did you mean 'mouse:'?"]),
        ("udp://127.0.0.1", ["give host and port, like udp://127.0.0.1:7400"]),
        ("udp://127.0.0.1:99999", ["Port out of range"]),
        ("haply://127.0.0.1:1", ["Start Haply's Inverse Service"]),
        ("replay:no.tick", ["no.tick"]),
        ("mouse:", ["omit --headless"]),
    ],
)
def test_a_device_of_nobody(address, words):
    assert fails(run_scene("--device", address), *words)


def test_an_extra_that_is_missing_is_named(monkeypatch):
    def miss(name):
        raise PackageNotFoundError(name)

    monkeypatch.setattr(coacd_backend, "version", miss)
    result = invoke("decompose", "block.obj", "--method", "coacd")
    assert fails(result, "pip install 'drake_haptics[coacd]'")


# Nobody can make a file there, root neither, though root may do everything.
UNWRITABLE = "/proc/x.out"


def test_the_file_of_decompose_is_named_as_that_of_other_commands():
    result = invoke("decompose", "block.obj", "--output", "out.npz")
    assert result.exit_code == 2
    assert "--output" in result.stderr and "--out" in result.stderr.split("mean")[1]


@pytest.mark.parametrize("name", [UNWRITABLE, 300 * "x"])
@pytest.mark.parametrize("option", ["--json", "--out", "--html"])
def test_nothing_is_computed_for_a_file_that_cannot_be_written(option, name):
    result = invoke("decompose", "block.obj", option, name)
    assert fails(result, f"{option}: {name} cannot be written")
    assert result.stdout == ""


@pytest.mark.parametrize("option", ["--json", "--log", "--record", "--write-scene"])
def test_nothing_runs_for_a_file_that_cannot_be_written(monkeypatch, option):
    monkeypatch.setattr(
        "drake_haptics.cli.run_scene.run_session", lambda *_, **__: pytest.fail("ran")
    )
    assert fails(run_scene(option, UNWRITABLE), f"{option}: {UNWRITABLE} cannot be")


def test_that_a_file_can_be_written_is_asked_without_a_trace(folder):
    (folder / "old.json").write_text("old")
    (folder / "link.json").symlink_to(folder / "linked.json")
    for name in ("old.json", "new.json", "link.json"):
        options.require_writable(folder / name, "--json")
    assert (folder / "old.json").read_text() == "old"
    assert not (folder / "new.json").exists()
    assert (folder / "link.json").is_symlink() and not (folder / "linked.json").exists()


def test_a_device_file_is_written_and_not_replaced():
    result = invoke("decompose", "block.obj", "--out", "/dev/full")
    assert fails(result, "No space left")
    assert not os.path.isfile("/dev/full")


def test_an_interrupted_decomposition_leaves_nothing_and_begins_again(
    folder, monkeypatch
):
    real = decomposition._core.decompose_surface

    def interrupt(V, F, solid, step):
        real(V, F, solid, step)
        raise KeyboardInterrupt

    monkeypatch.setattr(decomposition._core, "decompose_surface", interrupt)
    result = invoke("decompose", "block.obj", "--out", "out.npz")
    assert (result.exit_code, result.stderr) == (130, "Stopped.\n")
    (entry,) = (folder / "cache").iterdir()
    assert entry.name.startswith("triangles") and not (folder / "out.npz").exists()
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(folder / "cache"))
    again = invoke("decompose", "block.obj", "--out", "out.npz")
    assert again.exit_code == 0 and "found in" in again.stdout
    assert (folder / "out.npz").is_file()


def test_a_decomposition_killed_as_it_is_kept_leaves_no_half_entry(folder):
    program = (
        "import os\n"
        "from drake_haptics.cli import main\n"
        "os.replace = lambda *_: os.kill(os.getpid(), 9)\n"
        "main(['decompose', 'block.obj'])\n"
    )
    assert invoke("check", "block.obj").exit_code == 0
    (triangles,) = (folder / "cache").iterdir()
    killed = subprocess.run([sys.executable, "-c", program], capture_output=True)
    assert killed.returncode == -9
    assert list((folder / "cache").glob("*.npz")) == [triangles]
    again = invoke("decompose", "block.obj", "--json", "-")
    assert json.loads(again.stdout)["from_cache"] is False
    assert json.loads(invoke("decompose", "block.obj", "--json", "-").stdout)[
        "from_cache"
    ]


def test_a_cache_that_is_not_available_costs_only_time(folder, monkeypatch):
    (folder / "cache").touch()
    result = run_scene()
    assert result.exit_code == 0
    (line,) = result.stderr.splitlines()  # once, and not for each mesh
    assert "cut" in line and "DRAKE_HAPTICS_CACHE" in line


@pytest.mark.parametrize("number", ["nan", "inf", "-1", "x"])
def test_numbers_that_are_none_are_a_wrong_call(number):
    result = invoke("run", "scene.yaml", "--headless", "--duration", number)
    assert result.exit_code == 2 and "--duration" in result.stderr


@pytest.mark.parametrize(
    "command",
    [["run", "--headless"], ["stability"], ["device"], ["accuracy", "--quick"]],
)
def test_a_scene_that_cannot_be_built_is_named(command, folder):
    (folder / "far.yaml").write_text(SCENE.replace("}]}}", ", rpy_deg: [0, 0, 0]},"
        " {time_s: 1, position_m: [9, 0, 0]}]}}"))  # fmt: skip
    assert fails(invoke(command[0], "far.yaml", *command[1:]), "Error: far: hand.path:")
