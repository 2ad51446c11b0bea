"""The press table as a page, docs/verification/no-fall-through.md."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from pathlib import Path

from page_stamp import describe_commit, write_page
from press_cells import TITLES
from press_rig import GAINS, HOLD_S, LARGEST_FORCE_N, START_M

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "no-fall-through.md"
GENERATOR = Path(__file__).with_name("press_table.py")
COMMAND = f"python docs/generate/{GENERATOR.name}"

# What the tool of soft gains sinks through: walls thinner than it sinks in.
THIN = ("cup", "spoon")

_TEXT = """\
# No fall-through

**Can a tool lose contact with a solid, or get through it?** Not with the default gains
in any press or jab below; with softer gains, such as those of the shipped scenes, it
can get through walls that are thinner than the tool sinks in.

Pressed or jabbed anywhere onto a closed solid, a tool should never lose contact while
the two overlap, nor be pushed further in, nor get through. With the default gains,
which carry the device's largest force before the shapes touch, that holds for every
press below. With gains so soft that the tool sinks in, about one in a thousand loses
its contact, at rims and edges thinner than it sinks. **The gains of the shipped scenes
are softer still: with them {soft_share} get through, and of those on
cup and spoon alone {thin_share}.** The cup's wall is 3 mm thick and
the spoon's 2 mm, and the tool sinks in by more. A scene that must not be fallen through
leaves `contact` at its defaults. This page is written by

    {command}

Each row is one solid under one motion, at random points of its surface (seed {seed},
as many as the table of gains says) and in random orientations; point i is met by tool
i modulo {tool_count} of {tools}. The handle comes from {start:.0f} mm outside along
the normal, at 0.1 m/s until the coupling carries {force:g} N, the largest of the
device (press), or at 0.5 m/s to 10 mm inside the surface (jab); it rests {hold:g} s and
goes back the way it came. With the thin skin each tick of the way in crosses the
tolerance, so that the tool is in the solid before it has been near it. The core's own
loop runs (contacts, clusters, penalty, coupling, rigid tool at 1 kHz); what happened is
judged by the solid's triangles alone (`tests/support/press_verdict.py`).

| gains | tolerance | stiffness | {force:g} N are carried | points | commit |
|---|---|---|---|---|---|
{gains}

The gains *soft* are those of the shipped scenes, *default* those of a scene that names
none. The coupling is that of such a scene, and yields at the device's limits. Gains
that a run of the program leaves out keep the rows that they had.

- **met**: presses that touched the solid. Some points have no room for the tool.
- **lost**: presses with a tick on which tool and solid overlap and nothing pushes.
- **inward**: presses with a contact whose normal enters the surface at the solid's
  feature.
- **through**: the tool's foremost point ended beyond the far side. Tools that sink in
  slip around rims and knife edges that are thinner than they sink: contact is kept, but
  the way out is no longer the way in.
- **hooked**: after the retreat the tool was more than 1 mm from the handle, with room
  for it there: it had slipped behind an edge.
- **NaN**: a force or a pose that was not finite.
- **energy**: the contact gave more than the largest force stores in its spring.
- **deepest mm**: the deepest contact of all; negative where the spring answered before
  the shapes touched.
- **distance jumps ‰**: ticks of contact, in a thousand, on which the least distance
  changed by more than twice the tool's motion. **turns ‰**: on which a pair of pieces
  in depth turned its normal by over 60°. **force jumps ‰**: on which the force changed
  by more than three times what the motion explains, and 0.1 N. **of clusters ‰**: those
  on which no contact jumped, so that the clustering did it. **largest N**: the largest
  such change.

{rows}

Taken on {machine}; nothing here is a time.
"""


def write_presses(
    rows: Sequence[Sequence[str]], points: int, tools: Sequence[str], seed: int
) -> None:
    """Writes the page; gains that are not among the rows keep those that they had.

    Args:
        rows: Rows of press_cells.row.
        points: Number of points of each row.
        tools: Tools that met them in turn.
        seed: Seed of the points.
    """
    pressed = {row[2] for row in rows}
    kept = [list(row.values()) for row in read_rows() if row["gains"] not in pressed]
    every = sorted([*kept, *rows], key=lambda texts: (texts[2], texts[1], texts[0]))
    lines = [_line(TITLES), "|" + "---|" * len(TITLES), *map(_line, every)]
    soft = [row for row in every if row[2] == "soft"]
    page = PAGE.read_text(encoding="utf-8").splitlines()
    gains = []
    for name in GAINS:
        if name in pressed:
            gains.append(_describe_gains(name, points))
        else:
            gains += [line for line in page if line.startswith(f"| {name} |")]
    write_page(
        PAGE,
        _TEXT.format(
            soft_share=_share_through(soft),
            thin_share=_share_through([row for row in soft if row[0] in THIN]),
            command=f"{COMMAND} --points 1000 --jobs 3 --write",
            seed=seed,
            tool_count=len(tools),
            tools=", ".join(tools),
            start=1e3 * START_M,
            force=LARGEST_FORCE_N,
            hold=HOLD_S,
            gains="\n".join(gains),
            rows="\n".join(lines),
            machine=f"{platform.machine()}, {os.cpu_count()} cores",
        ),
        GENERATOR,
    )


def _describe_gains(name: str, points: int) -> str:
    gains = GAINS[name]
    return _line(
        [
            name,
            f"{1e3 * gains.tolerance_m:g} mm",
            f"{gains.stiffness_N_per_m:g} N/m",
            _carried(LARGEST_FORCE_N / gains.stiffness_N_per_m - gains.tolerance_m),
            f"{points:,}",
            describe_commit(),
        ]
    )


def _share_through(rows: Sequence[Sequence[str]]) -> str:
    """Returns how many presses got through, of all that met."""
    met, through = (
        sum(int(row[TITLES.index(title)]) for row in rows)
        for title in ("met", "through")
    )
    return f"{through} of {met:,} presses and jabs ({100 * through / met:.0f} %)"


def read_rows() -> list[dict[str, str]]:
    """The page's rows by title."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    start = lines.index(_line(TITLES)) + 2
    rows = []
    for line in lines[start:]:
        if not line.startswith("|"):
            break
        rows.append(
            dict(zip(TITLES, map(str.strip, line.split("|")[1:-1]), strict=True))
        )
    return rows


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _carried(depth_m: float) -> str:
    where = "inside" if depth_m > 0 else "before the shapes touch"
    return f"{abs(1e3 * depth_m):.2g} mm {where}"
