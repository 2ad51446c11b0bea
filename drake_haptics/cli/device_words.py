"""A device's state in the words of a status line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from drake_haptics.cockpit.holding import TakenDevice
from drake_haptics.common.one_line import count
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceReading,
    GateState,
    LinkStatus,
)

_STYLES = {
    GateState.IDLE: "dim",
    GateState.ACTIVE: "green",
    GateState.FAULT: "bold red",
}


def describe_gate(
    reading: DeviceReading | None, remedy: str = "Enter takes it up again"
) -> str:
    """Returns whether a device shows force, and if not, why and what to do.

    Args:
        reading: Its newest; None before the first.
        remedy: What to do about a fault.
    """
    if reading is None:
        return "[dim]silent[/]"
    words = reading.gate.name
    if reading.gate == GateState.FAULT:
        words += f" ({describe_fault(reading.fault.name)}): {remedy}"
    return f"[{_STYLES[reading.gate]}]{words}[/]"


def describe_held(backend: DeviceBackend | None, reading: DeviceReading | None) -> str:
    """Returns as `describe_gate`, or that the force of a device has not set in yet.

    Args:
        backend: What is held.
        reading: Its newest.
    """
    waits = isinstance(backend, TakenDevice) and backend.waits
    if waits and reading is not None and reading.gate == GateState.IDLE:
        return (
            "[yellow]WAITING: lead the handle to where the tool can follow;"
            " Enter shows the force now[/]"
        )
    return describe_gate(reading)


def describe_fault(name: str) -> str:
    """Returns the name of a `Fault` as a word."""
    return name.lower().replace("_", " ")


def describe_lateness(late_s: Sequence[float]) -> str:
    """Returns p50, p99 and p99.9, given in s, in ms."""
    return "/".join(f"{1e3 * late:.2f}" for late in late_s) + " ms"


def describe_link(link: LinkStatus) -> str:
    """Returns what was lost on the way, and how late the backend's own thread is."""
    words = f"{link.lost} lost"
    if link.rejected:
        words += f", {link.rejected} refused"
    if link.lateness_s is not None:
        words += f", servo {describe_lateness(link.lateness_s)}"
    return words


def describe_device(figures: Mapping[str, Any]) -> str:
    """Returns `DeviceWatch.to_dict` in a line; of a link only if there is one."""
    faults = [f"{n} {describe_fault(name)}" for name, n in figures["faults"].items()]
    words = [
        f"showed at most {figures['max_force_N']:.2f} N,"
        f" {1e3 * figures['max_torque_Nm']:.0f} mN·m",
        f"faults: {', '.join(faults) or 'none'}",
    ]
    if figures["received"]:
        words.insert(
            0,
            f"{count(figures['received'], 'reading')}, {figures['lost']} lost,"
            f" {figures['rejected']} refused",
        )
    return "; ".join(words)
