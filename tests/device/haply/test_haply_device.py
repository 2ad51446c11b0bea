"""The Haply backend against a service in another thread, over real WebSockets."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from haply_service import HaplyService, Inverse3
from waiting import wait_until

from drake_haptics.device.backend import DeviceCommand, DeviceError, Fault, GateState
from drake_haptics.device.driver import read_clock_ns
from drake_haptics.device.haply import haply_device
from drake_haptics.device.haply.haply_device import HaplyDevice
from drake_haptics.loop.open_device import open_device as open_device_at
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

STIFFNESS_N_PER_M = 300.0
MAX_FORCE_N = 2.0


def make_service(**options):
    """A service with one device that is pushed down onto the floor z = 0."""
    return HaplyService({"049D": Inverse3(push_N=(0.0, 0.0, -1.0))}, **options)


def open_device(service, **options):
    # A generous life: other processes may keep this one from its turn.
    options = {"max_force_N": MAX_FORCE_N, "ttl_s": 1.0, "timeout_s": 30.0} | options
    return HaplyDevice(service.uri, **options)


def press(device, stiffness=STIFFNESS_N_PER_M):
    """One turn of a loop that renders the floor z = 0."""
    reading = device.read()
    force = [0.0, 0.0, max(-stiffness * reading.X_BH[6], 0.0)]
    device.write(
        DeviceCommand(
            F_Ho_B=np.array([0.0, 0.0, 0.0, *force]),
            X_BH=reading.X_BH,
            V_BH=reading.V_BH,
        )
    )


def is_in(device, gate, fault=Fault.NONE):
    reading = device.read()
    return (reading.gate, reading.fault) == (gate, fault)


def test_closed_loop_against_a_floor():
    """The hand's 1 N rests where the floor's spring gives 1 N."""
    with make_service() as service:
        mass = service.devices["049D"]
        with open_device(service) as device:
            wait_until(
                lambda: (
                    is_in(device, GateState.ACTIVE)
                    and abs(device.read().F_Ho_B[5] - 1.0) < 0.01
                    and abs(mass.p[2] + 1.0 / STIFFNESS_N_PER_M) < 1e-5
                    and abs(mass.v[2]) < 1e-5
                ),
                lambda: press(device),
            )
            reading = device.read()
            assert device.get_link_status().received >= reading.sequence > 100
            assert device.get_link_status().rejected == 0
            assert not device.has_grip
        assert not mass.forces[-1][1].any()
        assert mass.largest_N <= MAX_FORCE_N
        assert service.violations == 0


def test_a_wall_stiffer_than_the_device_stops_at_its_limit():
    with make_service() as service:
        mass = service.devices["049D"]
        mass.push_N = np.array([0.0, 0.0, -3.0])
        with open_device(service) as device:
            wait_until(
                lambda: mass.largest_N > 0.99 * MAX_FORCE_N, lambda: press(device, 1e5)
            )
        assert mass.largest_N <= MAX_FORCE_N


def test_a_loop_that_stops_ends_at_zero_force_and_can_recover():
    with make_service() as service:
        mass = service.devices["049D"]
        with open_device(service, ttl_s=0.3) as device:
            wait_until(lambda: is_in(device, GateState.ACTIVE), lambda: press(device))
            wait_until(lambda: is_in(device, GateState.FAULT, Fault.STALE))
            count = len(mass.forces)
            wait_until(lambda: len(mass.forces) > count + 100, lambda: press(device))
            assert is_in(device, GateState.FAULT, Fault.STALE)
            assert not any(force.any() for _, force in mass.forces[count + 1 :])
            device.recover()
            wait_until(lambda: is_in(device, GateState.ACTIVE), lambda: press(device))


def test_recovering_a_device_that_is_not_at_fault_leaves_its_force():
    with make_service() as service:
        mass = service.devices["049D"]
        with open_device(service) as device:
            wait_until(
                lambda: is_in(device, GateState.ACTIVE) and mass.forces[-1][1][2] > 0.9,
                lambda: press(device),
            )
            count = len(mass.forces)
            device.recover()
            wait_until(lambda: len(mass.forces) > count + 100, lambda: press(device))
            assert min(force[2] for _, force in mass.forces[count:]) > 0.5


@pytest.mark.parametrize("how", ["restarted", "silent"])
def test_a_service_that_went_is_felt_again_only_when_it_is_wanted(how):
    with make_service() as service:
        mass = service.devices["049D"]
        with open_device(service) as device:
            wait_until(
                lambda: is_in(device, GateState.ACTIVE) and mass.forces[-1][1][2] > 0.9,
                lambda: press(device),
            )
            service.stop() if how == "restarted" else service.answers.clear()
            wait_until(
                lambda: is_in(device, GateState.FAULT, Fault.DEVICE),
                lambda: press(device),
            )
            count = len(mass.forces)
            assert not device.read().F_Ho_B.any()
            service.start() if how == "restarted" else service.answers.set()
            # A first answer after the silence, then more.
            wait_until(lambda: len(mass.forces) > count + 100, lambda: press(device))
            assert is_in(device, GateState.FAULT, Fault.DEVICE)
            assert not any(force.any() for _, force in mass.forces[count + 1 :])
            device.recover()
            wait_until(
                lambda: is_in(device, GateState.ACTIVE) and mass.forces[-1][1][2] > 0.9,
                lambda: press(device),
            )
            sizes = [np.linalg.norm(force) for _, force in mass.forces[count:]]
            assert sizes[0] == 0.0
            # A ramp rises by a twentieth of what is asked in one step at most.
            half = next(i for i, size in enumerate(sizes) if size > 0.5)
            assert half >= 5
        assert mass.largest_N <= MAX_FORCE_N
        assert service.violations == 0


def test_what_was_commanded_before_the_machine_slept_is_not_shown_after_it(monkeypatch):
    slept_ns = 0
    monkeypatch.setattr(
        haply_device, "read_clock_ns", lambda: read_clock_ns() + slept_ns
    )
    with make_service() as service, open_device(service) as device:
        wait_until(lambda: is_in(device, GateState.ACTIVE), lambda: press(device))
        slept_ns = 3_600_000_000_000
        wait_until(lambda: is_in(device, GateState.FAULT, Fault.DEVICE))
        assert not device.read().F_Ho_B.any()


def test_damaged_messages_are_counted_and_survived():
    with make_service() as service:
        with open_device(service) as device:
            for number, text in enumerate(["", "{", "[]", '{"inverse3": [1]}']):
                service.instead = text
                wait_until(
                    lambda number=number: (
                        device.get_link_status().rejected == number + 1
                    ),
                    lambda: press(device),
                )
            sequence = device.read().sequence
            wait_until(
                lambda: (
                    device.read().sequence > sequence + 10
                    and is_in(device, GateState.ACTIVE)
                ),
                lambda: press(device),
            )


def test_two_devices_on_one_service():
    both = {name: Inverse3() for name in ("left", "right")}
    with HaplyService(both, grips={"pen": (0.0, 1.0, 0.0, 0.0)}) as service:
        both["right"].p = np.array([0.0, 0.0, 0.1])
        with (
            open_device(service) as first,
            open_device(service, device_id="right", force_field="vector") as second,
        ):
            assert first.read().X_BH.tolist() == [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
            assert second.read().X_BH[6] == 0.1
            assert first.has_grip
            wait_until(lambda: is_in(first, GateState.ACTIVE), lambda: press(first))
            assert is_in(second, GateState.IDLE)


def test_an_older_service_calls_the_force_by_another_name():
    with make_service(force_field="values") as service:
        with open_device(service, force_field="values") as device:
            mass = service.devices["049D"]
            wait_until(lambda: mass.largest_N > 0.5, lambda: press(device))


def test_a_closed_device_shows_nothing_and_stays_closed():
    with make_service() as service:
        mass = service.devices["049D"]
        device = open_device(service)
        wait_until(lambda: mass.largest_N > 0.0, lambda: press(device))
        device.close()
        device.close()
        wait_until(lambda: not mass.forces[-1][1].any())
        count = len(mass.forces)
        press(device)
        device.recover()
        assert len(mass.forces) == count


@pytest.mark.parametrize("is_late", [False, True])
def test_a_device_that_is_closed_while_its_service_is_silent_ends_at_zero_force(
    monkeypatch, is_late
):
    """A late service sees the last message and the end of the connection at once."""

    def expect_nothing_late(_, connection):
        if is_closed.is_set():
            connection.recv_events_thread.join()

    is_closed = threading.Event()
    if is_late:
        monkeypatch.setattr(HaplyService, "expect_nothing", expect_nothing_late)
    with make_service() as service:
        mass = service.devices["049D"]
        device = open_device(service)
        wait_until(lambda: mass.largest_N > 0.5, lambda: press(device))
        service.answers.clear()
        wait_until(
            lambda: is_in(device, GateState.FAULT, Fault.DEVICE), lambda: press(device)
        )
        assert mass.forces[-1][1].any()
        device.close()
        is_closed.set()
        service.answers.set()
        wait_until(lambda: not mass.forces[-1][1].any())


def test_no_service():
    with make_service() as service:
        uri = service.uri
    with pytest.raises(DeviceError, match=r"no Haply device: ws://.*refused.*Start"):
        HaplyDevice(uri, timeout_s=0.3)


@pytest.mark.parametrize(
    ("devices", "says"),
    [({}, "it has no Inverse3 04EA"), ({"049D": Inverse3()}, "04EA")],
)
def test_a_service_without_the_device(devices, says):
    with HaplyService(devices) as service:
        with pytest.raises(DeviceError, match=says):
            HaplyDevice(service.uri, device_id="04EA", timeout_s=2.0)
        assert service.others
        assert not any(device.forces for device in devices.values())


def test_an_address_as_a_person_writes_it():
    scene = load_scene(find_scene("sphere_pen"))
    with HaplyService({"left": Inverse3(), "right": Inverse3()}) as service:
        service.devices["right"].p = np.array([0.0, 0.0, 0.1])
        address = f"haply://127.0.0.1:{service.port}"
        with open_device_at(f"{address}?device_id=right&max_force_N=1.5", scene) as it:
            assert it.read().X_BH[6] == 0.1
            mass = service.devices["right"]
            ask = DeviceCommand(np.full(6, 9.0), np.zeros(7), np.zeros(6))
            wait_until(lambda: mass.largest_N > 1.4, lambda: it.write(replace(ask)))
        assert mass.largest_N <= 1.5
        assert not service.devices["left"].forces
    for options, says in [
        ("max_force=1", "max_force is not one of device_id, grip_id, force_field, max"),
        ("max_force_N=x", "max_force_N must be a number, is 'x'"),
        ("max_force_N=-1", "max_force_N"),
        ("force_field=force", "must be vector or values, is 'force'"),
    ]:
        with pytest.raises(DeviceError, match=f"Haply device, {options}: .*{says}"):
            open_device_at(f"{address}?{options}", scene)


@pytest.mark.parametrize(
    ("argument", "value"),
    [("rate_hz", 0.0), ("max_force_N", -1.0), ("ttl_s", 0.0), ("ttl_s", float("nan"))],
)
def test_arguments_out_of_range(argument, value):
    name = argument.removesuffix("_s")
    with pytest.raises(ValueError, match=name):
        HaplyDevice("ws://127.0.0.1:1", **{argument: value})


def test_what_is_not_a_wrench_is_refused():
    with make_service() as service, open_device(service) as device:
        with pytest.raises(ValueError, match=r"F_Ho_B must be \(6,\), is \(3,\)"):
            device.write(DeviceCommand(np.zeros(3), np.zeros(7), np.zeros(6)))


@pytest.mark.parametrize("part", ["1 N", object()])
def test_a_wrench_that_is_not_of_numbers_is_refused_and_the_device_goes_on(part):
    with make_service() as service, open_device(service) as device:
        with pytest.raises((TypeError, ValueError), match="float"):
            device.write(DeviceCommand([part] * 6, np.zeros(7), np.zeros(6)))
        wait_until(lambda: is_in(device, GateState.ACTIVE), lambda: press(device))


def test_a_command_that_is_changed_and_written_again_is_shown():
    with make_service() as service, open_device(service) as device:
        mass = service.devices["049D"]
        command = DeviceCommand(np.zeros(6), np.zeros(7), np.zeros(6))
        for sign in (1.0, -1.0):
            command.F_Ho_B[5] = sign
            wait_until(
                lambda sign=sign: mass.forces and sign * mass.forces[-1][1][2] > 0.5,
                lambda: device.write(command),
            )
