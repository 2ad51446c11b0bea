"""`drake-haptics devices` from end to end."""

import json
import re

from command_line import call, invoke

from drake_haptics.scene.device_preset import list_device_presets


def test_the_table_has_every_device_and_its_source():
    result = call("devices", check=True)
    rows = {
        line.split()[0]: line.split() for line in result.stdout.splitlines() if line
    }
    assert set(list_device_presets()) <= set(rows)
    assert (
        rows["phantom_premium_1_5_6dof"][1:] == "8.5 0.188 800 0.3 0.12 6 yes".split()
    )
    assert rows["omega_6"][1:] == "12 0 5000 0.075 3 no".split()
    assert "CPhantomDevices.cpp" in result.stdout
    # The table fits into a terminal of 80 columns.
    table = result.stdout.split("\n\n")[0]
    assert max(map(len, table.splitlines())) <= 80


def test_a_narrow_terminal_loses_no_figure(monkeypatch):
    whole = invoke("devices").stdout
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setenv("FORCE_COLOR", "1")  # taken for a terminal
    monkeypatch.setenv("NO_COLOR", "1")
    narrow = invoke("devices").stdout
    plain = re.sub(r"\x1b\[[0-9;]*m", "", narrow)
    assert "\x1b" in narrow and plain.split() == whole.split()


def test_json_has_the_figures_of_each():
    result = invoke("devices", "--json", "-")
    assert result.exit_code == 0, result.output
    devices = json.loads(result.output)
    assert set(devices) == set(list_device_presets())
    premium = devices["phantom_premium_1_5_6dof"]
    assert premium["has_twin"] and premium["motors"]["peak_torque_Nm"][0] == 1.716
    assert not devices["falcon"]["has_twin"]
    assert devices["falcon"]["max_force_N"] == 8.0


def test_json_goes_to_a_file_beside_the_table(tmp_path):
    path = tmp_path / "devices.json"
    result = invoke("devices", "--json", str(path))
    assert result.exit_code == 0 and "omega_6" in result.output
    assert "omega_6" in json.loads(path.read_text())
