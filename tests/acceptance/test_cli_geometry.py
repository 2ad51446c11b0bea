"""`drake-haptics check` and `decompose`, as a user runs them."""

import json
import signal
import subprocess
import sys
import urllib.error
import urllib.request

import numpy as np
import pytest
from command_line import COMMAND, call, invoke
from mesh_samples import box, l_prism, real_mesh
from shapes import SHAPES

from drake_haptics.geometry.decomposition.decompose import Decomposition


@pytest.fixture
def environment(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_HAPTICS_CACHE", str(tmp_path / "cache"))


def fails_with_one_message(result, status, *words):
    assert result.exit_code == status and result.stdout == ""
    for word in words:
        assert word in result.stderr
    return True


@pytest.fixture
def l_file(tmp_path):
    V, F = l_prism()
    np.savez(tmp_path / "l.npz", V=V * 100, F=F)
    return tmp_path / "l.npz"


def test_check_reports_and_succeeds(l_file):
    result = call("check", l_file, "--unit", "mm")
    assert result.returncode == 0 and result.stderr == ""
    assert "200 mm x 200 mm x 100 mm" in result.stdout
    assert "one solid" in result.stdout


def test_check_writes_json(l_file, tmp_path):
    alone = invoke("check", l_file, "--scale", "0.001", "--json", "-")
    assert json.loads(alone.stdout)["volume_m3"] == pytest.approx(0.003)
    both = invoke("check", l_file, "--unit", "mm", "--json", tmp_path / "report.json")
    assert "one solid" in both.stdout
    report = json.loads((tmp_path / "report.json").read_text())
    assert report == json.loads(alone.stdout)


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["check", "L", "--unit", "x"], 2, "'--unit': 'x'"),
        (["check", "L", "--unit", "mm", "--scale", "1"], 2, "exclude each other"),
        (["check", "L", "--scale", "-1"], 2, "'--scale': -1"),
        (["check"], 2, "MESH"),
        (["decompose", "L", "--method", "cubes"], 2, "cubes"),
        (["check", "L", "--json", "absent/o.json"], 1, "--json: there is no folder"),
        (["decompose", "L", "--out", "absent/o.npz"], 1, "--out: there is no folder"),
    ],
)
def test_errors_of_the_user_are_one_message(l_file, words, code, says):
    result = invoke(*(l_file if word == "L" else word for word in words))
    assert fails_with_one_message(result, code, says)


def test_a_terminal_without_unicode_is_served(l_file, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    result = call("check", l_file, "--unit", "mm")
    assert result.returncode == 0 and "0.14 m?" in result.stdout


def test_strict_fails_after_the_report(tmp_path):
    V, F = box()
    np.savez(tmp_path / "open.npz", V=V, F=F[1:])
    result = invoke("check", tmp_path / "open.npz", "--strict")
    assert result.exit_code == 1
    assert "open edges" in result.stdout and "strict" in result.stderr


def test_decompose_writes_file_and_json_and_remembers(environment, l_file, tmp_path):
    out = tmp_path / "pieces.npz"
    first = call("decompose", l_file, "--unit", "mm", "--out", out, "--json", "-")
    assert first.returncode == 0, first.stderr
    data = json.loads(first.stdout)
    assert data["pieces"] > 1 and data["from_cache"] is False
    loaded = Decomposition.load(out)
    assert len(loaded.pieces) == data["pieces"]
    assert loaded.mesh.report.volume == pytest.approx(0.003)
    second = call("decompose", l_file, "--unit", "mm")
    assert "found earlier" in second.stdout
    assert f"{data['pieces']} pieces from 20 triangles" in second.stdout


def test_a_mesh_is_reduced_and_its_pieces_are_merged(environment, tmp_path):
    torus = tmp_path / "torus.npz"
    surface = SHAPES["torus"]()
    np.savez(torus, V=surface.vertices, F=surface.triangles)
    checked = invoke("check", torus, "--max-triangles", "500")
    assert "decimated from 2,000 to 500 triangles" in checked.stdout
    exact = invoke("decompose", torus, "--max-triangles", "500", "--json", "-")
    report = json.loads(exact.stdout)
    assert report["triangles"] == 500
    assert 0 < report["mesh"]["decimation_error_m"] < 2e-3
    options = ("--method", "merged", "--error", "1e-3")
    merged = invoke("decompose", torus, *options, "--json", "-")
    fewer = json.loads(merged.stdout)
    assert fewer["pieces"] <= 20 and 0 < fewer["departure_m"] <= 1e-3
    assert "µm of the mesh" in invoke("decompose", torus, *options).stdout
    wrong = invoke("decompose", torus, "--method", "merged")
    assert fails_with_one_message(wrong, 1, "merged needs an error_m", "--error")


def test_decompose_says_that_open_surfaces_are_one_sided(environment):
    result = invoke("decompose", real_mesh("fcl_rob.obj"), "--unit", "mm")
    assert result.exit_code == 0, result.stderr
    assert "one-sided" in result.stdout


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_decompose_shows_the_pieces_until_interrupted(environment, l_file, number):
    command = [COMMAND, "decompose", str(l_file), "--unit", "mm", "--show"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        line = process.stderr.readline()
        address = next(word for word in line.split() if word.startswith("http"))
        with urllib.request.urlopen(address, timeout=120) as page:
            assert page.status == 200
        told = process.stderr.readline()
        assert told.startswith("Left the pieces in their places; right")
        process.send_signal(number)
        assert process.wait(timeout=120) == 0
        assert "Traceback" not in process.stderr.read()
    # Meshcat's server ends with it.
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(address, timeout=120)


def test_drake_is_never_imported(environment, l_file):
    program = (
        "import sys\n"
        "from drake_haptics.cli import main\n"
        f"main(['check', {str(l_file)!r}], standalone_mode=False)\n"
        f"main(['decompose', {str(l_file)!r}], standalone_mode=False)\n"
        "assert 'pydrake' not in sys.modules\n"
        "assert 'drake_haptics.geometry.mesh.mesh' in sys.modules\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=180
    )
    assert result.returncode == 0, result.stderr


def test_help_lists_all_commands_without_importing_them():
    program = (
        "import sys\n"
        "from drake_haptics.cli import main\n"
        "main(['--help'], standalone_mode=False)\n"
        "assert not {'pydrake', 'numpy', 'trimesh'} & set(sys.modules)\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=180
    )
    assert result.returncode == 0, result.stderr
    for name in ("run", "scenes", "check", "decompose"):
        assert f"\n  {name} " in result.stdout
