"""Help of the commands: examples, exit codes and what to try next.

A group lists its commands, and finds the one that is called, without importing the
others.
"""

from __future__ import annotations

import difflib
import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click


@dataclass(frozen=True)
class Lesson:
    """The part of `--help` below the options.

    Attributes:
        examples: Purpose of each example, and its command line.
        exits: Meaning of the exit codes, in a sentence.
        further: Suggestions what to try next.
    """

    examples: Sequence[tuple[str, str]]
    exits: str = ""
    further: str = ""

    def format(self, formatter: click.HelpFormatter) -> None:
        """Writes the sections."""
        with formatter.section("Examples"):
            for what, words in self.examples:
                formatter.write_text(f"{what}:")
                # Not wrapped: it is to be copied.
                formatter.write(f"{'':{formatter.current_indent + 2}}{words}\n")
        for title, text in [("Exit code", self.exits), ("Next", self.further)]:
            if text:
                with formatter.section(title):
                    formatter.write_text(text)


class CommandWithExamples(click.Command):
    """A command whose `--help` ends with a lesson."""

    def __init__(self, *args: Any, lesson: Lesson, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.lesson = lesson

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes the lesson."""
        self.lesson.format(formatter)


# By heading, then by name: the module that holds the command under the same name,
# and its line in --help.
Commands = Mapping[str, Mapping[str, tuple[str, str]]]


class LazyGroup(click.Group):
    """Imports a command on demand, so that a light one never imports Drake."""

    def __init__(
        self, *, commands_by_heading: Commands, lesson: Lesson, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.lesson = lesson
        self._by_heading = commands_by_heading
        self._by_name = {
            name: entry
            for commands in commands_by_heading.values()
            for name, entry in commands.items()
        }

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Returns the names without importing anything."""
        return list(self._by_name)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Imports the command of that name."""
        if cmd_name not in self._by_name:
            return None
        module = importlib.import_module(self._by_name[cmd_name][0])
        return getattr(module, cmd_name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Finds the command that is called, or says which was probably meant."""
        if args and args[0] not in self._by_name and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], self._by_name, n=1)
            hint = (
                f"did you mean '{near[0]}'?"
                if near
                else f"there are {', '.join(self._by_name)}"
            )
            raise click.UsageError(f"No such command '{args[0]}'; {hint}", ctx)
        return super().resolve_command(ctx, args)

    def shell_complete(
        self, ctx: click.Context, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """Completes names without importing the commands."""
        names = [
            click.shell_completion.CompletionItem(name, help=line)
            for name, (_, line) in self._by_name.items()
            if name.startswith(incomplete)
        ]
        return names + click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Writes the list of commands without importing them."""
        widest = max(map(len, self._by_name))
        for heading, commands in self._by_heading.items():
            with formatter.section(heading):
                formatter.write_dl(
                    [(f"{name:{widest}}", line) for name, (_, line) in commands.items()]
                )

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes the lesson."""
        self.lesson.format(formatter)


_UNUSABLE = "1: an input cannot be used; the message says why"

RUN = Lesson(
    examples=[
        ("The spoon in the cup, in the browser", "drake-haptics run cup_spoon"),
        ("Move the spoon yourself", "drake-haptics run cup_spoon --device mouse:"),
        (
            "Your own meshes, in millimeters",
            "drake-haptics run --tool pen.stl --environment mug.stl --unit mm",
        ),
        (
            "Another value, and the scene written to a file at the end",
            "drake-haptics run can_box --set hand.grip=firm --write-scene my.yaml",
        ),
        (
            "Five seconds, recorded as a web page, without a browser",
            "drake-haptics run cup_spoon --headless --duration 5 --record cup.html",
        ),
    ],
    exits=f"0: at the end, or at Ctrl-C. {_UNUSABLE}. 3: the simulation became"
    " unstable.",
    further="On a computer without a browser: `ssh -N -L 7100:localhost:7100 -L"
    " 7000:localhost:7000 HOST` brings the page to yours, or use --record."
    " `stability SCENE` computes how stiff a scene may be.",
)

DEVICE = Lesson(
    examples=[
        ("In one terminal", "drake-haptics device cup_spoon"),
        (
            "In another",
            "drake-haptics run cup_spoon --device udp://127.0.0.1:7400",
        ),
    ],
    exits=f"0: at the end, or at Ctrl-C. {_UNUSABLE}.",
    further="End either of the two, or pause `run` with Ctrl-Z, and watch the other."
    " docs/device-protocol.md shows how to write a driver for your own arm.",
)

SCENES = Lesson(
    examples=[("All scenes", "drake-haptics scenes")],
    further="`drake-haptics run SCENE` runs one. The files, to copy and change, are in"
    " models/scenes.",
)

DEVICES = Lesson(
    examples=[
        ("All devices", "drake-haptics devices"),
        ("All figures", "drake-haptics devices --json -"),
    ],
    further="A scene file names one under `device: {preset: NAME}`. docs/device-twin.md"
    " says how to write one for your own arm.",
)

CHECK = Lesson(
    examples=[
        ("A mesh in meters", "drake-haptics check cup.obj"),
        ("One in millimeters", "drake-haptics check cup.obj --unit mm"),
        (
            "In a script: fail if there is a defect",
            "drake-haptics check cup.obj --strict --json cup.json",
        ),
    ],
    exits=f"0: the mesh can be used. {_UNUSABLE}; or, with --strict, the mesh has a"
    " defect.",
    further="`decompose MESH --show` shows its convex pieces in the browser,"
    " `run --tool MESH --environment MESH` touches it.",
)

DECOMPOSE = Lesson(
    examples=[
        ("Exactly; the result is kept on disk", "drake-haptics decompose cup.obj"),
        (
            "Fewer pieces, within a tenth of a millimeter",
            "drake-haptics decompose cup.obj --method merged --error 1e-4",
        ),
        (
            "Pieces in colors, as a web page",
            "drake-haptics decompose cup.obj --html pieces.html",
        ),
    ],
    exits=f"0: done. {_UNUSABLE}. 130: Ctrl-C; no file is left half written.",
    further="`run` cuts the meshes of a scene itself, and reuses stored results."
    " docs/geometry.md compares the methods.",
)

STABILITY = Lesson(
    examples=[
        ("Verdict, limits and a page", "drake-haptics stability cup_spoon"),
        (
            "Without the map, which takes most of the time",
            "drake-haptics stability cup_spoon --map 0",
        ),
    ],
    exits=f"0: done. {_UNUSABLE}. 130: Ctrl-C; with --store the same"
    " command continues the map.",
    further="--set coupling.stiffness_N_per_m=1200 tries another stiffness."
    " docs/stability.md explains the page.",
)

ACCURACY = Lesson(
    examples=[
        ("The price list, some seconds", "drake-haptics accuracy sphere_pen --quick"),
        (
            "A scene whose ticks take at most 400 µs",
            "drake-haptics accuracy cup_spoon --budget-us 400 --write faster.yaml",
        ),
        (
            "One setting alone",
            "drake-haptics accuracy sphere_pen --quick --only contact.tolerance_m=1e-3",
        ),
    ],
    exits=f"0: done. {_UNUSABLE}. 3: no setting keeps the budget. 130: Ctrl-C; with"
    " --store the same command continues.",
    further="`drake-haptics run faster.yaml` runs the scene that --budget-us wrote."
    " docs/accuracy.md explains the list.",
)

BENCH = Lesson(
    examples=[
        ("Whole ticks, some seconds", "drake-haptics bench loop --quick"),
        ("All of it, some minutes", "drake-haptics bench"),
    ],
    exits=f"0: done. {_UNUSABLE}.",
    further='Other libraries come with pip install "drake_haptics[peers]".'
    " docs/benchmarks.md explains the measurements.",
)

PAPER = Lesson(
    examples=[
        ("One table, at once", "drake-haptics paper table1"),
        ("All of it, some minutes", "drake-haptics paper --out paper.html"),
    ],
    exits=f"0: done, whatever agrees or differs. {_UNUSABLE}.",
    further="docs/paper.md explains the figures.",
)

LOG_INFO = Lesson(
    examples=[("The contents of a log", "drake-haptics log info run.tick")],
    exits=f"0: done, also of a log with gaps. {_UNUSABLE}.",
    further="`drake-haptics log replay FILE` computes the recorded motion again.",
)

LOG_REPLAY = Lesson(
    examples=[
        ("Check that a replay gives the same", "drake-haptics log replay run.tick"),
        (
            "The same motion with another kind of depth, recorded",
            "drake-haptics log replay run.tick --log new.tick"
            " --set contact.depth=global",
        ),
    ],
    exits=f"0: done, whether the replay is the same or not. {_UNUSABLE}.",
    further="`drake-haptics log diff A B --plot FILE` draws two logs;"
    " `drake-haptics run SCENE --device replay:FILE` shows one in the browser.",
)

LOG_DIFF = Lesson(
    examples=[
        ("Where two logs differ", "drake-haptics log diff run.tick new.tick"),
        (
            "As a picture",
            "drake-haptics log diff run.tick new.tick --plot diff.png",
        ),
    ],
    exits=f"0: equal to the last bit. {_UNUSABLE}. 3: they differ.",
)

LOG_CSV = Lesson(
    examples=[
        ("For a spreadsheet", "drake-haptics log csv run.tick --out run.csv"),
        ("The first lines", "drake-haptics log csv run.tick --out - | head"),
    ],
    exits=f"0: done. {_UNUSABLE}.",
)

COMPLETION = Lesson(
    examples=[
        ("For this terminal", 'eval "$(drake-haptics completion bash)"'),
        (
            "For good",
            "echo 'eval \"$(drake-haptics completion bash)\"' >> ~/.bashrc",
        ),
    ],
    further="Try `drake-haptics run <Tab>`: scenes; after --device, kinds of devices;"
    " after --set and --only, keys of a scene.",
)
