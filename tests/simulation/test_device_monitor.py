"""The book of a device's faults, and who may end one."""

import dataclasses

import numpy as np
import pytest
from fake_device import ScriptedDevice, make_reading

from drake_haptics.device.backend import Fault, GateState, LinkStatus
from drake_haptics.simulation.device_monitor import DeviceWatch, SilenceMonitor

ACTIVE = (GateState.ACTIVE, Fault.NONE)
STALE = (GateState.FAULT, Fault.STALE)
FAST = (GateState.FAULT, Fault.OVERSPEED)


def watch_states(*states, should_recover=lambda: False):
    """Watches a device go through (gate, fault) states, one per tick."""

    def read(call):
        gate, fault = states[min(call, len(states)) - 1]
        return dataclasses.replace(make_reading(call), gate=gate, fault=fault)

    backend = ScriptedDevice(read)
    watch = DeviceWatch(backend, should_recover)
    for _ in states:
        watch.end_tick()
    return watch.to_dict(), backend


def test_each_fault_counts_once_however_long_it_lasts():
    figures, _ = watch_states(ACTIVE, STALE, STALE, ACTIVE, STALE, FAST, FAST)
    assert figures["faults"] == {"STALE": 2, "OVERSPEED": 1}
    assert figures["recoveries"] == 1
    assert figures["gate"] == "FAULT"


def test_a_fault_lasts_until_somebody_wants_the_device_back():
    _, backend = watch_states(ACTIVE, *[STALE] * 50)
    assert backend.recovered == 0


def test_a_wish_is_passed_on_once_for_each_fault():
    _, backend = watch_states(
        STALE, STALE, STALE, ACTIVE, FAST, FAST, FAST, should_recover=lambda: True
    )
    assert backend.recovered == 2


def test_a_wish_from_before_the_fault_does_not_count():
    """As the Enter key is: pressed once, at some time before anybody asks."""
    typed = [True]
    _, backend = watch_states(
        ACTIVE, *[STALE] * 20, should_recover=lambda: bool(typed and typed.pop())
    )
    assert backend.recovered == 0


def test_nobody_is_asked_while_all_is_well():
    asked = []
    watch_states(ACTIVE, ACTIVE, should_recover=lambda: asked.append(1))
    assert not asked


def test_a_silent_device_has_no_state():
    watch = DeviceWatch(ScriptedDevice(lambda _: None), lambda: False)
    watch.end_tick()
    assert watch.to_dict()["gate"] is None


def test_the_way_to_the_device_is_reported():
    backend = ScriptedDevice()
    backend.get_link_status = lambda: LinkStatus(100, 2, 1, (1e-5, 2e-4, 3e-3))
    figures = DeviceWatch(backend, lambda: False).to_dict()
    assert (figures["received"], figures["lost"], figures["rejected"]) == (100, 2, 1)
    assert figures["servo_lateness_us"] == pytest.approx(
        {"p50": 10.0, "p99": 200.0, "p99_9": 3000.0}
    )


def test_loads_are_those_that_the_device_showed():
    wrenches = [[0, 0, 0, 3, 0, 4], [0, 0.3, 0.4, 0, 0, 1]]

    def read(call):
        wrench = np.array(wrenches[min(call, 2) - 1], dtype=float)
        return dataclasses.replace(make_reading(call), F_Ho_B=wrench)

    watch = DeviceWatch(ScriptedDevice(read), lambda: False)
    watch.end_tick()
    watch.end_tick()
    figures = watch.to_dict()
    assert figures["max_force_N"] == 5.0
    assert figures["max_torque_Nm"] == 0.5


def test_a_driver_is_silent_from_its_last_new_reading_on():
    silence = SilenceMonitor()
    readings = [None, *(make_reading(n) for n in (1, 2, 2, 2, 3))]
    said = [silence.add(reading, 0.4) for reading in readings]
    # None the first time is as it was before.
    assert said == pytest.approx([0.4, 0.0, 0.0, 0.4, 0.8, 0.0])
