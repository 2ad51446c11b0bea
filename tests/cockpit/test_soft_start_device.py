"""Nobody who takes a handle is surprised by its force."""

from dataclasses import replace

import numpy as np
import pytest
from fake_device import ScriptedDevice, make_reading

from drake_haptics.cockpit.handle_holder import ForceOnRequest, SoftStartDevice
from drake_haptics.device.backend import DeviceCommand, DeviceReading, Fault, GateState

PERIOD_S, FORCE_N, TORQUE_NM = 2e-3, 8.0, 0.4
# 0.1 s of gentle ticks, and 0.2 s until all is shown.
WAITING, RISING = 50, 100
GENTLE = np.array([0, 0, 0.09, 0, 1.9, 0])


def take(device):
    return SoftStartDevice(
        device, max_force_N=FORCE_N, max_torque_Nm=TORQUE_NM, period_s=PERIOD_S
    )


def command(F_Ho_B):
    X_BH = np.array([1.0, 0, 0, 0, 0.1, 0.2, 0.3])
    return DeviceCommand(
        np.array(F_Ho_B), X_BH, np.ones(6), 3.0 * np.eye(6), 2.0 * np.eye(6)
    )


def show(taken, F_Ho_B, ticks):
    """Asks for a wrench in so many ticks."""
    for _ in range(ticks):
        taken.write(command(F_Ho_B))


def test_what_is_gentle_sets_in_after_a_moment_and_rises():
    device = ScriptedDevice()
    taken = take(device)
    show(taken, GENTLE, WAITING + RISING + 10)
    shown = np.array([each.F_Ho_B for each in device.commands])
    assert not shown[: WAITING - 1].any()
    ticks = np.arange(len(shown)) - (WAITING - 2)
    np.testing.assert_allclose(
        shown, np.clip(ticks / RISING, 0, 1)[:, None] * GENTLE, atol=1e-12
    )
    # A servo that carries it on carries on what is shown.
    part = device.commands[WAITING + 20]
    share = part.F_Ho_B[4] / GENTLE[4]
    assert 0.0 < share < 1.0
    np.testing.assert_allclose(part.K_B, 3.0 * share * np.eye(6))
    np.testing.assert_allclose(part.B_B, 2.0 * share * np.eye(6))
    np.testing.assert_array_equal(part.X_BH, command(GENTLE).X_BH)
    assert device.commands[0].K_B is device.commands[0].B_B is None


@pytest.mark.parametrize(
    "F_Ho_B",
    [
        [0, 0, 0, 0, 0, 2.1],
        [0, 0.08, 0.08, 0, 0, 0],
        [0, 0, 0, np.nan, 0, 0],
        [np.inf, 0, 0, 0, 0, 0],
    ],
)
def test_what_is_not_gentle_is_not_shown(F_Ho_B):
    device = ScriptedDevice()
    taken = take(device)
    show(taken, F_Ho_B, 1000)
    # Nor what was gentle for less than that moment.
    show(taken, GENTLE, WAITING - 1)
    show(taken, F_Ho_B, 1)
    show(taken, GENTLE, WAITING - 1)
    assert taken.waits
    assert not any(each.F_Ho_B.any() for each in device.commands)
    assert taken.read().gate == GateState.IDLE
    show(taken, GENTLE, 1)
    assert not taken.waits
    assert taken.read().gate == GateState.ACTIVE


def test_once_it_has_set_in_all_is_shown():
    device = ScriptedDevice()
    taken = take(device)
    show(taken, GENTLE, WAITING + RISING)
    asked = command([0.3, 0, 0, 8.0, 0, 0])
    taken.write(asked)
    assert device.commands[-1] is asked


def test_somebody_can_want_it_at_once_and_still_it_rises():
    device = ScriptedDevice()
    taken = take(device)
    show(taken, [0, 0, 0, 0, 0, 8.0], 10)
    taken.resume()
    show(taken, [0, 0, 0, 0, 0, 8.0], RISING)
    forces = [each.F_Ho_B[5] for each in device.commands]
    assert forces[9] == 0.0
    np.testing.assert_allclose(np.diff(forces[9:]), 8.0 / RISING)


def test_what_becomes_another_goes_over_from_what_was_shown():
    device = ScriptedDevice()
    taken = take(device)
    before, after = np.array([0.1, 0, 0, 5.0, 0, 0]), np.array([0, 0.2, 0, 0, -3.0, 0])
    taken.resume()
    show(taken, before, RISING)
    for asked in (after, before):
        last = device.commands[-1].F_Ho_B
        taken.hand_over()
        # Before it is all there it may become another one again.
        show(taken, asked, RISING // 2)
        shown = np.array([each.F_Ho_B for each in device.commands[-RISING // 2 :]])
        share = np.arange(1, RISING // 2 + 1)[:, None] / RISING
        np.testing.assert_allclose(shown, last + share * (asked - last), atol=1e-12)
        np.testing.assert_allclose(device.commands[-1].K_B, 1.5 * np.eye(6))
    show(taken, before, RISING // 2)
    np.testing.assert_allclose(device.commands[-1].F_Ho_B, before, atol=1e-12)
    # What a fault took away is not gone back to.
    taken.hand_over()
    taken.recover()
    show(taken, GENTLE, WAITING)
    np.testing.assert_allclose(device.commands[-1].F_Ho_B, GENTLE / RISING, atol=1e-12)


def test_what_waits_is_not_shown_for_becoming_another():
    device = ScriptedDevice()
    taken = take(device)
    taken.hand_over()
    show(taken, [0, 0, 0, 0, 0, 8.0], 10)
    assert taken.waits and not any(each.F_Ho_B.any() for each in device.commands)


def test_after_a_fault_it_is_taken_again():
    fault = []

    def read(k):
        made = vars(make_reading(k))
        return DeviceReading(**{**made, **dict(fault)})

    device = ScriptedDevice(read)
    taken = take(device)
    show(taken, GENTLE, WAITING + RISING)
    fault[:] = [("gate", GateState.FAULT), ("fault", Fault.OVERSPEED)]
    assert taken.read().gate == GateState.FAULT
    taken.resume()
    assert device.recovered == 1 and taken.waits
    assert taken.read().gate == GateState.FAULT
    fault.clear()
    device.commands.clear()
    show(taken, [0, 0, 0, 0, 0, 8.0], 200)
    assert not any(each.F_Ho_B.any() for each in device.commands)
    taken.recover()
    assert device.recovered == 2 and taken.waits


def test_it_is_the_device_but_for_that():
    device = ScriptedDevice()
    taken = take(device)
    assert repr(taken) == repr(device)
    assert taken.url is device.url and taken.is_placed is device.is_placed
    assert taken.get_link_status() == device.get_link_status()
    taken.close()
    assert device.closed


def test_a_force_that_waits_sets_in_when_it_is_asked_for():
    gates = [GateState.FAULT] * 2 + [GateState.IDLE] * 2 + [GateState.ACTIVE] * 4
    device = ScriptedDevice(
        lambda call: replace(make_reading(call), gate=gates[min(call, len(gates)) - 1])
    )
    taken = take(device)
    # Pressed to leave the fault, and again before it was left: no wish for this.
    wishes = [True, True, True, False, True]
    request = ForceOnRequest(taken, lambda: wishes.pop(0))
    for _ in range(6):
        request.end_tick()
        assert taken.waits
    assert wishes == [True]
    request.end_tick()
    assert not taken.waits
    request.end_tick()  # nobody is asked any more
    assert wishes == []
