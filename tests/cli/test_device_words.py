"""What a person reads of a device's state."""

import dataclasses
import inspect

import pytest
from fake_device import make_reading

from drake_haptics.cli.device import device
from drake_haptics.cli.status_line import (
    describe_device,
    describe_gate,
    describe_lateness,
    describe_link,
)
from drake_haptics.device.backend import Fault, GateState, LinkStatus
from drake_haptics.device.udp_device import UdpDevice


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (Fault.NOT_FINITE, "FAULT (not finite): Enter enables it again"),
        (Fault.STALE, "FAULT (stale): while its driver runs, Enter enables it again"),
    ],
)
def test_a_fault_says_why_and_what_to_do(fault, words):
    reading = dataclasses.replace(make_reading(), gate=GateState.FAULT, fault=fault)
    assert words in describe_gate(reading)


def test_an_active_device_has_nothing_to_say():
    assert "ACTIVE[/]" in describe_gate(make_reading())
    assert "silent" in describe_gate(None)


def test_lateness_is_in_milliseconds():
    assert describe_lateness((5e-5, 1.25e-3, 0.1)) == "0.05/1.25/100.00 ms"


def test_the_link_tells_what_went_wrong_only():
    assert describe_link(LinkStatus(1000, 3)) == "3 lost"
    words = describe_link(LinkStatus(1000, 0, 7, (1e-5, 1e-4, 1e-3)))
    assert words == "0 lost, 7 refused, servo 0.01/0.10/1.00 ms"
    solving = LinkStatus(1000, solved=4000, solved_late=12)
    assert describe_link(solving) == "0 lost, 12 of 4,000 contact steps late"


def test_faults_are_counted_by_name_and_a_link_only_where_there_is_one():
    figures = {"faults": {}, "received": 0, "lost": 0, "rejected": 0}
    figures |= {"max_force_N": 2.5, "max_torque_Nm": 0.12}
    figures |= {"solved": 0, "solved_late": 0}
    assert describe_device(figures) == "showed at most 2.50 N, 120 mN·m; faults: none"
    figures["faults"] = {"STALE": 2, "OVERSPEED": 1}
    assert describe_device(figures).endswith("; faults: 2 stale, 1 overspeed")
    figures["received"] = 1000
    assert describe_device(figures).startswith("1,000 readings, 0 lost, 0 refused; ")
    figures |= {"solved": 1, "solved_late": 1}
    assert describe_device(figures).endswith("; 1 of 1 contact step of its servo late")


def test_the_help_says_which_life_a_run_chooses_below_the_limit_of_the_driver():
    life_s = inspect.signature(UdpDevice).parameters["ttl_s"].default
    (option,) = [o for o in device.params if o.name == "ttl_ms"]
    assert f"`run` chooses {1e3 * life_s:g} ms" in option.help
    assert option.default > 1e3 * life_s
