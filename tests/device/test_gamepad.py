"""What sticks and buttons mean, and that nonsense means nothing."""

import numpy as np
import pytest

from drake_haptics.device.gamepad import GamepadReader

RIGHT, UP = 1.0, -1.0  # As browsers count a stick's axes: right and down.


@pytest.mark.parametrize(
    ("axes", "speeds"),
    [
        ([RIGHT, 0, 0, 0], [1, 0, 0, 0, 0, 0]),
        ([0, UP, 0, 0], [0, 1, 0, 0, 0, 0]),
        ([0, 0, 0, UP], [0, 0, 1, 0, 0, 0]),
        # To the right is clockwise, seen from above.
        ([0, 0, RIGHT, 0], [0, 0, 0, 0, 0, -1]),
    ],
)
def test_sticks_move(axes, speeds):
    np.testing.assert_array_equal(GamepadReader().read_sticks(axes), speeds)


@pytest.mark.parametrize(
    ("axes", "tilts_towards"),
    [([RIGHT, 0, 0, 0], [1, 0, 0]), ([0, UP, 0, 0], [0, 1, 0])],
)
def test_sticks_tilt_towards_where_they_point(axes, tilts_towards):
    reader = GamepadReader()
    reader.read_buttons([1.0])
    speeds = reader.read_sticks(axes)
    np.testing.assert_array_equal(speeds[:3], 0)
    # How an upright axis moves when it turns so.
    np.testing.assert_array_equal(np.cross(speeds[3:], [0, 0, 1]), tilts_towards)


def test_a_stick_near_its_middle_is_at_rest_and_starts_from_zero_beyond():
    reader = GamepadReader()
    assert not reader.read_sticks([0.119, -0.119, 0.119, -0.119]).any()
    assert reader.read_sticks([0.121, 0, 0, 0])[0] == pytest.approx(0.001 / 0.88)
    assert reader.read_sticks([-0.56, 0, 0, 0])[0] == pytest.approx(-0.5)


@pytest.mark.parametrize(
    "axes", [[], [0.0], [np.nan] * 4, [np.inf, -np.inf, 1e308, 1.01]]
)
def test_what_is_no_stick_asks_for_nothing(axes):
    assert not GamepadReader().read_sticks(axes).any()


def test_buttons_act_when_they_go_down():
    reader = GamepadReader()
    assert reader.read_buttons([0.0, 1.0, 0.0, 0.9]) == (0b1010, True)
    assert reader.read_buttons([0.0, 1.0, 0.0, 0.0]) == (0b0010, False)
    assert reader.read_buttons([0.0, 0.0]) == (0, False)
    assert reader.read_buttons([0.0, 1.0]) == (0b0010, True)


def test_the_first_button_switches_between_moving_and_turning():
    reader = GamepadReader()
    for held, turns in [(1.0, True), (1.0, True), (0.0, True), (1.0, False)]:
        reader.read_buttons([held])
        assert reader.turns == turns


def test_more_buttons_than_there_are_bits_and_no_numbers_are_let_be():
    assert GamepadReader().read_buttons([np.nan] * 2 + [1.0] * 100) == (
        2**32 - 4,
        False,
    )
