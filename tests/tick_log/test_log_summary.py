"""The figures of a log."""

import dataclasses
import hashlib
import json
import math

import numpy as np
import pytest
from tick_log_samples import HEADER, make_part, make_rows, make_smooth_rows, write_log

from drake_haptics.tick_log.log_format import find_changed_meshes
from drake_haptics.tick_log.log_summary import summarize_log


def test_the_figures_are_those_of_the_ticks(tmp_path):
    rows = make_smooth_rows(500, amplitude=0.0)
    rows["device_time_s"][:] = math.nan
    rows["clock_s"][:] = 1e-3 * np.arange(500)
    rows["clock_s"][321:] += 0.025
    rows["F_Ho_W_commanded"][77] = [0.0, 0.3, 0.4, 2.0, 0.0, 0.0]
    rows["F_Ho_W_commanded"][400] = [0.0, 0.0, 0.0, 0.0, 3.0, -4.0]
    rows["distance_m"][:] = math.inf
    rows["distance_m"][9] = -2e-3
    rows["contacts"][:] = 0
    rows["contacts"][300] = 12
    rows["status"][:] = 0
    rows["status"][10:14] = 1
    rows["status"][20] = 2
    path = write_log(
        tmp_path / "log", [make_part(rows, 0, 256), make_part(rows, 256, 500)], end=500
    )
    summary = summarize_log(path)
    assert (summary.ticks, summary.gaps, summary.damaged_blocks) == (500, (), 0)
    assert summary.bytes == path.stat().st_size
    assert summary.max_force_N == pytest.approx(5.0)
    assert summary.max_torque_Nm == pytest.approx(0.5)
    assert summary.max_penetration_m == 2e-3
    assert summary.max_contacts == 12
    assert summary.limited_ticks == 4
    assert summary.longest_wait_s == pytest.approx(0.026)
    assert summary.end_s == rows["time_s"][-1]
    assert summary.is_simulated


def test_a_device_with_a_clock_is_real(tmp_path):
    rows = make_smooth_rows(4)
    rows["device_time_s"][:2] = math.nan
    assert not summarize_log(write_log(tmp_path / "log", [rows])).is_simulated


def test_any_bits_make_figures_that_are_json(tmp_path):
    path = write_log(tmp_path / "log", [make_rows(200), make_rows(3, first=250)])
    shares = []
    summary = summarize_log(path, lambda what, share: shares.append(share))
    data = json.loads(json.dumps(summary.to_dict(), allow_nan=False))
    assert data["ticks"] == 203
    assert len(data["gaps"]) == 2
    assert shares[-1] == 1.0


def test_a_log_without_a_tick_has_figures_too(tmp_path):
    assert summarize_log(write_log(tmp_path / "log", [])).ticks == 0


def test_meshes_that_changed_are_named(tmp_path):
    same, changed, gone = (str(tmp_path / name) for name in ("a.obj", "b.obj", "c.obj"))
    for path in (same, changed):
        with open(path, "w") as stream:
            stream.write("v 0 0 0\n")
    # What a forged log may name: nothing ever ends there.
    endless = "/dev/zero"
    digest = hashlib.sha256(b"v 0 0 0\n").hexdigest()
    header = dataclasses.replace(
        HEADER,
        mesh_sha256={
            same: digest,
            changed: "0" + digest[1:],
            gone: digest,
            endless: digest,
        },
    )
    assert find_changed_meshes(header) == [changed, gone, endless]
