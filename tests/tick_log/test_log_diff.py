"""Comparing runs: where, how far, in which unit, and what does not count."""

import dataclasses
import json
import math

import numpy as np
import pytest
from pydrake.common.eigen_geometry import AngleAxis
from tick_log_samples import HEADER, make_rows, make_smooth_rows

from drake_haptics.tick_log.log_diff import compare_logs
from drake_haptics.tick_log.log_format import TickLogError, TickRows
from drake_haptics.tick_log.tick_log import TickLog


def make_log(rows, **header):
    return TickLog(dataclasses.replace(HEADER, **header), rows, (), 0)


def copy_rows(rows):
    return TickRows(rows.ticks.copy(), rows.reals.copy(), rows.counts.copy())


def compare(change):
    """Returns how a run and its changed copy differ, by name."""
    rows = make_smooth_rows(100)
    changed = copy_rows(rows)
    change(changed)
    diff = compare_logs(make_log(rows), make_log(changed))
    return {q.name: q for q in diff.quantities if q.differing}


def test_the_same_is_the_same_whatever_its_bits():
    rows = make_rows(50)  # NaN among them
    diff = compare_logs(make_log(rows), make_log(copy_rows(rows)))
    assert diff.is_bit_equal
    assert (diff.ticks, diff.only_a, diff.only_b) == (50, 0, 0)
    assert all(q.largest == 0.0 and q.rms == 0.0 for q in diff.quantities)


def test_a_force_differs_by_its_norm():
    def change(rows):
        rows["F_Ho_W_commanded"][40:60, 3:] += [3.0, 0.0, 4.0]
        rows["F_Ho_W_commanded"][50, 3:] += [3.0, 0.0, 4.0]

    differing = compare(change)
    assert list(differing) == ["F_Ho_W_commanded force"]
    force = differing["F_Ho_W_commanded force"]
    assert (force.unit, force.differing, force.first_tick) == ("N", 20, 40)
    assert force.largest == pytest.approx(10.0)
    assert force.largest_tick == 50
    assert force.rms == pytest.approx(math.sqrt((19 * 5.0**2 + 10.0**2) / 100))


@pytest.mark.parametrize("angle", [1e-9, 0.3, 3.0, math.pi])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_rotation_differs_by_its_angle(angle, sign):
    turned = AngleAxis(angle, np.array([0.6, 0.0, 0.8])).quaternion().wxyz()

    def change(rows):
        rows["X_WT"][7, :4] = sign * turned

    differing = compare(change)
    assert list(differing) == ["X_WT rotation"]
    rotation = differing["X_WT rotation"]
    assert (rotation.unit, rotation.differing, rotation.first_tick) == ("rad", 1, 7)
    assert rotation.largest == pytest.approx(angle, rel=1e-7)


def test_the_sign_of_zero_is_a_bit():
    rows = make_smooth_rows(3, amplitude=0.0)
    changed = copy_rows(rows)
    changed["V_WH"][1, 5] = -0.0
    diff = compare_logs(make_log(rows), make_log(changed))
    assert not diff.is_bit_equal
    (linear,) = [q for q in diff.quantities if q.differing]
    assert (linear.name, linear.first_tick, linear.largest) == ("V_WH linear", 1, 0.0)


def test_infinite_in_both_is_no_difference_and_in_one_is():
    def change(rows):
        rows["distance_m"][9] = math.inf

    assert compare(change)["distance_m"].largest == math.inf
    rows = make_smooth_rows(3)
    rows["distance_m"][:] = math.inf
    assert compare_logs(make_log(rows), make_log(copy_rows(rows))).is_bit_equal


def test_counts_differ_by_their_number():
    def change(rows):
        rows["contacts"][3] = 0
        rows["contacts"][4] = 5

    contacts = compare(change)["contacts"]
    assert (contacts.largest, contacts.largest_tick, contacts.first_tick) == (4.0, 4, 3)


def test_clocks_do_not_count_nor_what_only_a_device_tells():
    def change(rows):
        for name in ("clock_s", "query_s", "device_time_s"):
            rows[name][:] += 1.0
        for name in ("sequence", "buttons", "gate", "fault"):
            rows[name][:] += 1

    assert not compare(change)


def test_only_common_ticks_are_compared():
    rows, others = make_smooth_rows(100), make_smooth_rows(150)
    keep = np.r_[0:30, 50:100]
    rows = TickRows(rows.ticks[keep], rows.reals[keep], rows.counts[keep])
    diff = compare_logs(make_log(rows), make_log(others))
    assert (diff.ticks, diff.only_a, diff.only_b) == (80, 0, 70)
    assert not diff.is_bit_equal
    assert not any(q.differing for q in diff.quantities)


def test_other_scenes_and_meshes_are_told():
    rows = make_smooth_rows(5)
    diff = compare_logs(make_log(rows), make_log(rows, scene="", mesh_sha256={}))
    assert (diff.same_scene, diff.same_meshes) == (False, False)
    assert diff.is_bit_equal


def test_what_cannot_be_compared_is_refused():
    rows = make_smooth_rows(5)
    with pytest.raises(TickLogError, match=r"last 0\.001 s and 0\.002 s"):
        compare_logs(make_log(rows), make_log(rows, period_s=2e-3))
    with pytest.raises(TickLogError, match="no tick in common"):
        compare_logs(make_log(rows), make_log(make_rows(5, first=9)))


def test_the_figures_are_json_whatever_they_are():
    rows = make_rows(200, seed=1)
    diff = compare_logs(make_log(rows), make_log(make_rows(200, seed=2)))
    data = json.loads(json.dumps(diff.to_dict(), allow_nan=False))
    assert data["is_bit_equal"] is False
    assert {q["name"] for q in data["quantities"]} == {q.name for q in diff.quantities}
