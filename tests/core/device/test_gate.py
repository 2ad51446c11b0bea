"""The gate, failure by failure, with a clock that is turned by hand."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from gate_rig import AT_REST, MAX_FORCE_N, MAX_TORQUE_NM, MS, X_BH, GateRig

from drake_haptics import _core
from drake_haptics.device.backend import Fault, GateState

ACTIVE, IDLE, FAULT = GateState.ACTIVE, GateState.IDLE, GateState.FAULT


@pytest.fixture
def rig() -> GateRig:
    return GateRig()


@pytest.fixture
def active() -> GateRig:
    rig = GateRig()
    rig.activate()
    return rig


def assert_latched(rig: GateRig, fault: Fault) -> None:
    """Zero force, which only a newer command without enable ends."""
    assert (rig.state, rig.fault) == (FAULT, fault)
    for _ in range(300):
        assert rig.send() == "at_fault"
        assert not rig.step().any()
    assert (rig.state, rig.fault) == (FAULT, fault)
    assert rig.send(enable=False) == "accepted"
    assert (rig.state, rig.fault) == (IDLE, Fault.NONE)


def test_commands_ramp_in_hold_and_ramp_out_when_they_stop(rig: GateRig) -> None:
    rig.send(enable=False)
    rig.run(300)
    rig.wait(60)
    f = rig.forces
    assert f[100] == pytest.approx(2.5)
    assert f[250] == f[310] == 5.0
    assert f[329] == pytest.approx(2.5)
    assert f[345] == 0.0
    assert np.abs(np.diff(f)).max() == pytest.approx(0.25)
    assert_latched(rig, Fault.STALE)


def test_a_wrench_over_the_limits_keeps_its_direction(active: GateRig) -> None:
    active.send(wrench=(1.0, 1.0, 0.0, 0.0, 0.0, 50.0))
    F = active.step()
    expected = [MAX_TORQUE_NM / np.sqrt(2)] * 2 + [0, 0, 0, 8.5]
    np.testing.assert_allclose(F, expected, rtol=1e-12)
    assert np.linalg.norm(F[3:]) <= MAX_FORCE_N
    assert np.linalg.norm(F[:3]) <= MAX_TORQUE_NM


def test_what_is_shown_is_within_the_limits_to_the_last_bit(active: GateRig) -> None:
    """By exact arithmetic, so that no round-off of the norm can hide or feign it."""
    wrenches = np.random.default_rng(0).normal(size=(2000, 6)) * 100
    for wrench in wrenches:
        active.send(wrench=tuple(wrench))
        F = [Fraction(float(x)) for x in active.step()]
        assert sum(x * x for x in F[:3]) <= Fraction(MAX_TORQUE_NM) ** 2
        assert sum(x * x for x in F[3:]) <= Fraction(MAX_FORCE_N) ** 2


@pytest.mark.parametrize("huge", [1e308, 1.7976931348623157e308, 1e155])
def test_a_huge_wrench_is_clamped_and_not_overflown(
    active: GateRig, huge: float
) -> None:
    active.send(wrench=(huge, -huge, huge, huge, -huge, huge))
    F = active.step()
    along = np.array([1, -1, 1]) / np.sqrt(3)
    np.testing.assert_allclose(F[:3], MAX_TORQUE_NM * along, rtol=1e-12)
    np.testing.assert_allclose(F[3:], MAX_FORCE_N * along, rtol=1e-12)


@pytest.mark.parametrize("tiny", [5e-324, -5e-324, 1e-310, -0.0])
def test_a_denormal_wrench_passes_as_it_is(active: GateRig, tiny: float) -> None:
    assert active.send(wrench=(tiny,) * 6) == "accepted"
    np.testing.assert_array_equal(active.step(), [tiny] * 6)


def test_a_device_without_torque_shows_none() -> None:
    rig = GateRig(max_torque_Nm=0.0)
    rig.activate(wrench=(1.0, 2.0, 3.0, 0.0, 0.0, 5.0))
    np.testing.assert_array_equal(rig.step(), [0, 0, 0, 0, 0, 5])


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [0, 5])
def test_a_command_that_is_not_finite_is_a_fault_at_once(
    active: GateRig, wrong: float, place: int
) -> None:
    wrench = [0.0] * 6
    wrench[place] = wrong
    assert active.send(wrench=tuple(wrench)) == "not_finite"
    assert not active.step().any()
    assert_latched(active, Fault.NOT_FINITE)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
@pytest.mark.parametrize("what", ["pose", "velocity"])
def test_a_handle_that_is_not_finite_is_a_fault_at_once(
    active: GateRig, wrong: float, what: str
) -> None:
    X, V = X_BH.copy(), AT_REST.copy()
    (X if what == "pose" else V)[4] = wrong
    active.send()
    assert not active.step(V, X).any()
    assert_latched(active, Fault.NOT_FINITE)


@pytest.mark.parametrize(
    "V", [[0, 0, 0, 1.5, 1.5, 0], [25.0, 25.0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 1e308]]
)
def test_a_handle_that_is_too_fast_is_a_fault_at_once(
    active: GateRig, V: list[float]
) -> None:
    active.send()
    assert not active.step(np.array(V)).any()
    assert_latched(active, Fault.OVERSPEED)


def test_a_fast_handle_is_no_fault_where_no_force_is_shown(rig: GateRig) -> None:
    rig.step(np.array([0, 0, 0, 9.0, 0, 0]))
    assert rig.state is IDLE


def test_a_command_of_another_session_changes_nothing(active: GateRig) -> None:
    for enable in (True, False):
        assert active.send(-8.0, session=2, enable=enable) == "foreign_session"
        active.send()
        assert active.step()[5] == 5.0
    assert active.gate.session == 1


def test_old_and_duplicate_commands_change_nothing(active: GateRig) -> None:
    late = active.packet(-8.0)
    newer = active.packet(4.0)
    assert active.receive(newer) == "accepted"
    assert active.receive(newer) == "old_sequence"
    assert active.receive(late) == "old_sequence"
    assert active.step()[5] == 4.0


def test_reordered_commands_never_show_an_older_one(active: GateRig) -> None:
    packets = [active.packet(float(i)) for i in range(8)]
    shown = []
    for i in (1, 0, 3, 2, 7, 4, 6, 5):
        active.receive(packets[i])
        shown.append(active.step()[5])
    assert shown == [1, 1, 3, 3, 7, 7, 7, 7]


def test_a_replayed_packet_does_not_keep_a_dead_host_alive(active: GateRig) -> None:
    packet = active.packet()
    active.receive(packet)
    for _ in range(60):
        active.receive(packet)
        active.step()
    assert_latched(active, Fault.STALE)


def test_numbers_wrap() -> None:
    rig = GateRig()
    rig.sequences[1] = 2**32 - 100
    rig.activate()
    assert 0 < rig.gate.command_sequence < 200
    assert rig.gate.rejected == 0


@pytest.mark.parametrize(
    ("ahead", "verdict"),
    [
        (1, "accepted"),
        (2**31 - 1, "accepted"),
        (2**31, "old_sequence"),
        (2**32 - 1, "old_sequence"),
        (0, "old_sequence"),
    ],
)
@pytest.mark.parametrize("start", [5, 2**32 - 1, 2**31])
def test_a_number_is_newer_if_less_than_half_of_all_ahead(
    rig: GateRig, start: int, ahead: int, verdict: str
) -> None:
    rig.send(enable=False, sequence=start)
    assert rig.send(enable=False, sequence=(start + ahead) % 2**32) == verdict


def test_damage_is_counted_by_its_reason_and_changes_nothing(active: GateRig) -> None:
    good = active.packet(-8.0)
    broken = {
        "too_short": good[:10],
        "wrong_magic": b"X" + good[1:],
        "wrong_version": good[:4] + b"\2" + good[5:],
        "wrong_kind": good[:5] + b"\1" + good[6:],
        "wrong_size": good + b"\0",
        "wrong_crc": good[:40] + bytes([good[40] ^ 1]) + good[41:],
    }
    for reason, packet in broken.items():
        assert active.receive(packet) == reason
        assert active.gate.counts[reason] == 1
    assert active.gate.rejected == len(broken)
    assert active.step()[5] == 5.0


def test_a_host_that_is_paused_faults_and_does_not_come_back_by_itself(
    active: GateRig,
) -> None:
    active.wait(100)
    largest = max(np.abs(np.diff(active.forces)))
    assert largest <= 5.0 / 20 + 1e-12
    assert_latched(active, Fault.STALE)


def test_a_command_during_the_ramp_out_ramps_in_again(active: GateRig) -> None:
    active.wait(30)
    assert 0.0 < active.forces[-1] < 5.0
    low = active.forces[-1]
    active.run(200)
    rises = np.diff(active.forces[-201:])
    assert rises.max() <= 5.0 / 200 + 1e-12
    assert active.forces[-1] == 5.0 > low
    assert active.state is ACTIVE


def test_a_clock_that_goes_backwards_is_a_fault_in_a_step(active: GateRig) -> None:
    active.send()
    active.ms -= 50
    assert not active.step().any()
    assert_latched(active, Fault.CLOCK)


def test_a_clock_that_goes_backwards_is_a_fault_on_receipt(active: GateRig) -> None:
    active.ms -= 50
    assert active.send() == "clock_went_back"
    assert not active.step().any()
    assert_latched(active, Fault.CLOCK)


def test_a_clock_that_jumps_ahead_is_a_silence(active: GateRig) -> None:
    active.ms += 1000
    assert not active.step().any()
    assert_latched(active, Fault.STALE)


def test_what_queued_up_while_the_driver_slept_does_not_hide_the_silence(
    active: GateRig,
) -> None:
    active.ms += 1000
    assert active.send() == "at_fault"
    assert_latched(active, Fault.STALE)


def test_a_late_step_falls_by_the_time_since_the_command_went_stale(
    active: GateRig,
) -> None:
    active.send()
    active.ms += 25
    assert active.step()[5] == pytest.approx(5.0 * 0.75)


def test_a_late_step_does_not_jump_to_full_force(rig: GateRig) -> None:
    rig.send(enable=False)
    rig.send(ttl_s=0.1)
    rig.ms += 99
    assert rig.step()[5] == pytest.approx(5.0 / 20)


def test_a_flood_changes_nothing_and_is_counted(active: GateRig) -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        for size in rng.integers(0, 200, 200):
            active.receive(rng.bytes(size))
            active.receive(b"DHAP" + rng.bytes(84))
        active.send()
        assert active.step()[5] == 5.0
    assert active.gate.rejected == 50 * 400


def test_a_disable_ramps_out_and_ends_idle(active: GateRig) -> None:
    assert active.send(enable=False) == "accepted"
    active.wait(25)
    assert np.abs(np.diff(active.forces)).max() <= 5.0 / 20 + 1e-12
    assert (active.state, active.fault, active.gate.session) == (IDLE, Fault.NONE, 0)
    assert not active.step().any()


def test_a_late_enable_does_not_undo_a_disable(active: GateRig) -> None:
    late = active.packet()
    active.send(enable=False)
    assert active.receive(late) == "old_sequence"
    active.wait(30)
    assert active.receive(late) == "old_sequence"
    assert active.state is IDLE


def test_late_packets_of_an_earlier_host_do_not_enable(active: GateRig) -> None:
    late = [active.packet(enable=False), active.packet()]
    active.send(enable=False)
    active.wait(30)
    for session in range(2, 9):
        active.send(session=session, enable=False)
    for packet in late:
        assert active.receive(packet) == "old_sequence"
    assert active.state is IDLE


def test_a_late_disable_does_not_leave_a_fault(active: GateRig) -> None:
    late = active.packet(enable=False)
    active.send()
    active.gate.fail()
    assert active.receive(late) == "old_sequence"
    assert_latched(active, Fault.DEVICE)


def test_a_restarted_driver_waits_for_the_host_to_begin_again(rig: GateRig) -> None:
    for _ in range(100):
        assert rig.send() == "not_disabled_first"
        assert not rig.step().any()
    assert rig.state is IDLE
    rig.activate()


def test_a_restarted_host_takes_over_after_the_fault(active: GateRig) -> None:
    active.wait(100)
    assert active.send(session=2) == "at_fault"
    assert active.send(session=2, enable=False) == "accepted"
    assert active.send(session=2) == "accepted"
    active.step()
    assert active.gate.session == 2
    assert active.forces[-1] == 0.0


def test_a_fault_left_by_one_host_does_not_enable_another(active: GateRig) -> None:
    active.wait(100)
    active.send(session=2, enable=False)
    assert active.state is IDLE
    assert active.send(session=1) == "not_disabled_first"


def test_a_fault_takes_back_what_an_earlier_disable_allowed(rig: GateRig) -> None:
    rig.send(session=1, enable=False)
    rig.gate.fail()
    rig.send(session=2, enable=False)
    assert rig.state is IDLE
    assert rig.send(session=1) == "not_disabled_first"


def test_of_two_hosts_the_second_waits_and_begins_again(rig: GateRig) -> None:
    rig.send(session=2, enable=False)
    rig.activate()
    assert rig.send(session=2) == "foreign_session"
    rig.send(enable=False)
    rig.wait(25)
    assert rig.state is IDLE
    assert rig.send(session=2) == "not_disabled_first"


def test_a_command_that_lives_no_time_shows_nothing_and_faults(rig: GateRig) -> None:
    rig.send(enable=False)
    rig.send(ttl_s=0.0)
    assert not rig.step().any()
    assert not rig.step().any()
    assert (rig.state, rig.fault) == (FAULT, Fault.STALE)


def test_a_long_life_is_cut_to_what_the_device_allows() -> None:
    rig = GateRig(max_ttl_s=0.05)
    rig.activate(ttl_s=4000.0)
    rig.wait(80)
    assert_latched(rig, Fault.STALE)


def test_hardware_at_fault_is_zero_at_once(active: GateRig) -> None:
    active.gate.fail()
    assert not active.gate.F_Ho_B.any()
    assert not active.step().any()
    assert_latched(active, Fault.DEVICE)


def test_the_first_cause_of_a_fault_is_kept(active: GateRig) -> None:
    active.gate.fail()
    active.step(np.full(6, np.nan))
    assert active.fault is Fault.DEVICE


def test_a_wrench_that_jumps_back_and_forth_stays_within_its_share(
    rig: GateRig,
) -> None:
    rig.send(enable=False)
    for i in range(100):
        rig.send(1e9 * (-1) ** i)
        share = rig.gate.scale
        assert abs(rig.step()[5]) <= MAX_FORCE_N * (share + 0.0051)


@pytest.mark.parametrize(
    ("limit", "value"),
    [
        ("max_force_N", -1.0),
        ("max_force_N", np.nan),
        ("max_torque_Nm", np.inf),
        ("max_speed_m_per_s", 0.0),
        ("max_turn_rate_rad_per_s", -1.0),
        ("ramp_in_s", 0.0),
        ("ramp_out_s", 2.0),
        ("max_ttl_s", 0.0),
    ],
)
def test_a_limit_out_of_bounds_is_refused_by_name(limit: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"{limit} must be .* {limit}={value:g}"):
        GateRig(**{limit: value})


def test_arguments_of_a_wrong_shape_are_refused_by_name(rig: GateRig) -> None:
    with pytest.raises(ValueError, match=r"X_BH must be \(7,\); got shape \(6,\)"):
        rig.gate.step(0, np.zeros(6), AT_REST)
    with pytest.raises(ValueError, match=r"V_BH must be \(6,\); got shape \(2, 3\)"):
        rig.gate.step(0, X_BH, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="now_ns must be from 0"):
        rig.gate.receive(-MS, b"")


def test_a_copy_goes_its_own_way(active: GateRig) -> None:
    copy = active.gate.__deepcopy__({})
    assert isinstance(copy, _core.DeviceGate)
    copy.fail()
    assert active.state is ACTIVE
