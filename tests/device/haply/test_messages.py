"""Messages as the vendor's pages show them, and every way to damage one."""

import copy
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_haptics.device.haply.messages import (
    HaplyMessageError,
    format_force,
    parse_state,
)

# The first message of the page "WebSocket Protocol" (version 3.5), cut down to what a
# client of forces needs, with a second device and a grip.
INVENTORY = {
    "session_id": 7,
    "inverse3": [
        {
            "device_id": "049D",
            "config": {"type": "inverse3", "handedness": "right"},
            "state": {
                "cursor_position": {"x": 0.01, "y": -0.12, "z": 0.15},
                "cursor_velocity": {"x": 1.0, "y": 2, "z": -3.0},
                "current_cursor_force": {"x": 0.0, "y": 0.0, "z": 0.0},
                "control_mode": "idle",
            },
            "status": {"calibrated": True},
        },
        {
            "device_id": "04EA",
            "state": {
                "cursor_position": {"x": 0.5, "y": 0.6, "z": 0.7},
                "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0},
            },
        },
    ],
    "wireless_verse_grip": [
        {
            "device_id": "61573",
            "state": {
                "orientation": {"x": 0.1, "y": 0.2, "z": 0.3, "w": 0.9273618},
                "buttons": {"a": True, "b": False, "c": True},
            },
        }
    ],
}


def damaged(path, value):
    """The inventory as text, with one place of it replaced; ... takes it away."""
    message = copy.deepcopy(INVENTORY)
    place = message
    for key in path[:-1]:
        place = place[key]
    if value is ...:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return json.dumps(message)


def test_a_state_as_the_vendor_shows_it():
    state = parse_state(json.dumps(INVENTORY))
    assert state.device_id == "049D"
    assert state.position == (0.01, -0.12, 0.15)
    assert state.velocity == (1.0, 2.0, -3.0)
    assert state.orientation == pytest.approx((0.9273618, 0.1, 0.2, 0.3), abs=1e-7)
    assert sum(x * x for x in state.orientation) == pytest.approx(1.0, abs=1e-15)
    assert state.buttons == 0b101


def test_devices_are_told_apart_by_their_name():
    text = json.dumps(INVENTORY)
    assert parse_state(text, device_id="04EA").position == (0.5, 0.6, 0.7)
    assert parse_state(text, device_id="0000") is None
    assert parse_state(text, grip_id="61573").orientation is not None
    assert parse_state(text, grip_id="1").orientation is None
    assert parse_state("{}") is None
    assert parse_state('{"inverse3": []}') is None


@pytest.mark.parametrize(
    "text",
    [
        damaged(["wireless_verse_grip"], ...),
        damaged(["wireless_verse_grip"], []),
        damaged(["wireless_verse_grip", 0, "state"], ...),
        damaged(["wireless_verse_grip", 0, "state", "orientation"], ...),
    ],
)
def test_without_a_grip_there_is_no_orientation(text):
    state = parse_state(text)
    assert state.orientation is None
    assert state.buttons == 0


def test_a_grip_with_a_wire_is_one_too():
    message = copy.deepcopy(INVENTORY)
    message["verse_grip"] = message.pop("wireless_verse_grip")
    assert parse_state(json.dumps(message)).buttons == 0b101


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no json",
        "[]",
        "null",
        "[" * 100_000,
        b"\xff\xfe\xff",
        json.dumps(INVENTORY)[:-1],
        '{"inverse3": {}}',
        '{"inverse3": [3]}',
        '{"inverse3": [{"device_id": "049D"}]}',
        damaged(["inverse3", 0, "device_id"], ...),
        damaged(["inverse3", 0, "state"], []),
        damaged(["inverse3", 0, "state", "cursor_position"], ...),
        damaged(["inverse3", 0, "state", "cursor_position", "y"], ...),
        damaged(["inverse3", 0, "state", "cursor_position", "y"], "0.1"),
        damaged(["inverse3", 0, "state", "cursor_position", "y"], None),
        damaged(["inverse3", 0, "state", "cursor_position", "y"], True),
        damaged(["inverse3", 0, "state", "cursor_position", "y"], float("nan")),
        damaged(["inverse3", 0, "state", "cursor_velocity"], ...),
        damaged(["inverse3", 0, "state", "cursor_velocity", "x"], float("inf")),
        damaged(["inverse3", 0, "state", "cursor_velocity", "x"], 10**400),
        damaged(["wireless_verse_grip"], {}),
        damaged(["wireless_verse_grip", 0], []),
        damaged(["wireless_verse_grip", 0, "state", "orientation"], []),
        damaged(["wireless_verse_grip", 0, "state", "orientation", "w"], ...),
        damaged(["wireless_verse_grip", 0, "state", "orientation", "w"], 0.0),
        damaged(["wireless_verse_grip", 0, "state", "orientation", "x"], float("nan")),
    ],
)
def test_what_is_damaged_is_refused(text):
    with pytest.raises(HaplyMessageError):
        parse_state(text)


@given(st.text(max_size=200) | st.binary(max_size=200))
def test_any_text_is_read_or_refused(text):
    try:
        assert parse_state(text) is None
    except HaplyMessageError:
        pass


@pytest.mark.parametrize("field", ["vector", "values"])
def test_a_force_as_the_vendor_shows_it(field):
    """Page "Control Commands", version 3.5; `values` in the tutorial for 3.1."""
    assert json.loads(format_force("049D", (0.0, 0.0, 1.5), field)) == {
        "inverse3": [
            {
                "device_id": "049D",
                "commands": {
                    "set_cursor_force": {field: {"x": 0.0, "y": 0.0, "z": 1.5}}
                },
            }
        ]
    }


def test_a_force_that_is_not_finite_is_never_sent():
    with pytest.raises(ValueError, match="JSON"):
        format_force("049D", (0.0, float("nan"), 0.0), "vector")
