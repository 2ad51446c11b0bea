"""A packet of each kind."""

from __future__ import annotations

from typing import Any

A_COMMAND: dict[str, Any] = {
    "session": 0x01020304,
    "sequence": 0xFFFFFFFF,
    "time_ns": 123_456_789_012_345,
    "F_Ho_B": [0.1, -0.2, 0.3, -4.0, 5.0, -6.0],
    "state_sequence": 77,
    "ttl_us": 20_000,
    "enable": True,
}
A_STATE: dict[str, Any] = {
    "session": 0x01020304,
    "sequence": 9,
    "time_ns": 2**63 + 1,
    "X_BH": [0.5, -0.5, 0.5, -0.5, 0.01, 0.02, 0.03],
    "V_BH": [1.0, 2.0, 3.0, -0.1, -0.2, -0.3],
    "F_Ho_B": [0.01, 0.02, 0.03, 1.0, 2.0, 3.0],
    "boot": 0xDEADBEEF,
    "command_sequence": 8,
    "buttons": 5,
    "rejected": 3,
    "max_force_N": 8.5,
    "max_torque_Nm": 0.1875,
    "gate": 1,
    "fault": 0,
}
