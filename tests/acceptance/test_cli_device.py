"""`drake-haptics device` from end to end, where nobody is at the other end."""

import json
import re
import socket

import command_line

from drake_haptics.scene.library import find_scene


def invoke(*arguments):
    """Runs the command in this process."""
    return command_line.invoke("device", *arguments)


def test_it_says_what_to_type_and_what_it_did():
    result = invoke("torus_peg", "--port", 0, "--duration", 0.2)
    assert result.exit_code == 0, result.output
    said = result.stdout
    assert re.search(
        r"drake-haptics run torus_peg --device udp://127\.0\.0\.1:\d+\n", said
    )
    assert "force 0.00 of 8.5 N" in said
    assert re.search(r"faults +none", said)


def test_json_is_alone_on_stdout_and_the_rate_is_as_asked():
    result = invoke("--port", 0, "--duration", 0.4, "--rate", 250, "--json", "-")
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)
    assert figures["rate_hz"] == 250.0
    # Late ticks are skipped and never made up for.
    assert 1 < figures["ticks"] <= 0.4 * 250 + 2
    assert figures["force_limit_N"] == 8.5
    assert figures["packets"] == {}


def test_a_port_that_is_taken_is_told_with_what_to_do():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        port = other.getsockname()[1]
        result = invoke("--port", port, "--duration", 0.1)
    assert result.exit_code == 1
    assert result.stderr.startswith(f"Error: port {port} is taken")
    assert "choose another (0: any free one)" in result.stderr


def test_a_scene_that_is_none_is_told_with_those_there_are():
    result = invoke("no_such_scene", "--duration", 0.1)
    assert result.exit_code == 1
    assert "cup_spoon" in result.stderr


def test_a_device_without_a_model_is_told_to_be_no_simulation(tmp_path):
    shipped = find_scene("cup_spoon")
    scene = tmp_path / "scene.yaml"
    text = shipped.read_text().replace("../meshes", f"{shipped.parents[1]}/meshes")
    scene.write_text(f"{text}\ndevice: {{preset: omega_6}}\n")
    result = invoke(scene, "--port", 0, "--duration", 0.1)
    assert result.exit_code == 1
    assert "cannot be simulated" in result.stderr
