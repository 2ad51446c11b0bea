"""When a host asks a device for force, rule by rule."""

from dataclasses import replace

import pytest

from drake_haptics.device.backend import GateState
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status
from drake_haptics.device.lcm.lcm_device import HostHandshake

IDLE = lcmt_haptic_status(boot=1, gate=GateState.IDLE)
SESSION = 5
ACTIVE = lcmt_haptic_status(boot=1, gate=GateState.ACTIVE)
FAULT = lcmt_haptic_status(boot=1, gate=GateState.FAULT)


def heard(status, sequence):
    return replace(status, command_sequence=sequence)


def make_enabled():
    """A handshake that has come to enabling with its second command, at 0 s."""
    handshake = HostHandshake(SESSION)
    handshake.hear(IDLE, 0.0)
    assert handshake.choose(1) is False
    handshake.hear(heard(IDLE, 1), 0.0)
    assert handshake.choose(2) is True
    return handshake


def test_it_releases_until_a_release_was_heard():
    handshake = HostHandshake(SESSION)
    assert handshake.choose(1) is False
    handshake.hear(IDLE, 0.0)
    for sequence in range(2, 10):
        assert handshake.choose(sequence) is False
        handshake.hear(heard(IDLE, 0), 0.0)
    handshake.hear(heard(IDLE, 7), 0.0)
    assert handshake.choose(10) is True


def test_what_others_released_does_not_count():
    handshake = HostHandshake(SESSION)
    handshake.hear(IDLE, 0.0)
    handshake.choose(1)
    for status in (heard(IDLE, 99), heard(FAULT, 1), heard(ACTIVE, 1)):
        handshake.hear(status, 0.0)
        assert handshake.choose(2) is False


def test_a_fault_before_the_first_command_is_left_by_itself():
    handshake = HostHandshake(SESSION)
    handshake.hear(FAULT, 0.0)
    assert handshake.choose(1) is False
    handshake.hear(heard(IDLE, 1), 0.0)
    assert handshake.choose(2) is True


def test_a_later_fault_is_left_alone_until_recovery():
    handshake = make_enabled()
    handshake.hear(FAULT, 0.1)
    for _ in range(3):
        assert handshake.choose(3) is None
        handshake.hear(FAULT, 9.0)
    handshake.recover()
    assert handshake.choose(3) is False
    handshake.hear(heard(IDLE, 3), 9.0)
    assert handshake.choose(4) is True


def test_recovery_without_a_fault_changes_nothing():
    handshake = make_enabled()
    handshake.recover()
    assert handshake.choose(3) is True


def check_left_alone(handshake, boot=1):
    """Nothing is asked, whatever the device says, until somebody wants it back."""
    assert handshake.is_at_fault
    for status in (IDLE, ACTIVE, FAULT, heard(IDLE, 2)):
        handshake.hear(replace(status, boot=boot), 9.0)
        assert handshake.choose(3) is None
    handshake.recover()
    assert not handshake.is_at_fault
    assert handshake.choose(3) is False
    handshake.hear(replace(heard(IDLE, 3), boot=boot), 9.0)
    assert handshake.choose(4) is True


@pytest.mark.parametrize("before", [ACTIVE, FAULT])
def test_a_device_that_was_started_again_is_left_alone_until_recovery(before):
    handshake = make_enabled()
    handshake.hear(before, 0.1)
    handshake.hear(replace(IDLE, boot=2), 0.101)
    check_left_alone(handshake, boot=2)


def test_a_device_that_fell_silent_is_left_alone_until_recovery():
    handshake = make_enabled()
    handshake.hear(ACTIVE, 0.1)
    handshake.fall_silent()
    check_left_alone(handshake)


@pytest.mark.parametrize("now", [IDLE, replace(ACTIVE, session=6)])
def test_a_device_that_was_taken_away_is_left_alone_until_recovery(now):
    """Its fault was left by another host before it was told."""
    handshake = make_enabled()
    handshake.hear(replace(ACTIVE, session=SESSION), 0.1)
    handshake.hear(now, 0.101)
    check_left_alone(handshake)


def test_a_device_that_falls_silent_before_it_was_asked_is_waited_for():
    handshake = HostHandshake(SESSION)
    handshake.hear(IDLE, 0.0)
    assert handshake.choose(1) is False
    handshake.fall_silent()
    handshake.hear(replace(heard(IDLE, 1), boot=2), 9.0)
    assert handshake.choose(2) is False
    handshake.hear(replace(heard(IDLE, 2), boot=2), 9.0)
    assert handshake.choose(3) is True


def test_a_device_that_stays_idle_is_asked_again():
    handshake = make_enabled()
    handshake.hear(IDLE, 0.2)
    assert handshake.choose(3) is True
    handshake.hear(IDLE, 0.3)
    assert handshake.choose(4) is False
    handshake.hear(heard(IDLE, 1), 0.3)
    assert handshake.choose(5) is False
    handshake.hear(heard(IDLE, 4), 0.3)
    assert handshake.choose(6) is True


def test_one_that_was_active_has_as_long_again():
    handshake = make_enabled()
    handshake.hear(ACTIVE, 5.0)
    handshake.hear(IDLE, 5.2)
    assert handshake.choose(3) is True
    handshake.hear(IDLE, 5.3)
    assert handshake.choose(4) is False
