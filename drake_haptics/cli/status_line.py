"""Writes status lines and summaries of `run` and `device`."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from pydrake.systems.framework import Context
from rich.console import Console
from rich.table import Table

from drake_haptics.cli.console import show_facts
from drake_haptics.cli.live_line import LiveLine
from drake_haptics.cockpit.handle_holder import SoftStartDevice
from drake_haptics.common.one_line import count, depth
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceReading,
    Fault,
    GateState,
    LinkStatus,
)
from drake_haptics.device.driver import DeviceDriver
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.simulation.device_monitor import SILENT_S, SilenceMonitor
from drake_haptics.systems.contact.load_shedding import SHED_STAGES

_STYLES = {
    GateState.IDLE: "dim",
    GateState.ACTIVE: "green",
    GateState.FAULT: "bold red",
}
_ENABLE = "Enter enables it again"
# The host or the driver stood still; no request reaches a driver that has ended.
_REMEDIES = {Fault.STALE: f"while its driver runs, {_ENABLE}"}


def describe_gate(reading: DeviceReading | None, remedy: str = "") -> str:
    """Returns whether a device shows force, and if not, why and what to do.

    Args:
        reading: The newest reading; None before the first.
        remedy: Advice about a fault. Defaults to that of a host, by the fault.
    """
    if reading is None:
        return "[dim]silent[/]"
    words = reading.gate.name
    if reading.gate == GateState.FAULT:
        remedy = remedy or _REMEDIES.get(reading.fault, _ENABLE)
        words += f" ({describe_fault(reading.fault.name)}): {remedy}"
    return f"[{_STYLES[reading.gate]}]{words}[/]"


def describe_held(backend: DeviceBackend | None, reading: DeviceReading | None) -> str:
    """Returns `describe_gate`, or that the device is not yet enabled."""
    waits = isinstance(backend, SoftStartDevice) and backend.waits
    if waits and reading is not None and reading.gate == GateState.IDLE:
        return (
            "[yellow]WAITING: lead the handle to where the tool can follow;"
            " Enter shows the force now[/]"
        )
    return describe_gate(reading)


def describe_fault(name: str) -> str:
    """Returns a name, such as that of a `Fault`, as words."""
    return name.lower().replace("_", " ")


def describe_lateness(late_s: Sequence[float]) -> str:
    """Returns p50, p99 and p99.9, given in s, as text in ms."""
    return "/".join(f"{1e3 * late:.2f}" for late in late_s) + " ms"


def describe_link(link: LinkStatus) -> str:
    """Returns how many readings were lost, and how late the backend's thread is."""
    words = f"{link.lost} lost"
    if link.rejected:
        words += f", {link.rejected} refused"
    if link.lateness_s is not None:
        words += f", servo {describe_lateness(link.lateness_s)}"
    if link.solved:
        words += f", {link.solved_late} of {count(link.solved, 'contact step')} late"
    return words


def describe_device(figures: Mapping[str, Any]) -> str:
    """Returns a line with the figures of `DeviceWatch.to_dict`."""
    words = [
        f"showed at most {figures['max_force_N']:.2f} N,"
        f" {1e3 * figures['max_torque_Nm']:.0f} mN·m",
        f"faults: {_count_each(figures['faults'])}",
    ]
    if figures["received"]:
        words.insert(
            0,
            f"{count(figures['received'], 'reading')}, {figures['lost']} lost,"
            f" {figures['rejected']} refused",
        )
    if figures["solved"]:
        words.append(
            f"{figures['solved_late']} of"
            f" {count(figures['solved'], 'contact step')} of its servo late"
        )
    return "; ".join(words)


# Smaller energies are round-off: a nanojoule lifts a milligram by 0.1 mm.
_ROUNDING_J = 1e-9
# So many contacts mostly mean that faces of many triangles lie on each other.
_MANY_CONTACTS = 100
# Ticks enough for a p99 that is not that of one or two.
_MANY_TICKS = 500
# Number of latest ticks whose lateness is in the line.
_LATEST = 1000


class StatusLine(LiveLine):
    """Shows the state of a run in one line."""

    def __init__(
        self,
        console: Console,
        haptic: HapticDiagram,
        pace: RealTimePacer | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ):
        super().__init__(console, self._make_run_line, clock)
        self._haptic = haptic
        self._pace = pace
        self._context: Context | None = None
        self._before_s = 0.0
        self._silence = SilenceMonitor()

    def follow(self, haptic: HapticDiagram) -> None:
        """Describes another diagram from now on."""
        self._haptic = haptic

    def end_tick(self, context: Context) -> None:
        """Writes the line again, if it is time."""
        self._context = context
        self.update()

    def _make_run_line(self, passed_s: float) -> str:
        assert self._context is not None
        time_s = self._context.get_time()
        # A scene that begins again is at an earlier time.
        run_s, self._before_s = max(0.0, time_s - self._before_s), time_s
        backend = self._haptic.backend
        force, how_deep, contacts = self._describe_touch(self._context)
        relief = self._describe_relief(self._context)
        if backend is None or self._pace is None:
            speed = f"{run_s / passed_s:5.2f} x real time"
            parts = [speed, force, how_deep, *relief, contacts]
        else:
            reading = backend.read()
            if reading is None or reading.gate != GateState.ACTIVE:
                force += " [dim](not shown)[/]"
            ticks = run_s / self._haptic.period_s
            late_s = self._pace.calc_lateness(_LATEST)
            # What matters most comes first, because a narrow terminal leaves out the
            # rest.
            parts = [
                self._describe_device(reading, passed_s),
                force,
                how_deep,
                *relief,
                contacts,
                f"{ticks / passed_s:.0f} Hz",
                f"late p50/p99/p99.9 {describe_lateness(late_s)}",
                describe_link(backend.get_link_status()),
            ]
        return " · ".join([f"[bold]{time_s:7.1f} s[/]", *parts])

    def _describe_device(self, reading: DeviceReading | None, passed_s: float) -> str:
        """Returns whether the device shows force, and whether its driver is silent."""
        silent_s = self._silence.add(reading, passed_s)
        if silent_s < SILENT_S:
            return describe_held(self._haptic.backend, reading)
        silence = f"silent for {silent_s:.0f} s, is its driver running?"
        return describe_gate(reading, silence)

    def _describe_relief(self, context: Context) -> list[str]:
        """Returns what is dropped because ticks take too long, if anything is."""
        shedding = self._haptic.loop.load_shedding
        if shedding is None:
            return []
        state = shedding.GetMyContextFromRoot(context).get_discrete_state_vector()
        shed = state.value()[0]
        stages = [name for stage, name in enumerate(SHED_STAGES) if shed > stage]
        return [f"[yellow]leaves out {', '.join(stages)}[/]"] if stages else []

    def _describe_touch(self, context: Context) -> tuple[str, str, str]:
        """Returns the felt wrench, the depth of the tool, and the count of contacts."""
        loop = self._haptic.loop
        found = loop.found_contacts
        contacts = found.Eval(found.get_system().GetMyContextFromRoot(context))
        pushing = loop.clusters
        clusters = pushing.Eval(pushing.get_system().GetMyContextFromRoot(context))
        device = loop.device.GetMyContextFromRoot(context)
        F_Ho_W_rendered = loop.device.GetOutputPort("F_Ho_W_rendered").Eval(device)
        deepest_m = max(0.0, -contacts.least_distance)
        return (
            f"[bold]{np.linalg.norm(F_Ho_W_rendered[3:]):4.1f} N[/]"
            f" {1e3 * np.linalg.norm(F_Ho_W_rendered[:3]):4.0f} mN·m",
            f"{depth(deepest_m, 2)} deep",
            f"{count(len(contacts), 'contact')}, {count(len(clusters), 'cluster')}",
        )


def make_summary(figures: dict[str, Any]) -> Table:
    """Returns a table of `RunStatistics.to_dict`."""
    contacts, clusters = figures["contacts"], figures["clusters"]
    times, late = _describe_times(figures["tick_us"]), figures["lateness_us"]
    facts = {
        "ran": f"{figures['duration_s']:.2f} s, {count(figures['ticks'], 'tick')}",
        "whole tick": times + _explain_slow_ticks(figures),
        "contact query": _describe_times(figures["contact_query_us"]),
    }
    if late:
        skipped = count(late["skipped"], "tick")
        facts["late"] = f"{_describe_times(late)}; {skipped} skipped"
    facts["contacts"] = (
        f"median {contacts['median']:.0f}, at most {contacts['max']}; in clusters:"
        f" median {clusters['median']:.0f}, at most {clusters['max']}"
    )
    facts["largest commanded" if figures.get("device") else "largest"] = (
        f"force {figures['max_force_N']:.2f} N,"
        f" torque {1e3 * figures['max_torque_Nm']:.0f} mN·m,"
        f" penetration {depth(figures['max_penetration_m'])}"
        f"{_explain_near_force(figures)}"
    )
    if any(figures["shed_ticks"].values()):
        facts["left out"] = ", ".join(
            f"{name} in {count(ticks, 'tick')}"
            for name, ticks in figures["shed_ticks"].items()
        )
    facts["device limit"] = f"{count(figures['limit_hits'], 'tick')} at the limit"
    if device := figures.get("device"):
        facts["device"] = describe_device(device)
    if figures["energy_J"]:
        facts["energy"] = _describe_energy(figures["energy_J"])
    return show_facts(facts.items())


def _explain_slow_ticks(figures: dict[str, Any]) -> str:
    """Returns what to do if many ticks take longer than their period, or nothing."""
    period_us = 1e6 * figures["duration_s"] / max(1, figures["ticks"])
    # The first tick loads and allocates.
    if figures["ticks"] < _MANY_TICKS or figures["tick_us"]["p99"] <= period_us:
        return ""
    advice = "docs/troubleshooting.md, Late ticks"
    if figures["contacts"]["max"] >= _MANY_CONTACTS:
        advice = f"fewer triangles (max_triangles) make fewer contacts; {advice}"
    return f": too slow for ticks of {period_us:.0f} µs; {advice}"


def _describe_times(us: Mapping[str, float]) -> str:
    median = us["median"] if "median" in us else us["p50"]
    return f"median {median:.0f} µs, p99 {us['p99']:.0f} µs, p99.9 {us['p99_9']:.0f} µs"


def _explain_near_force(figures: dict[str, Any]) -> str:
    """Returns an explanation of force without penetration; empty without one."""
    distance_m = figures["least_distance_m"]
    is_constraint = figures.get("contact_law") == "constraint"
    key = "contact.skin_m" if is_constraint else "contact.tolerance_m"
    if distance_m is None or distance_m < 0.0 or figures["max_force_N"] == 0.0:
        return ""
    return f"; the surfaces came within {depth(distance_m)}: force begins at {key}"


def _describe_energy(energy_J: dict[str, dict[str, float]]) -> str:
    """Returns the energy that the hand put in, and whether a part created energy."""
    hand = energy_J["device"]
    flow = f"hand put in {1e3 * hand['in']:.1f} mJ, got back {1e3 * hand['out']:.1f} mJ"
    created_J = {
        name: part["beyond"]
        for name, part in energy_J.items()
        if part["beyond"] > _ROUNDING_J
    }
    felt_J = created_J.pop("device", 0.0)
    if not created_J and not felt_J:
        return f"{flow}; good: no part made energy beyond what sampling explains"
    makers = [f"{name} {1e3 * made:.2g} mJ" for name, made in created_J.items()]
    made = f"made beyond what sampling explains: {', '.join(makers) or 'no part'}"
    if not felt_J:
        most = _describe_share(max(created_J.values()), hand["in"])
        return f"{flow}; {made}, at most {most}; good: the loop as a whole made none"
    felt = f"{1e3 * felt_J:.2g} mJ, {_describe_share(felt_J, hand['in'])}"
    return (
        f"{flow}; {made}; the loop as a whole made {felt}; if the hand feels it as"
        " vibration, lower contact or coupling gains"
    )


def _describe_share(part_J: float, whole_J: float) -> str:
    if whole_J <= _ROUNDING_J:
        return "and the hand put in none"
    return f"{100.0 * part_J / whole_J:.2g} % of what the hand put in"


# How a fault of a driver ends.
DRIVER_REMEDY = "until the host disables it"


class DriverStatusLine(LiveLine):
    """Shows the state of a driver in one line."""

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
        driver, reading = self._driver, self._driver.reading
        ticks = driver.pace.ticks
        rate, self._ticks = (ticks - self._ticks) / passed_s, ticks
        packets = driver.packets
        taken = packets.pop("accepted", 0)
        return " · ".join(
            [
                describe_gate(reading, DRIVER_REMEDY),
                f"[bold]{math.hypot(*reading.F_Ho_B[3:]):4.1f} N[/]"
                f" {1e3 * math.hypot(*reading.F_Ho_B[:3]):4.0f} mN·m",
                f"{math.hypot(*reading.V_BH[3:]):.2f} m/s",
                f"{rate:.0f} Hz",
                "late p50/p99/p99.9"
                f" {describe_lateness(driver.pace.calc_lateness(_LATEST))}",
                f"{taken} commands, {sum(packets.values())} refused",
            ]
        )


def make_driver_summary(figures: Mapping[str, Any]) -> Table:
    """Returns a table of `DeviceDriver.to_dict`."""
    late = figures["lateness_us"]
    skipped = count(late["skipped"], "tick")
    facts = {
        "ran": f"{figures['duration_s']:.2f} s, {count(figures['ticks'], 'tick')}",
        "late": f"{_describe_times(late)}, {skipped} skipped",
        "packets": _count_each(figures["packets"]),
        "largest": f"force {figures['max_force_N']:.2f} of"
        f" {figures['force_limit_N']:g} N, torque"
        f" {1e3 * figures['max_torque_Nm']:.0f} of"
        f" {1e3 * figures['torque_limit_Nm']:g} mN·m",
        "over limits": count(figures["limit_violations"], "tick"),
        "faults": _count_each(figures["faults"]),
        "recovered": _count_each(figures["recoveries"]),
    }
    return show_facts(facts.items())


def _count_each(counts: Mapping[str, int]) -> str:
    words = [f"{n} {describe_fault(name)}" for name, n in counts.items()]
    return ", ".join(words) or "none"
