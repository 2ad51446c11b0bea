"""What `drake-haptics run` shows while it runs, and at the end."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import Any

import numpy as np
from pydrake.systems.framework import Context
from rich.console import Console
from rich.live import Live
from rich.table import Table

from drake_haptics.builder import HapticDiagram

_PERIOD_S = 0.2
# Energies below are rounding: a nanojoule lifts a milligram by a tenth of a
# millimetre.
_ROUNDING_J = 1e-9


class StatusLine:
    """A line at the foot of the terminal, written five times per second.

    Where the output is not a terminal it writes nothing. It has no thread of its own,
    so it never takes the interpreter from the loop between two ticks.

    Args:
        console: Where to write.
        haptic: What runs.
        clock: Reads the time, s.
    """

    def __init__(
        self,
        console: Console,
        haptic: HapticDiagram,
        clock: Callable[[], float] = time.perf_counter,
    ):
        self._haptic = haptic
        self._clock = clock
        self._live = Live(console=console, auto_refresh=False, transient=True)
        self._shown = console.is_terminal
        self._next_s = 0.0
        self._before = (0.0, 0.0)

    def __enter__(self) -> StatusLine:
        """Starts the line."""
        self._live.start()
        self._before = (self._clock(), 0.0)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Takes the line away."""
        self._live.stop()

    def update(self, context: Context) -> None:
        """Writes the line anew, if it is time; a call costs well under 1 µs else."""
        now_s = self._clock()
        if now_s < self._next_s or not self._shown:
            return
        self._next_s = now_s + _PERIOD_S
        before_s, before_t = self._before
        rate = (context.get_time() - before_t) / max(now_s - before_s, 1e-9)
        self._before = (now_s, context.get_time())
        self._live.update(self._line(context, rate), refresh=True)

    def _line(self, context: Context, rate: float) -> str:
        """Returns the line."""
        loop = self._haptic.loop
        query = loop.contact_query.GetMyContextFromRoot(context)
        contacts = loop.contact_query.get_contacts_output_port().Eval(query)
        clustering = loop.contact_clustering.GetMyContextFromRoot(context)
        clusters = loop.contact_clustering.get_clusters_output_port().Eval(clustering)
        coupling = loop.virtual_coupling.GetMyContextFromRoot(context)
        F_display = loop.virtual_coupling.get_display_wrench_output_port().Eval(
            coupling
        )
        deepest_mm = 1e3 * max(0.0, -contacts.distance.min(initial=0.0))
        return (
            f"[bold]{context.get_time():7.1f} s[/] · {rate:5.2f} x real time"
            f" · {len(contacts):3d} contacts in {len(clusters):2d} clusters"
            f" · {deepest_mm:4.2f} mm deep"
            f" · [bold]{np.linalg.norm(F_display[3:]):4.1f} N[/]"
            f" {1e3 * np.linalg.norm(F_display[:3]):4.0f} mN·m"
        )


def make_summary(figures: dict[str, Any]) -> Table:
    """Returns a table of `RunStatistics.to_dict`."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()

    def times(key: str) -> str:
        us = figures[key]
        return (
            f"median {us['median']:.0f} µs, p99 {us['p99']:.0f} µs,"
            f" p99.9 {us['p99_9']:.0f} µs"
        )

    contacts, clusters = figures["contacts"], figures["clusters"]
    table.add_row("ran", f"{figures['duration_s']:.2f} s, {figures['ticks']} ticks")
    table.add_row("whole tick", times("tick_us"))
    table.add_row("contact query", times("contact_query_us"))
    table.add_row(
        "contacts",
        f"median {contacts['median']:.0f}, at most {contacts['max']}; in clusters:"
        f" median {clusters['median']:.0f}, at most {clusters['max']}",
    )
    table.add_row(
        "largest",
        f"force {figures['max_force_N']:.2f} N,"
        f" torque {1e3 * figures['max_torque_Nm']:.0f} mN·m,"
        f" penetration {1e3 * figures['max_penetration_m']:.3f} mm",
    )
    table.add_row("device limit", f"{figures['limit_hits']} ticks at it")
    if figures["energy_J"]:
        table.add_row("energy", _describe_energy(figures["energy_J"]))
    return table


def _describe_energy(energy_J: dict[str, dict[str, float]]) -> str:
    """Returns what the hand spent, and whether a part made energy."""
    hand = energy_J["device"]
    flow = f"hand put in {1e3 * hand['in']:.1f} mJ, got back {1e3 * hand['out']:.1f} mJ"
    makers = [
        f"{name} {1e3 * part['beyond']:.2g} mJ"
        for name, part in energy_J.items()
        if name != "device" and part["beyond"] > _ROUNDING_J
    ]
    if makers:
        return f"{flow}; created beyond what sampling explains: {', '.join(makers)}"
    return f"{flow}; none created beyond what sampling explains"
