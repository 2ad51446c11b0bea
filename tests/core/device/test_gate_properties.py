"""Whatever hosts send and whatever a handle does: what a gate never breaks."""

from __future__ import annotations

import numpy as np
from gate_rig import AT_REST, MAX_FORCE_N, MAX_TORQUE_NM, X_BH
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from struct_host import pack_command

from drake_haptics import _core
from drake_haptics.device.backend import GateState

RAMP_IN_S, RAMP_OUT_S, MAX_TTL_S = 0.2, 0.02, 0.1
US = 1000

any_real = st.floats(width=64)
usual = st.floats(-20, 20)
wrenches = st.one_of(
    st.tuples(*[usual] * 6),
    st.tuples(*[usual] * 6),
    st.tuples(*[any_real] * 6),
    st.tuples(*[st.sampled_from([-1.7e308, 1e308, 5e-324, -0.0, 0.188, 8.5])] * 6),
)
lives_s = st.one_of(st.just(0.02), st.floats(0, 4000))
waits_us = st.sampled_from([0, 1, 250, 1000, 1000, 1000, 10_000, 50_000, 2_000_000])
# To the next number of the session: late, twice, in order, lost, half of all ahead.
numbers = st.sampled_from([1, 1, 1, 1, 1, 0, -1, -5, 3, 2**31 - 1, 2**31])


class GateMachine(RuleBasedStateMachine):
    """Three hosts, damage, a handle and a clock, and books kept beside the gate."""

    def __init__(self) -> None:
        super().__init__()
        self.gate = _core.DeviceGate(
            max_force_N=MAX_FORCE_N,
            max_torque_Nm=MAX_TORQUE_NM,
            ramp_in_s=RAMP_IN_S,
            ramp_out_s=RAMP_OUT_S,
            max_ttl_s=MAX_TTL_S,
        )
        self.now_us = 0
        self.newest: dict[int, int] = {}
        self.may_enable: set[int] = set()
        self.received = 0

    def receive(self, packet: bytes, wait_us: int) -> tuple[GateState, str]:
        """Gives the gate a packet some time later.

        Whether a step or the packet itself told it the time makes no difference, and
        what is refused changes nothing but the counts.

        Returns:
            The state that the packet found, and the verdict on it.
        """
        self.now_us += wait_us
        told = self.gate.__deepcopy__({})
        told.step(self.now_us * US, X_BH, AT_REST)
        found, session = GateState(told.state), told.session
        verdict = self.gate.receive(self.now_us * US, packet)
        assert told.receive(self.now_us * US, packet) == verdict
        for name in ("state", "fault", "session", "scale", "command_sequence"):
            assert getattr(told, name) == getattr(self.gate, name)
        np.testing.assert_array_equal(told.F_Ho_B, self.gate.F_Ho_B)
        self.received += 1
        if verdict not in ("accepted", "not_finite"):
            assert (GateState(self.gate.state), self.gate.session) == (found, session)
        self.note_fault()
        return found, verdict

    def note_fault(self) -> None:
        """After a fault no host may enable before it has disabled."""
        if GateState(self.gate.state) is GateState.FAULT:
            self.may_enable.clear()

    @rule(
        session=st.integers(1, 3),
        number=numbers,
        enable=st.booleans(),
        wrench=wrenches,
        ttl_s=lives_s,
        wait_us=waits_us,
    )
    def send(self, session, number, enable, wrench, ttl_s, wait_us):
        """A command: in order, late, twice, of any host, with anything in it."""
        sequence = (self.newest.get(session, 2**32 - 5) + number) % 2**32
        packet = pack_command(
            session=session,
            sequence=sequence,
            wrench=wrench,
            enable=enable,
            ttl_s=ttl_s,
        )
        found, verdict = self.receive(packet, wait_us)
        assert (verdict == "not_finite") <= (not np.isfinite(wrench).all())
        if verdict == "not_finite":
            assert GateState(self.gate.state) is GateState.FAULT
        if verdict != "accepted":
            return
        ahead = (sequence - self.newest.get(session, sequence - 1)) % 2**32
        assert 0 < ahead < 2**31
        assert np.isfinite(wrench).all()
        assert self.gate.command_sequence == sequence
        self.newest[session] = sequence
        self.book(session, enable, found)

    def book(self, session: int, enable: bool, found: GateState) -> None:
        """Checks what an accepted command did.

        Only a disable leaves a fault; only an idle gate, which heard a disable of
        the same host since, can be enabled.
        """
        after = GateState(self.gate.state)
        if not enable:
            assert after is (found if found is GateState.ACTIVE else GateState.IDLE)
            self.may_enable.add(session)
            return
        assert after is GateState.ACTIVE
        assert self.gate.session == session
        if found is GateState.IDLE:
            assert session in self.may_enable
            assert self.gate.scale == 0.0
            self.may_enable.clear()
        assert found is not GateState.FAULT
        self.may_enable.discard(session)

    @rule(session=st.integers(1, 3))
    def disable(self, session):
        """So that most runs get to show force, and to leave a fault."""
        self.send(session, 1, False, (0.0,) * 6, 0.02, 0)

    @rule(session=st.integers(1, 3))
    def enable(self, session):
        """A sound command."""
        self.send(session, 1, True, (0.05, 0.0, 0.0, 3.0, 0.0, -4.0), 0.1, 1000)

    @rule(
        data=st.one_of(st.binary(max_size=120), st.integers(0, 703)), wait_us=waits_us
    )
    def damage(self, data, wait_us):
        """Any bytes, or a disable with one bit turned over."""
        if isinstance(data, int):
            packet = bytearray(
                pack_command(session=1, sequence=9, wrench=(0.0,) * 6, enable=False)
            )
            packet[data // 8] ^= 1 << data % 8
            data = bytes(packet)
        _, verdict = self.receive(data, wait_us)
        assert verdict.startswith(("too_", "wrong_"))

    @rule(wait_us=waits_us)
    def step(self, wait_us):
        """A tick, some time later: it changes by no more than its time allows."""
        before = self.gate.F_Ho_B
        scale, command = self.gate.scale, self.gate.command_F_Ho_B
        state = GateState(self.gate.state)
        self.now_us += wait_us
        F = self.gate.step(self.now_us * US, X_BH, AT_REST)
        np.testing.assert_array_equal(F, self.gate.F_Ho_B)
        rise = min(1e-6 * wait_us / RAMP_IN_S, 0.05)
        fall = 1e-6 * wait_us / RAMP_OUT_S
        assert -fall - 1e-9 <= self.gate.scale - scale <= rise + 1e-9
        if state is not GateState.ACTIVE:
            assert GateState(self.gate.state) is state
            assert not before.any()
        elif GateState(self.gate.state) is GateState.ACTIVE:
            np.testing.assert_allclose(F, self.gate.scale * command, atol=1e-300)
        self.note_fault()

    @rule(
        V=st.sampled_from([[0] * 5 + [9.0], [40.0] + [0] * 5, [np.nan] * 6]),
        back_us=st.sampled_from([0, 0, 1, 10**6]),
    )
    def go_wrong(self, V, back_us):
        """A handle that runs or is lost, and a clock that may go back."""
        self.now_us = max(self.now_us - back_us, 0)
        at_rest = self.gate.__deepcopy__({})
        at_rest.step(self.now_us * US, X_BH, AT_REST)
        self.gate.step(self.now_us * US, X_BH, np.array(V))
        if GateState(at_rest.state) is not GateState.IDLE or np.isnan(V).any():
            assert GateState(self.gate.state) is GateState.FAULT
        self.note_fault()

    @rule()
    def fail(self):
        """The hardware breaks."""
        self.gate.fail()
        assert GateState(self.gate.state) is GateState.FAULT
        self.note_fault()

    @precondition(lambda self: GateState(self.gate.state) is GateState.ACTIVE)
    @rule()
    def fall_silent(self):
        """Without a word it is at zero within the longest life and the ramp."""
        for _ in range(int(1e3 * (MAX_TTL_S + RAMP_OUT_S)) + 2):
            self.step(1000)
        assert GateState(self.gate.state) is not GateState.ACTIVE

    @invariant()
    def limits_hold(self):
        """Force and torque are finite and within the limits."""
        F = self.gate.F_Ho_B
        assert np.isfinite(F).all()
        assert np.linalg.norm(F[:3]) <= MAX_TORQUE_NM
        assert np.linalg.norm(F[3:]) <= MAX_FORCE_N
        assert 0.0 <= self.gate.scale <= 1.0

    @invariant()
    def force_is_shown_only_while_active(self):
        """Idle and at fault there is none."""
        state = GateState(self.gate.state)
        if state is not GateState.ACTIVE:
            assert not self.gate.F_Ho_B.any()
            assert self.gate.session == 0
        assert (state is GateState.FAULT) == (self.gate.fault != 0)

    @invariant()
    def every_packet_is_counted_once(self):
        """By its verdict."""
        assert sum(self.gate.counts.values()) == self.received
        assert self.gate.rejected == self.received - self.gate.counts["accepted"]


GateMachine.TestCase.settings = settings(stateful_step_count=40)
TestGate = GateMachine.TestCase
