"""What `drake-haptics device` shows while it runs, and at the end."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from typing import Any

from rich.console import Console
from rich.table import Table

from drake_haptics.cli.device_words import describe_gate, describe_lateness
from drake_haptics.cli.live_line import LiveLine
from drake_haptics.common.one_line import count
from drake_haptics.device.driver import DeviceDriver

# What ends a fault of a driver.
DRIVER_REMEDY = "until the host disables it"
# Lateness in the line is that of so many latest ticks.
_LATEST = 1000


class DriverStatusLine(LiveLine):
    """The state of a driver in one line.

    Args:
        console: Where to write.
        driver: What runs.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        driver: DeviceDriver,
        clock: Callable[[], float] = time.perf_counter,
    ):
        super().__init__(console, self._make_driver_line, clock)
        self._driver = driver
        self._ticks = 0

    def _make_driver_line(self, passed_s: float) -> str:
        """Returns the line."""
        driver, reading = self._driver, self._driver.reading
        ticks = driver.pace.ticks
        rate, self._ticks = (ticks - self._ticks) / passed_s, ticks
        packets = driver.packets
        taken = packets.pop("accepted", 0)
        return " · ".join(
            [
                describe_gate(reading, DRIVER_REMEDY),
                f"[bold]{math.hypot(*reading.F_BH[3:]):4.1f} N[/]"
                f" {1e3 * math.hypot(*reading.F_BH[:3]):4.0f} mN·m",
                f"{math.hypot(*reading.V_BH[3:]):.2f} m/s",
                f"{rate:.0f} Hz",
                "late p50/p99/p99.9"
                f" {describe_lateness(driver.pace.calc_lateness(_LATEST))}",
                f"{taken} commands, {sum(packets.values())} refused",
            ]
        )


def make_driver_summary(figures: Mapping[str, Any]) -> Table:
    """Returns a table of `DeviceDriver.to_dict`."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()
    late = figures["lateness_us"]
    table.add_row(
        "ran", f"{figures['duration_s']:.2f} s, {count(figures['ticks'], 'tick')}"
    )
    table.add_row(
        "late",
        f"median {late['p50']:.0f} µs, p99 {late['p99']:.0f} µs,"
        f" p99.9 {late['p99_9']:.0f} µs, {count(late['skipped'], 'tick')} skipped",
    )
    table.add_row("packets", _count(figures["packets"]))
    table.add_row(
        "largest",
        f"force {figures['max_force_N']:.2f} of {figures['force_limit_N']:g} N,"
        f" torque {1e3 * figures['max_torque_Nm']:.0f} of"
        f" {1e3 * figures['torque_limit_Nm']:g} mN·m",
    )
    table.add_row("over limits", f"{count(figures['limit_violations'], 'tick')}")
    table.add_row("faults", _count(figures["faults"]))
    table.add_row("recovered", _count(figures["recoveries"]))
    return table


def _count(counts: Mapping[str, int]) -> str:
    """Returns what there was and how often."""
    words = [f"{n} {name.lower().replace('_', ' ')}" for name, n in counts.items()]
    return ", ".join(words) or "none"
