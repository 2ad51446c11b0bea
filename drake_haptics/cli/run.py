"""`drake-haptics run`."""

from __future__ import annotations

from pathlib import Path

import click
from pydrake.geometry import Meshcat
from rich.console import Console
from rich.progress import Progress, TaskID

from drake_haptics.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.cli.mesh_options import write_json
from drake_haptics.cli.status_line import StatusLine, make_summary
from drake_haptics.errors import UserError
from drake_haptics.recording import write_recording
from drake_haptics.scene import Scene, load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.simulation import RunError
from drake_haptics.simulation import run as run_haptic
from drake_haptics.stage import open_meshcat, set_stage


@click.command()
@click.argument("scene", required=False)
@click.option("--tool", help="Instead of SCENE: mesh file of the tool.")
@click.option("--environment", help="Instead of SCENE: mesh file of what it meets.")
@click.option(
    "--tool-scale",
    type=click.FloatRange(0, min_open=True),
    help="Metres per unit of the tool's file.  [default: 1]",
)
@click.option(
    "--environment-scale",
    type=click.FloatRange(0, min_open=True),
    help="Metres per unit of the environment's file.  [default: 1]",
)
@click.option(
    "--duration",
    type=click.FloatRange(0, min_open=True),
    metavar="S",
    help="Stop after so many simulated seconds.  [default: at Ctrl-C]",
)
@click.option(
    "--headless", is_flag=True, help="No page, and as fast as the computer can."
)
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Write what is to be seen as one HTML file that plays in any browser.",
)
@click.option(
    "--json",
    "json_file",
    type=click.Path(dir_okay=False, allow_dash=True),
    metavar="FILE",
    help="Write the figures as JSON; - writes them to stdout, alone.",
)
@click.option("--pieces", is_flag=True, help="Colour the convex pieces.")
@click.option(
    "--port",
    type=click.IntRange(1024, 65535),
    help="TCP port of the page.  [default: the first free one from 7000]",
)
def run(
    scene: str | None,
    tool: str | None,
    environment: str | None,
    tool_scale: float | None,
    environment_scale: float | None,
    duration: float | None,
    headless: bool,
    record: Path | None,
    json_file: str | None,
    pieces: bool,
    port: int | None,
) -> None:
    """Run a scene, or a tool mesh on another mesh, and show it in the browser.

    SCENE is the name of a shipped scene (see `drake-haptics scenes`) or a scene
    file. A simulated hand holds a simulated 6-DOF arm and moves the tool.

    Exits with 0 at the end or at Ctrl-C, with 1 if something given cannot be used,
    with 3 if the simulation became unstable.
    """
    if headless and (pieces or port) and not record:
        raise click.UsageError("--headless has no page for --pieces and --port")
    chosen = _choose_scene(scene, tool, environment, tool_scale, environment_scale)
    if record is not None and not record.absolute().parent.is_dir():
        raise UserError(f"--record: there is no folder {record.parent}")
    console = Console(highlight=False, stderr=json_file == "-")
    meshcat = None if headless and record is None else open_meshcat(port)
    haptic = _build(console, chosen, meshcat)
    visualizer = haptic.visualizer
    if meshcat is not None and visualizer is not None:
        set_stage(meshcat, haptic)
        if pieces:
            visualizer.ColorPieces()
        if record is not None:
            visualizer.StartRecording()
        if not headless:
            console.print(
                f"Open [bold]{meshcat.web_url()}[/] to see it.", soft_wrap=True
            )
            console.print("Ctrl-C ends the run.", style="dim")
    with StatusLine(console, haptic) as status:
        try:
            statistics = run_haptic(
                haptic, duration, realtime=not headless, on_tick=status.update
            )
            unstable = None
        except RunError as error:
            statistics, unstable = error.statistics, error
    figures = statistics.to_dict()
    console.print(make_summary(figures))
    if record is not None and meshcat is not None and visualizer is not None:
        visualizer.StopRecording()
        visualizer.PublishRecording()
        write_recording(meshcat, record, chosen.description)
        console.print(f"Wrote [bold]{record}[/].", soft_wrap=True)
    if json_file is not None:
        write_json(figures, json_file)
    if unstable is not None:
        raise _UnstableError(str(unstable)) from unstable


class _UnstableError(click.ClickException):
    """A run that diverged: a status of its own, so that scripts can tell."""

    exit_code = 3


def _choose_scene(
    scene: str | None,
    tool: str | None,
    environment: str | None,
    tool_scale: float | None,
    environment_scale: float | None,
) -> Scene:
    """Returns the scene that the arguments name.

    Raises:
        click.UsageError: They name none or two.
    """
    if scene is not None:
        if any(
            x is not None for x in (tool, environment, tool_scale, environment_scale)
        ):
            raise click.UsageError("give either SCENE or --tool and --environment")
        return load_scene(find_scene(scene))
    if tool is None or environment is None:
        raise click.UsageError("give SCENE, or both --tool and --environment")
    return Scene.for_meshes(
        tool,
        environment,
        tool_scale=tool_scale or 1.0,
        environment_scale=environment_scale or 1.0,
    )


def _build(console: Console, scene: Scene, meshcat: Meshcat | None) -> HapticDiagram:
    """Builds the diagram, with a bar while meshes are cut into pieces."""
    quiet = not console.is_terminal
    with Progress(console=console, transient=True, disable=quiet) as bars:
        tasks: dict[str, TaskID] = {}

        def report(name: str, share: float) -> None:
            if name not in tasks:
                tasks[name] = bars.add_task(
                    f"Cutting {name} into convex pieces", total=1
                )
            bars.update(tasks[name], completed=share)

        return BuildHapticDiagram(scene, meshcat=meshcat, progress=report)
