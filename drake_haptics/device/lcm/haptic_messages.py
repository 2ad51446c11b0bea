"""The LCM types of the .lcm files beside this one, whose names they have.

Those files say what each member means; other languages get theirs by `lcm-gen`.
"""

from __future__ import annotations

from dataclasses import dataclass

from drake_haptics.device.lcm.fixed_message import FixedMessage, lay_out, member


@lay_out
@dataclass(frozen=True)
class lcmt_haptic_status(FixedMessage):
    """What a haptic device tells, once per tick; all in the frame B of its base.

    Attributes:
        utime: The device's monotonic clock, µs.
        boot: Random for each start of the device, from 1 to 2³² − 1.
        sequence: Rises by one with each message.
        session: The run of a host that is served, 0 for none.
        command_sequence: The newest command of it that was accepted, 0 for none.
        pose: (7,) X_BH as [qw qx qy qz x y z], unit quaternion, m.
        velocity: (6,) V_BH as [ω; v], rad/s and m/s.
        wrench: (6,) what is shown at Ho, [τ; f], N·m and N.
        max_force: The largest force that is ever shown, N.
        max_torque: The largest torque, N·m.
        buttons: Bit i is set while button i is held.
        rejected: Commands that were refused since the start.
        gate: A `GateState`.
        fault: A `Fault`.
    """

    utime: int = member("int64_t")
    boot: int = member("int64_t")
    sequence: int = member("int64_t")
    session: int = member("int64_t")
    command_sequence: int = member("int64_t")
    pose: tuple[float, ...] = member("double", 7)
    velocity: tuple[float, ...] = member("double", 6)
    wrench: tuple[float, ...] = member("double", 6)
    max_force: float = member("double")
    max_torque: float = member("double")
    buttons: int = member("int32_t")
    rejected: int = member("int32_t")
    gate: int = member("int8_t")
    fault: int = member("int8_t")


@lay_out
@dataclass(frozen=True)
class lcmt_haptic_command(FixedMessage):
    """What a haptic device is asked for.

    Attributes:
        utime: The host's monotonic clock, µs.
        session: Random for each run of a host, from 1 to 2³² − 1.
        sequence: Rises with each message.
        time_to_live: How long this holds without a newer one, µs.
        enable: Whether the device may show force.
        wrench: (6,) on the handle at Ho in B, [τ; f], N·m and N.
    """

    utime: int = member("int64_t")
    session: int = member("int64_t")
    sequence: int = member("int64_t")
    time_to_live: int = member("int32_t")
    enable: bool = member("boolean")
    wrench: tuple[float, ...] = member("double", 6)
