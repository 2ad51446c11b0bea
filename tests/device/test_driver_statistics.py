"""The driver's own books, which do not trust the gate."""

import math

import numpy as np
import pytest

from drake_haptics.device.backend import DeviceReading, Fault, GateState
from drake_haptics.device.driver import DriverStatistics


def tick(statistics, wrench, gate=GateState.ACTIVE, fault=Fault.NONE, time_s=0.0):
    statistics.add_tick(
        DeviceReading(
            sequence=0,
            time_s=time_s,
            X_BH=np.eye(7)[0],
            V_BH=np.zeros(6),
            F_Ho_B=np.array(wrench, dtype=float),
            gate=gate,
            fault=fault,
        )
    )


@pytest.fixture
def statistics():
    return DriverStatistics(max_force_N=5.0, max_torque_Nm=0.1)


def test_the_limits_themselves_are_allowed(statistics):
    tick(statistics, [0, 0.06, 0.08, 3, 0, -4])
    figures = statistics.to_dict()
    assert figures["limit_violations"] == 0
    assert figures["max_force_N"] == pytest.approx(5.0)
    assert figures["max_torque_Nm"] == pytest.approx(0.1)


@pytest.mark.parametrize(
    "wrench", [[0, 0, 0, 5.000001, 0, 0], [0, 0.1000001, 0, 0, 0, 0]]
)
def test_a_little_more_is_a_violation(statistics, wrench):
    tick(statistics, wrench)
    assert statistics.to_dict()["limit_violations"] == 1


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("axis", [0, 5])
def test_what_is_not_finite_is_a_violation_and_no_maximum(statistics, number, axis):
    wrench = [0.0] * 6
    wrench[axis] = number
    tick(statistics, wrench)
    figures = statistics.to_dict()
    assert figures["limit_violations"] == figures["non_finite_values"] == 1
    assert figures["max_force_N"] == figures["max_torque_Nm"] == 0.0


@pytest.mark.parametrize("gate", [GateState.IDLE, GateState.FAULT])
def test_any_force_of_a_gate_that_is_not_active_is_a_violation(statistics, gate):
    tick(statistics, [0, 0, 0, 0, 0, 1e-9], gate=gate)
    tick(statistics, [0] * 6, gate=gate)
    assert statistics.to_dict()["limit_violations"] == 1


def test_faults_and_recoveries_are_counted_by_kind_and_listed_with_times(statistics):
    def show(fault, time_s):
        gate = GateState.FAULT if fault else GateState.ACTIVE
        tick(statistics, [0] * 6, gate, fault, time_s)

    for i, fault in enumerate(
        [Fault.STALE, Fault.STALE, Fault.NONE, Fault.OVERSPEED, Fault.NONE, Fault.STALE]
    ):
        show(fault, float(i))
    figures = statistics.to_dict()
    assert figures["faults"] == {"STALE": 2, "OVERSPEED": 1}
    assert figures["recoveries"] == {"STALE": 1, "OVERSPEED": 1}
    assert figures["fault_times"] == [
        {"time_s": 0.0, "fault": "STALE"},
        {"time_s": 3.0, "fault": "OVERSPEED"},
        {"time_s": 5.0, "fault": "STALE"},
    ]


def test_a_fault_between_two_ticks_counts(statistics):
    tick(statistics, [0] * 6)
    statistics.note_fault(0.5, 1)
    statistics.note_fault(0.5, 0)
    tick(statistics, [0] * 6)
    figures = statistics.to_dict()
    assert figures["faults"] == figures["recoveries"] == {"STALE": 1}
