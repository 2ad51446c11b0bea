"""`drake-haptics run` and `scenes` from end to end."""

import json
import os
import re
import signal
import socket
import subprocess
from pathlib import Path

import pytest
import websocket
from command_line import COMMAND, call, invoke
from energy_rig import assert_nothing_is_created
from shapes import SHAPES

from drake_haptics.cli import run_scene, run_session
from drake_haptics.scene.library import list_scenes
from drake_haptics.simulation.run import RunError
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.web import link

SCENES = [
    "can_box",
    "cup_spoon",
    "hammer_block",
    "nut_on_bolt",
    "peg_in_hole",
    "rubbed_sphere",
    "sphere_pen",
    "torus_peg",
]
# Energy beyond what sampling explains, of what goes in, at the contact and at the
# device, of the scenes by the penalty law.
MADE = {
    "can_box": (0.0055, 0.0001),
    "cup_spoon": (0.0356, 0.0012),
    "hammer_block": (0.0228, 0.0004),
    "rubbed_sphere": (0.1720, 0.0001),
    "sphere_pen": (0.0437, 0.0001),
    "torus_peg": (0.0358, 0.0006),
}


def run_json(folder, *arguments):
    """Runs the command line in this process and returns what it wrote as JSON."""
    file = folder / "figures.json"
    result = invoke(*arguments, "--json", file)
    assert result.exit_code == 0, result.output
    return file.read_text()


@pytest.fixture(scope="module", params=SCENES)
def stats(request, tmp_path_factory):
    """The figures of a whole cycle of a shipped scene."""
    file = tmp_path_factory.mktemp(request.param) / "s.json"
    result = invoke("run", request.param, "--headless", "--duration", 5, "--json", file)
    assert result.exit_code == 0, result.output
    assert "Warning" not in result.stderr
    return json.loads(file.read_text())


def test_a_run_has_all_its_figures(stats):
    assert stats["ticks"] == 5000
    for key in ("tick_us", "contact_query_us"):
        times = stats[key]
        assert 0 < times["median"] <= times["p99"] <= times["p99_9"]
    assert stats["contact_query_us"]["median"] < stats["tick_us"]["median"]
    assert stats["clusters"]["max"] <= stats["contacts"]["max"]


def test_every_scene_presses_and_stays_within_the_device(stats):
    assert stats["contacts"]["max"] >= 1
    assert 0.5 < stats["max_force_N"] < 8.5
    assert 0.0 < stats["max_torque_Nm"] < 0.188
    assert stats["limit_hits"] == 0
    assert stats["non_finite_events"] == 0


def test_a_run_tells_where_its_energy_went(stats):
    books = stats["energy_J"]
    assert list(books)[:5] == ["device", "display", "coupling", "tool", "contact"]
    assert books["device"]["in"] > books["device"]["out"] > 0.0
    assert books["contact"]["in"] > 0.0


def test_what_a_scene_creates_is_the_contact_s(request, stats):
    """A known gap: depth and center of a flush contact are of different points.

    Its wrench is then not quite the gradient of what it stores. All else balances. What
    is made was measured, and may be a tenth more; see the page on numerics. The
    constraint law has no such gap.
    """
    books = dict(stats["energy_J"])
    contact, device = books.pop("contact"), books.pop("device")
    assert_nothing_is_created(books)
    scene = request.node.callspec.params["stats"]
    if scene not in MADE:
        assert contact["beyond"] + device["beyond"] < 1e-6
        return
    at_contact, at_device = MADE[scene]
    assert contact["beyond"] < 1.1 * at_contact * contact["in"]
    assert device["beyond"] < 1.1 * at_device * device["in"]


def test_the_page_tells_what_scenes_create():
    page = Path(__file__).parents[2] / "docs" / "verification" / "numerics.md"
    text = " ".join(page.read_text("utf-8").split())
    for scene, (at_contact, _) in MADE.items():
        assert f"{100 * at_contact:.0f} % (`{scene}`)" in text
    most = max(at_device for _, at_device in MADE.values())
    assert f"At the device at most {100 * most:.1f} %" in text


def test_scenes_penetrate_lightly_that_are_to_show_it_and_no_other(request, stats):
    scene = request.node.callspec.params["stats"]
    if scene in ("can_box", "rubbed_sphere"):
        assert 0.0 < stats["max_penetration_m"] < 1e-3
    else:
        assert stats["max_penetration_m"] == 0.0
    if stats["contact_law"] == "constraint":
        assert stats["least_distance_m"] == pytest.approx(8e-5, rel=0.1)


def test_scenes_lists_every_scene_with_its_description():
    result = invoke("scenes")
    assert result.exit_code == 0
    assert sorted(list_scenes()) == SCENES
    for name in SCENES:
        assert name in result.output
    assert "scrapes" in result.output


def test_ones_own_meshes(tmp_path):
    for name in ("pen", "torus"):
        surface = SHAPES[name]()
        surface.write_obj(tmp_path / f"{name}.obj", name)
    result = invoke(
        "run", "--tool", tmp_path / "pen.obj", "--environment", tmp_path / "torus.obj",
        "--headless", "--duration", 3, "--json", tmp_path / "s.json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    stats = json.loads((tmp_path / "s.json").read_text())
    assert stats["contacts"]["max"] >= 1
    assert stats["non_finite_events"] == 0


def test_scale_is_applied(tmp_path):
    # The same run in millimeters.
    largest = []
    for factor, options in [
        (1, []),
        (1000, ["--unit", "mm"]),
        (1000, ["--unit", "km", "--tool-scale", 1e-3, "--environment-scale", 1e-3]),
    ]:
        for name in ("pen", "sphere"):
            surface = SHAPES[name]()
            scaled = type(surface)(factor * surface.vertices, surface.triangles)
            scaled.write_obj(tmp_path / f"{name}.obj", name)
        result = invoke(
            "run", "--tool", tmp_path / "pen.obj", "--environment",
            tmp_path / "sphere.obj", "--headless", "--duration", 2.5, "--json",
            tmp_path / "s.json", *options,
        )  # fmt: skip
        assert result.exit_code == 0, result.output
        largest.append(json.loads((tmp_path / "s.json").read_text())["max_force_N"])
    assert largest[0] > 0.1
    assert largest[1:] == pytest.approx(2 * [largest[0]], rel=1e-3)


def test_explain_says_what_is_there_and_why_and_what_it_takes():
    process = call("run", "rubbed_sphere", "--explain", "--json", "-")
    assert process.returncode == 0, process.stderr
    figures = json.loads(process.stdout)
    # Without a duration it is over by itself, and it needs no page.
    assert figures["ticks"] == 2000
    assert "http" not in process.stderr
    parts = {part["name"]: part for part in figures["parts"]}
    assert {name for name, part in parts.items() if "effects." in part["why"]} == {
        "contact_chain",  # with shading
        "stick_slip_friction",
        "pre_contact_braking",
        "tool_gravity",
        "passivity_control",
    }
    assert sum(part["share"] for part in parts.values()) == pytest.approx(1.0)
    assert all(part["mean_us"] > 0.0 for part in parts.values())
    for word in [*parts, "effects.friction", "whole tick", "100.0 %"]:
        assert word in process.stderr


def test_a_scene_without_effects_has_none_of_them(tmp_path):
    file = tmp_path / "s.json"
    result = invoke("run", "sphere_pen", "--explain", "--duration", 0.2, "--json", file)
    assert result.exit_code == 0, result.output
    figures = json.loads(file.read_text())
    assert figures["ticks"] == 200
    assert [part["name"] for part in figures["parts"]] == [
        "rendered_force_hold",
        "simulated_arm",
        "contact_chain",
        "Drake and the rest",
    ]
    assert "effects" not in result.output
    assert "parts" not in json.loads(
        run_json(tmp_path, "run", "sphere_pen", "--headless", "--duration", 0.2)
    )


def test_a_coupling_that_breaks_a_bound_is_warned_of_in_a_line(tmp_path):
    file = tmp_path / "light.yaml"
    text = list_scenes()["sphere_pen"].read_text()
    meshes = list_scenes()["sphere_pen"].parents[1] / "meshes"
    text = text.replace("../meshes", str(meshes)).replace("grip: firm", "grip: light")
    file.write_text(text)
    result = invoke("run", file, "--headless", "--duration", 0.05)
    assert result.exit_code == 0, result.output
    (line,) = [x for x in result.stderr.splitlines() if x.startswith("Warning: ")]
    assert "coupling.damping_Ns_per_m is 2: not passive" in line
    assert "Colgate" in line and "SceneWarning" not in result.output


def test_a_port_that_another_program_has_is_named_with_the_address(monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        for module in (link, run_scene):
            monkeypatch.setattr(module, "FIRST_PORT", port)
        result = invoke("run", "sphere_pen", "--duration", 0.05)
    assert result.exit_code == 0, result.output
    (line,) = [x for x in result.stdout.splitlines() if x.startswith("Open ")]
    assert f"Port {port} is taken" in line and f"localhost:{port}/" not in line


def test_json_to_stdout_is_alone():
    options = ["--headless", "--duration", "0.1", "--json", "-"]
    result = invoke("run", "sphere_pen", *options)
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["ticks"] == 100


def test_ctrl_c_ends_a_run_with_its_figures(tmp_path):
    file = tmp_path / "s.json"
    process = subprocess.Popen(
        [COMMAND, "run", "cup_spoon", "--json", file],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    first = process.stdout.readline()
    wait_for_run(re.search(r"http(://localhost:\d+/)", first)[1])
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=120)
    assert process.returncode == 0, rest
    assert "INFO" not in first + rest and "Traceback" not in rest
    assert json.loads(file.read_text())["ticks"] > 100


def wait_for_run(address):
    """Waits until the page of a run has seen a fifth of a second of it."""
    page = websocket.create_connection(f"ws{address}", timeout=120)
    while json.loads(page.recv()).get("frame", {}).get("time_s", 0.0) < 0.2:
        pass
    page.close()


def test_a_recording_is_one_file_and_does_not_name_a_server(tmp_path):
    file = tmp_path / "out.html"
    result = invoke(
        "run", "sphere_pen", "--headless", "--duration", 0.3, "--record", file
    )
    assert result.exit_code == 0, result.output
    page = file.read_text()
    assert "penetrating" in page
    assert 'src="http' not in page and "<script src=" not in page


def test_pieces_are_colored_in_a_recording(tmp_path):
    sizes = []
    for option in ([], ["--pieces"]):
        file = tmp_path / "out.html"
        result = invoke(
            "run",
            "sphere_pen",
            "--headless",
            "--duration",
            0.1,
            "--record",
            file,
            *option,
        )
        assert result.exit_code == 0, result.output
        sizes.append(len(file.read_text()))
    assert sizes[1] > sizes[0]


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["run"], 2, ["SCENE"]),
        (["run", "--tool", "a.obj"], 2, ["--environment"]),
        (["run", "cup_spoon", "--tool", "a.obj"], 2, ["either"]),
        (["run", "cup_spoon", "--unit", "mm"], 2, ["either"]),
        (
            ["run", "--tool", "a.obj", "--environment", "a.obj", "--unit", "yard"],
            2,
            ["yard", "mm"],
        ),
        (["run", "--tool", "no.obj", "--environment", "no.obj"], 1, ["no.obj"]),
        (["run", "cup_spoon", "--headless", "--port", "7001"], 2, ["--port"]),
        (["run", "cup_spoon", "--explain", "--pieces"], 2, ["--explain", "--pieces"]),
        (
            ["run", "cup_spoon", "--headless", "--json", "no.one", "--log", "no.one"],
            1,
            ["its own file"],
        ),
    ],
)  # fmt: skip
def test_errors_are_for_people(arguments, code, words):
    result = invoke(*arguments)
    assert result.exit_code == code, result.output
    for word in words:
        assert word in result.output
    assert "Traceback" not in result.output


def test_a_device_that_does_not_answer_is_told_with_its_address():
    address = "udp://127.0.0.1:9"
    result = invoke("run", "sphere_pen", "--headless", "--device", address)
    assert result.exit_code == 1
    assert f"Error: {address}: the device has sent nothing" in result.output


def test_a_port_in_use_is_said_with_the_option():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = invoke("run", "sphere_pen", "--duration", 0.1, "--port", port)
    assert result.exit_code == 1
    assert f"port {port} cannot be used" in result.stderr
    assert "--port" in result.stderr


def test_an_unstable_run_ends_with_its_figures_and_a_status_of_its_own(
    tmp_path, monkeypatch
):
    statistics = RunStatistics(1e-3)

    def diverge(*args, **kwargs):
        raise RunError("the tool's pose is not finite", statistics)

    monkeypatch.setattr(run_session, "run", diverge)
    file = tmp_path / "s.json"
    result = invoke("run", "sphere_pen", "--headless", "--json", file)
    assert result.exit_code == 3
    assert "not finite" in result.output
    assert json.loads(file.read_text())["ticks"] == 0
