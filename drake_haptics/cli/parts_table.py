"""What `drake-haptics run --explain` prints."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from drake_haptics.simulation.profiling import Part


def make_parts_table(parts: Sequence[Part]) -> Table:
    """Returns a table of the parts of a tick and their sum."""
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("part", no_wrap=True)
    table.add_column("why it is there")
    table.add_column("µs", justify="right", no_wrap=True)
    table.add_column("share", justify="right", no_wrap=True)

    def add_row(name: str, why: str, us: float, share: float) -> None:
        table.add_row(name, why, f"{us:.1f}", f"{100 * share:.1f} %")

    for part in parts:
        add_row(part.name, part.why, part.mean_us, part.share)
    total_us = sum(part.mean_us for part in parts)
    add_row("[bold]whole tick[/]", "", total_us, sum(part.share for part in parts))
    return table


def describe_skin(speed_m_per_s: float) -> str:
    """Returns above which speed a step skips the skin of contact.

    Args:
        speed_m_per_s: Of `drake_haptics.loop.builder.HapticDiagram`.
    """
    return (
        f"Above {speed_m_per_s:g} m/s the tool crosses contact.tolerance_m in one step:"
        " it is met as deep as the step has taken it."
    )
