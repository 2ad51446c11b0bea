"""What a run measured."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from drake_haptics.simulation import statistics as run_statistics
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.systems.device.rendered_force_hold import (
    LIMITED,
    NOT_FINITE,
    SHOWN_AS_ASKED,
)


def add(statistics, force=(0, 0, 1.0), torque=(0.1, 0, 0), status=0.0, **changes):
    tick = {
        "tick_s": 1e-4,
        "query_s": 1e-5,
        "contacts": 3,
        "clusters": 1,
        "distance_m": 0.0,
        "shown": [*torque, *force, status],
    }
    statistics.add(**(tick | changes))


def test_a_run_without_ticks_is_all_zero():
    figures = RunStatistics(1e-3).to_dict()
    assert figures["ticks"] == 0
    assert figures["tick_us"] == {"median": 0, "p99": 0, "p99_9": 0, "max": 0}
    assert figures["contacts"] == {"median": 0, "max": 0}
    assert figures["energy_J"] == {}


def test_times_are_described_in_microseconds():
    statistics = RunStatistics(1e-3)
    times = np.random.default_rng(0).permutation(20001) * 1e-6
    for t in times:
        add(statistics, tick_s=t, query_s=t / 10)
    figures = statistics.to_dict()
    expected = {"median": 10000.0, "p99": 19800.0, "p99_9": 19980.0, "max": 20000.0}
    assert figures["tick_us"] == pytest.approx(expected)
    assert figures["contact_query_us"] == pytest.approx(
        {key: value / 10 for key, value in expected.items()}
    )
    assert figures["ticks"] == 20001
    assert figures["duration_s"] == pytest.approx(20.001)


def test_counts_and_largest_values():
    statistics = RunStatistics(1e-3)
    add(statistics, contacts=0, clusters=0, distance_m=1e-3)
    add(statistics, contacts=5, clusters=2, force=(0, -5.1, 6.8))
    add(statistics, contacts=7, clusters=2, torque=(0.09, 0.12, 0), distance_m=-2e-4)
    add(statistics, contacts=5, clusters=1)
    figures = statistics.to_dict()
    assert figures["contacts"] == {"median": 5.0, "max": 7}
    assert figures["clusters"] == {"median": 1.5, "max": 2}
    assert figures["max_force_N"] == pytest.approx(8.5)
    assert figures["max_torque_Nm"] == pytest.approx(0.15)
    assert figures["max_penetration_m"] == 2e-4
    assert figures["least_distance_m"] == -2e-4


def test_the_least_gap_is_told_of_near_contacts_alone():
    """What fits is measured by it: a smaller tolerance would not be felt there."""
    statistics = RunStatistics(1e-3)
    assert statistics.to_dict()["least_distance_m"] is None
    for distance_m in (np.inf, 8e-4, 3e-4, 5e-4):
        add(statistics, distance_m=distance_m)
    figures = statistics.to_dict()
    assert figures["least_distance_m"] == 3e-4
    assert figures["max_penetration_m"] == 0.0


@pytest.mark.parametrize("ticks", [4, 400])
def test_what_was_shown_is_counted(ticks):
    statistics = RunStatistics(1e-3)
    for status in [SHOWN_AS_ASKED, LIMITED, LIMITED, NOT_FINITE] * (ticks // 4):
        add(statistics, status=status)
    assert statistics.ticks == ticks
    figures = statistics.to_dict()
    assert figures["ticks"] == ticks
    assert figures["limit_hits"] == ticks // 2
    assert figures["non_finite_events"] == ticks // 4
    # Asking twice counts once.
    assert statistics.to_dict() == figures


def test_ticks_are_counted_that_leave_something_out():
    statistics = RunStatistics(1e-3)
    for shed in (0.0, 0.02, 1.0, 1.02, 2.5, 3.0):
        add(statistics)
        statistics.add_shed(shed)
    assert list(statistics.to_dict()["shed_ticks"].values()) == [5, 3, 2]


def test_memory_is_bounded_and_keeps_the_latest(monkeypatch):
    monkeypatch.setattr(run_statistics, "_MAX_RECORDS", 16)
    statistics = RunStatistics(1e-3)
    add(statistics, force=(9.0, 0, 0), tick_s=1.0)
    for i in range(40):
        add(statistics, contacts=i)
    figures = statistics.to_dict()
    assert figures["ticks"] == 41
    assert figures["contacts"] == {"median": 31.5, "max": 39}
    # The largest values are of the whole run, distributions of the latest ticks.
    assert figures["max_force_N"] == 9.0
    assert figures["tick_us"]["max"] == pytest.approx(100.0)


def test_the_energies_are_those_of_the_ledger_as_it_stands():
    books = {"device": {"in": 1.0}}
    statistics = RunStatistics(1e-3)
    statistics.book(SimpleNamespace(to_dict=lambda: dict(books)))
    assert statistics.to_dict()["energy_J"] == books
    books["tool"] = {"in": 2.0}
    assert statistics.to_dict()["energy_J"] == books


def test_a_report_is_json():
    statistics = RunStatistics(1e-3)
    add(statistics, distance_m=np.float64(-1e-3), status=LIMITED)
    assert json.loads(json.dumps(statistics.to_dict()))["ticks"] == 1


@pytest.mark.parametrize("period_s", [0.0, -1e-3])
def test_a_period_that_is_not_positive_is_refused(period_s):
    with pytest.raises(ValueError, match="period_s must be positive and finite"):
        RunStatistics(period_s)
