"""The table of a log: units in its head, every double back."""

import csv
import io

import numpy as np
from tick_log_samples import make_part, make_rows, make_smooth_rows, write_log

from drake_haptics.tick_log.csv_export import write_csv
from drake_haptics.tick_log.log_format import REALS
from drake_haptics.tick_log.tick_log import TickLogReader


def export(path, progress=None):
    stream = io.StringIO()
    write_csv(TickLogReader(path), stream, progress)
    return list(csv.reader(io.StringIO(stream.getvalue())))


def test_every_number_reads_back(tmp_path):
    rows = make_smooth_rows(300)
    rows["distance_m"][::2] = np.inf
    rows["device_time_s"][:] = np.nan
    rows["V_WH"][0, 0] = -0.0
    rows["V_WH"][1, 0] = 5e-324
    head, *lines = export(
        write_log(
            tmp_path / "log",
            [make_part(rows, 0, 200), make_part(rows, 200, 300)],
            end=300,
        )
    )
    assert len(lines) == 300
    assert [int(line[0]) for line in lines] == list(range(300))
    reals = np.array([[float(word) for word in line[1:44]] for line in lines])
    np.testing.assert_array_equal(reals, rows.reals)
    assert np.signbit(reals[0, head.index("V_WH_wx_rad_per_s") - 1])
    counts = np.array([[int(word) for word in line[44:49]] for line in lines])
    np.testing.assert_array_equal(counts, rows.counts[:, :5])


def test_the_columns_are_named_with_their_units(tmp_path):
    head, *_ = export(write_log(tmp_path / "log", [make_rows(1)]))
    assert len(head) == len(set(head)) == 1 + 43 + 7
    assert head[:6] == "tick time_s clock_s query_s device_time_s distance_m".split()
    for name in ("X_WH_qw", "X_WT_z_m", "V_WH_vx_m_per_s", "F_Ho_W_rendered_taux_Nm"):
        assert name in head
    assert head[head.index("F_Ho_W_commanded_fx_N") - 3] == "F_Ho_W_commanded_taux_Nm"
    assert head[-7:] == "contacts clusters status sequence buttons gate fault".split()
    assert sum(map(len, REALS.values())) == 43


def test_gate_and_fault_are_words(tmp_path):
    rows = make_smooth_rows(6)
    rows["device_time_s"][:] = [1.0, 1.1, 1.2, 1.3, 1.4, np.nan]
    rows["gate"][:] = [0, 1, 2, 2, 9, 0]
    rows["fault"][:] = [0, 0, 1, 3, 77, 0]
    _, *lines = export(write_log(tmp_path / "log", [rows]))
    assert [line[-2:] for line in lines] == [
        ["idle", "none"],
        ["active", "none"],
        ["fault", "stale"],
        ["fault", "overspeed"],
        # Of a later version.
        ["9", "77"],
        # A simulated device has no gate that could be idle.
        ["simulated", "none"],
    ]


def test_missing_ticks_are_missing_and_progress_ends_at_one(tmp_path):
    shares = []
    path = write_log(tmp_path / "log", [make_rows(3), make_rows(2, first=9)])
    _, *lines = export(path, lambda what, share: shares.append(share))
    assert [int(line[0]) for line in lines] == [0, 1, 2, 9, 10]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
