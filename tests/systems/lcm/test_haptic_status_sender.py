"""The status of a device, at the ends of the ranges of its numbers."""

import numpy as np
import pytest

from drake_haptics.device.gate import GateStatus
from drake_haptics.device.lcm.haptic_messages import lcmt_haptic_status
from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender


def send(buttons, rejected):
    """The status as it arrives."""
    sender = HapticStatusSender(1e-3)
    context = sender.CreateDefaultContext()
    sender.GetInputPort("X_BH").FixValue(context, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    sender.GetInputPort("V_BH").FixValue(context, np.zeros(6))
    sender.GetInputPort("buttons").FixValue(context, [float(buttons)])
    sender.GetInputPort("gate_status").FixValue(context, GateStatus(rejected=rejected))
    status = sender.GetOutputPort("lcmt_haptic_status").Eval(context)
    return lcmt_haptic_status.decode(status.encode())


@pytest.mark.parametrize("number", [0, 5, 2**31 - 1, 2**31, 2**32 - 1])
def test_each_of_32_bits_is_sent(number):
    status = send(number, number)
    assert status.buttons % 2**32 == number
    assert status.rejected % 2**32 == number


def test_the_number_of_refusals_wraps():
    assert send(0, 2**32 + 3).rejected == 3
