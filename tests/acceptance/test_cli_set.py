"""`--set` and `--write-scene`: a scene is changed for once, and kept."""

import re
import shutil

import command_line
import pytest
import trimesh
from accuracy_samples import make_study

from drake_haptics import find_scene, load_scene, make_scene_for_meshes
from drake_haptics.cli import accuracy, stability
from drake_haptics.simulation.replay_log import load_log_scene
from drake_haptics.tick_log.tick_log import read_tick_log

SOFT = ["--set", "contact.stiffness_N_per_m=400"]
SHORT = ["--headless", "--duration", "0.01"]


@pytest.fixture
def invoke(monkeypatch, tmp_path):
    """Runs the command line in a folder with a pen, a torus and nothing else."""
    meshes = find_scene("cup_spoon").parents[1] / "meshes"
    for name in ("pen.obj", "torus.obj"):
        shutil.copy(meshes / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return command_line.invoke


def test_a_run_is_of_the_changed_scene_and_so_is_its_log(invoke, tmp_path):
    result = invoke(
        "run", "sphere_pen", *SHORT, *SOFT, "--set", "tool.mesh=torus.obj",
        "--log", "run.tick",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    scene = load_log_scene(read_tick_log("run.tick"))
    assert scene.contact.stiffness_N_per_m == 400.0
    assert scene.tool.mesh == str(tmp_path / "torus.obj")
    assert scene.environment == load_scene(find_scene("sphere_pen")).environment


def test_meshes_become_a_scene_file_to_go_on_from(invoke, tmp_path):
    meshes = ["--tool", "pen.obj", "--environment", "torus.obj"]
    result = invoke("run", *meshes, *SHORT, *SOFT, "--write-scene", "mine.yaml")
    assert result.exit_code == 0, result.output
    assert "Wrote mine.yaml: drake-haptics run mine.yaml\n" in result.output
    made = make_scene_for_meshes("pen.obj", "torus.obj")
    made.contact.stiffness_N_per_m = 400.0
    assert load_scene("mine.yaml") == made
    # A file that is named is not one that stands elsewhere, too.
    assert str(tmp_path) not in (tmp_path / "mine.yaml").read_text()
    assert invoke("run", "mine.yaml", *SHORT).exit_code == 0


def test_a_mesh_far_from_its_origin_is_centered_and_said_to_be(invoke, tmp_path):
    pen = trimesh.load("pen.obj")
    pen.apply_translation([0.4, 0.5, 0.1])
    pen.export("far.obj")
    meshes = ["--tool", "far.obj", "--environment", "torus.obj"]
    result = invoke("run", *meshes, *SHORT, "--write-scene", "mine.yaml")
    assert result.exit_code == 0, result.output
    assert "far.obj has its origin far beside the mesh: the tool is centered" in (
        result.stderr
    )
    assert "Warning" not in result.stderr
    assert "  center: true\n" in (tmp_path / "mine.yaml").read_text()
    near = invoke("run", "--tool", "pen.obj", *meshes[2:], *SHORT)
    assert "centered" not in near.output


def test_the_other_end_of_a_device_is_told_the_same_scene(invoke):
    result = invoke(
        "device", "torus_peg", "--port", "0", "--duration", "0.05",
        "--set", "device.max_force_N=3", "--set", "description=a pen",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert re.search(
        r"drake-haptics run torus_peg --set device\.max_force_N=3"
        r" --set 'description=a pen' --device udp://127\.0\.0\.1:\d+\n",
        result.output,
    )
    assert "of 3 N" in result.output


def test_stability_is_that_of_the_changed_scene(invoke, monkeypatch):
    asked = []

    def analyze(scene, *_, **__):
        asked.append(scene)
        raise ValueError("enough")

    monkeypatch.setattr(stability, "analyze_scene", analyze)
    assert invoke("stability", "sphere_pen", *SOFT).exit_code == 1
    assert asked[0].contact.stiffness_N_per_m == 400.0


def test_accuracy_is_that_of_the_changed_scene_and_its_page_says_so(
    invoke, monkeypatch, tmp_path
):
    asked = []

    def study(scene, *_, **__):
        asked.append(scene)
        return make_study()

    monkeypatch.setattr(accuracy, "run_accuracy_study", study)
    result = invoke("accuracy", "sphere_pen", "--quick", *SOFT)
    assert result.exit_code == 0, result.output
    assert asked[0].contact.stiffness_N_per_m == 400.0
    page = (tmp_path / "sphere_pen-accuracy.html").read_text()
    assert f"<code>drake-haptics accuracy sphere_pen {' '.join(SOFT)} --quick<" in page


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["sphere_pen", "--set", "contact.depht=x"], "did you mean 'contact.depth'"),
        (["sphere_pen", "--set", "tool.mesh=pin.obj"], "did you mean 'pen.obj'"),
        (["sphere_pen", "--set", "hand.grip"], "KEY=VALUE"),
        (
            ["--tool", "pen.obj", "--environment", "torus.obj", "--set", "tool.scale="],
            "give --tool-scale instead",
        ),
        *(
            (
                ["--tool", "pen.obj", "--environment", "torus.obj", "--set", f"{key}="],
                "give --environment instead",
            )
            for key in ("environment.mesh", "environment[0].mesh")
        ),
        (["copy.yaml", "--write-scene", "copy.yaml"], "is an input of this"),
        (["sphere_pen", "--write-scene", "a", "--log", "a"], "its own file"),
    ],
)  # fmt: skip
def test_what_cannot_be_set_is_told_with_what_to_do(invoke, arguments, words):
    shutil.copy(find_scene("sphere_pen"), "copy.yaml")
    result = invoke("run", *arguments, *SHORT)
    assert result.exit_code == 1
    assert result.output.startswith("Error: --") and words in result.output


def test_a_refusal_of_another_key_tells_what_was_set(invoke):
    result = invoke(
        "run", "sphere_pen", *SHORT, "--set", "environment.material.damping_Ns_per_m=3",
        "--write-scene", "mine.yaml",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    result = invoke("run", "mine.yaml", *SHORT, "--set", "contact.law=constraint")
    assert result.exit_code == 1
    assert result.stderr.startswith(
        "Error: --set contact.law=constraint:"
        " environment[0].material.damping_Ns_per_m does nothing under"
    )
