"""The conversation with Haply's service in simulated time: what is shown, and when."""

import json
import math

import numpy as np
import pytest
from haply_service import HaplyService, Inverse3
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_haptics.device.backend import DeviceCommand, Fault, GateState
from drake_haptics.device.gate import LocalGate
from drake_haptics.device.haply.exchange import ASK_FOR_DEVICES, HaplyExchange

MAX_FORCE_N = 2.0
TTL_S = 0.1
RAMP_IN_S, RAMP_OUT_S = 0.2, 0.02


def command(force):
    return DeviceCommand(
        F_Ho_B=np.array([0.1, 0.2, 0.3, *force]), X_BH=np.zeros(7), V_BH=np.zeros(6)
    )


class Conversation:
    """An exchange and what it talks to, a millisecond after the other."""

    def __init__(self, *, grips=None, ttl_s=TTL_S, **options):
        self.devices = {"049D": Inverse3(mass_kg=1e3), "04EA": Inverse3(mass_kg=1e3)}
        self.service = HaplyService(self.devices, grips)
        gate = LocalGate(max_force_N=MAX_FORCE_N, max_torque_Nm=0.0, ttl_s=ttl_s)
        names = {"device_id": None, "grip_id": None, "force_field": "vector"}
        self.exchange = HaplyExchange(gate, **(names | options))
        self.now_ns = 10**9
        self.written = None

    def tick(self, text=None, after_ns=1_000_000):
        """One message and its answer; returns the force, None if none is asked."""
        self.now_ns += after_ns
        text = self.service.describe() if text is None else text
        answer = self.exchange.answer(text, self.written, self.now_ns)
        if answer == ASK_FOR_DEVICES:
            return None
        (item,) = json.loads(answer)["inverse3"]
        values = item["commands"]["set_cursor_force"]["vector"]
        return np.array([values[name] for name in "xyz"])

    def push(self, force, ticks):
        """The forces while the same one is written at each tick."""
        shown = []
        for _ in range(ticks):
            self.written = command(force)
            shown.append(self.tick())
        return np.array(shown)

    @property
    def reading(self):
        """The newest reading."""
        return self.exchange.reading

    @property
    def state(self):
        """Gate and fault of it."""
        return self.reading.gate, self.reading.fault


@pytest.fixture
def talk():
    """A conversation at 1 N along x."""
    talk = Conversation()
    talk.tick()
    talk.push((1.0, 0.0, 0.0), 300)
    return talk


def check_comes_back_when_wanted(talk):
    """The service is back: nothing is shown before a release, and then a ramp."""
    assert not talk.push((1.0, 0.0, 0.0), 300).any()
    assert talk.state == (GateState.FAULT, Fault.DEVICE)
    talk.exchange.release()
    again = talk.push((1.0, 0.0, 0.0), 400)[:, 0]
    assert again[0] == 0.0
    assert np.diff(again).max() <= 1.01e-3 / RAMP_IN_S
    assert again[-1] == pytest.approx(1.0)


def test_force_ramps_in_and_is_what_was_asked():
    talk = Conversation()
    talk.tick()
    shown = talk.push((0.0, 1.0, -1.0), 300)
    scale = np.minimum(np.arange(300) / (1e3 * RAMP_IN_S), 1.0)
    assert shown == pytest.approx(np.outer(scale, [0.0, 1.0, -1.0]), abs=1e-9)
    assert talk.state == (GateState.ACTIVE, Fault.NONE)
    assert talk.reading.F_Ho_B == pytest.approx([0.0, 0.0, 0.0, 0.0, 1.0, -1.0])
    assert talk.reading.sequence == 301


@pytest.mark.parametrize("size", [50.0, 1e308])
def test_force_keeps_its_direction_at_the_limit(size):
    talk = Conversation()
    talk.tick()
    shown = talk.push((0.6 * size, 0.0, -0.8 * size), 300)
    assert shown[-1] == pytest.approx([1.2, 0.0, -1.6])
    assert np.linalg.norm(shown, axis=1).max() <= MAX_FORCE_N


def test_a_loop_that_stops_writing_ends_at_zero_and_must_recover(talk):
    shown = np.array([talk.tick()[0] for _ in range(200)])
    first_less = int(np.argmax(shown < 1.0))
    assert first_less == pytest.approx(1e3 * TTL_S, abs=1)
    assert (shown[first_less + round(1e3 * RAMP_OUT_S) :] == 0.0).all()
    assert np.diff(shown).max() <= 0.0
    assert talk.state == (GateState.FAULT, Fault.STALE)
    assert (talk.push((1.0, 0.0, 0.0), 300) == 0.0).all()
    assert talk.state == (GateState.FAULT, Fault.STALE)
    talk.exchange.release()
    talk.tick()
    assert talk.state == (GateState.IDLE, Fault.NONE)
    shown = talk.push((1.0, 0.0, 0.0), 300)[:, 0]
    assert np.diff(shown).max() <= 1.01e-3 / RAMP_IN_S
    assert shown[-1] == pytest.approx(1.0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_wrench_that_is_not_finite_is_a_fault_that_stays(talk, value):
    assert (talk.push((value, 0.0, 0.0), 1) == 0.0).all()
    assert talk.state == (GateState.FAULT, Fault.NOT_FINITE)
    assert (talk.push((1.0, 0.0, 0.0), 300) == 0.0).all()


def test_a_handle_that_is_too_fast_is_a_fault(talk):
    talk.devices["049D"].v = np.array([0.0, 2.5, 0.0])
    assert (talk.push((1.0, 0.0, 0.0), 1) == 0.0).all()
    assert talk.state == (GateState.FAULT, Fault.OVERSPEED)


def test_one_damaged_message_is_counted_and_not_felt(talk):
    talk.written = command((1.0, 0.0, 0.0))
    reading = talk.reading
    assert talk.tick("{") == pytest.approx([1.0, 0.0, 0.0])
    assert talk.reading is reading
    assert talk.exchange.rejected == 1
    assert talk.push((1.0, 0.0, 0.0), 1)[0, 0] == pytest.approx(1.0)


@pytest.mark.parametrize("text", ["{", "{}", '{"inverse3": []}'])
def test_when_nothing_usable_comes_the_device_is_at_fault(talk, text):
    shown = []
    for _ in range(150):
        talk.written = command((1.0, 0.0, 0.0))
        shown.append(talk.tick(text))
    assert shown[-1] is None
    assert talk.state == (GateState.FAULT, Fault.DEVICE)
    assert not talk.reading.F_Ho_B.any()
    assert not talk.reading.V_BH.any()
    check_comes_back_when_wanted(talk)


@pytest.mark.parametrize("text", ["{", "{}"])
@pytest.mark.parametrize("after_ns", [1_000_000, 101_000_000])
def test_a_service_is_asked_for_devices_only_after_it_was_sent_zero(
    talk, text, after_ns
):
    shown = [np.array([1.0, 0.0, 0.0])]
    while shown[-1] is not None:
        talk.written = command((1.0, 0.0, 0.0))
        shown.append(talk.tick(text, after_ns))
    assert shown[-2].tolist() == [0.0, 0.0, 0.0]
    assert talk.state == (GateState.FAULT, Fault.DEVICE)


def test_a_command_that_fell_into_a_silence_is_not_shown_after_it(talk):
    for _ in range(150):
        talk.written = command((1.0, 0.0, 0.0))
        talk.tick("{")
    assert talk.exchange.is_released
    talk.exchange.release()
    for _ in range(20):
        assert not talk.tick().any()
    assert talk.state == (GateState.IDLE, Fault.NONE)


@pytest.mark.parametrize(
    ("ttl_s", "silence_ns"), [(0.05, 101_000_000), (1.0, 101_000_000), (0.5, 2 * 10**9)]
)
def test_after_a_silence_no_force_comes_before_somebody_wants_it(ttl_s, silence_ns):
    talk = Conversation(ttl_s=ttl_s)
    talk.tick()
    talk.push((1.0, 0.0, 0.0), 300)
    talk.written = command((1.0, 0.0, 0.0))
    assert not talk.tick(after_ns=silence_ns).any()
    check_comes_back_when_wanted(talk)


@pytest.mark.parametrize("ticks", [1, 150])
def test_a_release_works_while_nothing_usable_comes(talk, ticks):
    for _ in range(ticks):
        talk.tick("{")
    talk.exchange.release()
    for _ in range(50):
        shown = talk.tick("{")
    assert shown is None or not shown.any()
    assert talk.exchange.is_released


def test_a_silence_does_not_forgive_a_fault():
    talk = Conversation()
    talk.tick()
    talk.push((math.nan, 0.0, 0.0), 1)
    talk.exchange.fall_silent()
    talk.written = command((1.0, 0.0, 0.0))
    assert not talk.tick(after_ns=500_000_000).any()
    assert talk.state == (GateState.FAULT, Fault.NOT_FINITE)


def test_without_a_grip_the_orientation_is_the_identity():
    talk = Conversation()
    talk.devices["049D"].p = np.array([0.1, 0.2, 0.3])
    talk.tick()
    assert talk.reading.X_BH.tolist() == [1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3]
    assert not talk.exchange.has_grip


def test_the_grip_gives_orientation_rate_and_buttons_and_may_fall_asleep():
    talk = Conversation(grips={"1": (1.0, 0.0, 0.0, 0.0)})
    for i in range(200):
        half = 0.5 * 3.0 * 1e-3 * i
        talk.service.grips["1"] = (math.cos(half), 0.0, math.sin(half), 0.0)
        talk.devices["049D"].v = np.array([0.1, 0.2, 0.3])
        talk.tick()
    assert talk.exchange.has_grip
    assert talk.reading.buttons == 0b010
    assert talk.reading.X_BH[:4] == pytest.approx(talk.service.grips["1"])
    assert talk.reading.V_BH == pytest.approx([0.0, 3.0, 0.0, 0.1, 0.2, 0.3])
    last = talk.reading.X_BH
    talk.service.grips["1"] = None
    talk.tick()
    assert talk.reading.X_BH == pytest.approx(last)
    assert talk.reading.V_BH == pytest.approx([0.0, 0.0, 0.0, 0.1, 0.2, 0.3])
    assert not talk.exchange.has_grip


def test_the_device_and_grip_that_were_named():
    talk = Conversation(
        grips={"1": (1.0, 0.0, 0.0, 0.0), "2": (0.0, 1.0, 0.0, 0.0)},
        device_id="04EA",
        grip_id="2",
    )
    talk.devices["04EA"].p = np.array([0.1, 0.2, 0.3])
    talk.tick()
    assert talk.reading.X_BH.tolist() == [0.0, 1.0, 0.0, 0.0, 0.1, 0.2, 0.3]
    del talk.devices["04EA"]
    other = Conversation(device_id="04EA")
    del other.devices["04EA"]
    assert other.tick() is None
    assert other.reading is None
    assert "04EA" in other.exchange.complaint


WORDS = [None, None, None, "", "{", "[]", '{"inverse3": [{"device_id": "049D"}]}', "{}"]
NUMBERS = st.floats(allow_nan=True, allow_infinity=True)


@settings(max_examples=50)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(WORDS),
            st.integers(0, 300_000_000) | st.just(1_000_000),
            st.none() | st.tuples(NUMBERS, NUMBERS, NUMBERS) | st.just((9.0, 0.0, 0.0)),
            st.booleans(),
            st.floats(-1e9, 1e9) | st.just(0.0),
        ),
        max_size=60,
    )
)
def test_whatever_happens_the_force_is_finite_and_within_the_limit(events):
    talk = Conversation()
    for text, after_ns, force, recovers, speed in events:
        if force is not None:
            talk.written = command(force)
        if recovers:
            talk.exchange.release()
        talk.devices["049D"].v = np.array([speed, 0.0, 0.0])
        shown = talk.tick(text, after_ns)
        if shown is not None:
            assert np.isfinite(shown).all()
            assert np.linalg.norm(shown) <= MAX_FORCE_N
            assert not (talk.exchange.is_released and shown.any())
