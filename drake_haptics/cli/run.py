"""`drake-haptics run`."""

from __future__ import annotations

from pathlib import Path

import click
from pydrake.geometry import Meshcat
from rich.console import Console

from drake_haptics.builder import HapticDiagram
from drake_haptics.cli import lessons
from drake_haptics.cli.complete import complete_address, complete_file, complete_scene
from drake_haptics.cli.console import make_console
from drake_haptics.cli.finite_range import FiniteRange
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.mesh_options import require_folder, write_json
from drake_haptics.cli.page_words import describe_page
from drake_haptics.cli.parts_table import make_parts_table
from drake_haptics.cli.run_session import PageOptions, run_session
from drake_haptics.cli.status_line import make_summary
from drake_haptics.cockpit.page_port import open_page_port
from drake_haptics.errors import UserError
from drake_haptics.recording import write_recording
from drake_haptics.scene import Scene, load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.stage import open_meshcat, set_stage
from drake_haptics.systems.picture_views import SHOWN_AT_FIRST

_EXPLAINED_S = 2.0


@click.command(cls=TaughtCommand, lesson=lessons.RUN)
@click.argument("scene", required=False, shell_complete=complete_scene)
@click.option(
    "--tool",
    metavar="MESH",
    shell_complete=complete_file,
    help="Instead of SCENE: mesh file of the tool.",
)
@click.option(
    "--environment",
    metavar="MESH",
    shell_complete=complete_file,
    help="Instead of SCENE: mesh file of what it meets.",
)
@click.option(
    "--tool-scale",
    type=FiniteRange(0, min_open=True),
    metavar="METRES",
    help="Metres per unit of the tool's file.  [default: 1]",
)
@click.option(
    "--environment-scale",
    type=FiniteRange(0, min_open=True),
    metavar="METRES",
    help="Metres per unit of the environment's file.  [default: 1]",
)
@click.option(
    "--device",
    metavar="ADDRESS",
    shell_complete=complete_address,
    help="Hold a device instead of the simulated one: udp://HOST:PORT of a driver (try"
    " the command `device`), haply://HOST, lcm:, replay:FILE of --log, or without one"
    " mouse: and meshcat: (sliders below Open Controls on the page, gamepad).",
)
@click.option(
    "--duration",
    type=FiniteRange(0, min_open=True),
    metavar="S",
    help="Stop after so many simulated seconds.  [default: at Ctrl-C]",
)
@click.option(
    "--headless",
    is_flag=True,
    help="No page, and without --device as fast as the computer can.",
)
@click.option(
    "--explain",
    is_flag=True,
    help="Print the parts of a tick, why each is there and its share of the time,"
    f" measured in this run. Runs --headless, for {_EXPLAINED_S:g} s where --duration"
    " is not given.",
)
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    callback=require_folder,
    help="Write what is to be seen as one HTML file that plays in any browser.",
)
@click.option(
    "--log",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    callback=require_folder,
    help="Note every tick in a file, for the command `log`.",
)
@click.option(
    "--json",
    "json_file",
    type=click.Path(dir_okay=False, allow_dash=True),
    metavar="FILE",
    callback=require_folder,
    help="Write the figures as JSON; - writes them to stdout, alone.",
)
@click.option("--pieces", is_flag=True, help="Colour the convex pieces.")
@click.option(
    "--port",
    type=click.IntRange(1024, 65535),
    metavar="PORT",
    help="TCP port of the page.  [default: the first free one from 7100]",
)
def run(
    scene: str | None,
    tool: str | None,
    environment: str | None,
    tool_scale: float | None,
    environment_scale: float | None,
    device: str | None,
    duration: float | None,
    headless: bool,
    explain: bool,
    record: Path | None,
    log: Path | None,
    json_file: str | None,
    pieces: bool,
    port: int | None,
) -> None:
    """Run a scene, or a tool mesh on another mesh, and show it in the browser.

    SCENE is the name of a shipped scene (see `drake-haptics scenes`) or a scene
    file. A simulated hand holds a simulated 6-DOF arm and moves the tool, or you do
    with --device.
    """
    if (headless or explain) and (port or (pieces and not record)):
        option = "--headless" if headless else "--explain"
        raise click.UsageError(f"{option} has no page for --pieces and --port")
    if explain:
        headless = True
        duration = duration or _EXPLAINED_S
    chosen = _choose_scene(scene, tool, environment, tool_scale, environment_scale)
    files = [Path(file).absolute() for file in (record, log, json_file) if file]
    if len(set(files)) < len(files):
        raise UserError("--record, --log and --json: each needs a file of its own")
    if log is not None and device == f"replay:{log}":
        raise UserError(f"--log: {log} is the log that is replayed; give another file")
    console = make_console(stderr=json_file == "-")
    page = None
    if not headless:
        page = PageOptions(
            open_page_port(port),
            name=Path(scene).stem if scene else f"{Path(str(tool)).stem} on a mesh",
            locked=_explain_lock(
                {"--record": record, "--log": log, "--json": json_file}
            ),
            views=SHOWN_AT_FIRST | {"pieces"} if pieces else SHOWN_AT_FIRST,
        )
    meshcat = None if headless and record is None else open_meshcat()
    session = run_session(
        console,
        chosen,
        device=device,
        meshcat=meshcat,
        page=page,
        prepare=lambda haptic, url: _prepare(
            console, haptic, meshcat, url, pieces, record
        ),
        duration_s=duration,
        energy=json_file is not None,
        explained=explain,
        log=log,
    )
    console.print(make_summary(session.figures))
    if explain:
        session.figures["parts"] = [part.to_dict() for part in session.parts]
        console.print()
        console.print(make_parts_table(session.parts))
    if record is not None:
        _write_recording(session.haptic, meshcat, record)
        console.print(f"Wrote {record}.", soft_wrap=True, markup=False)
    if log is not None:
        console.print(f"Wrote {log}.", soft_wrap=True, markup=False)
    if json_file is not None:
        write_json(session.figures, json_file)
    if session.error is not None:
        raise _UnstableError(str(session.error)) from session.error


def _explain_lock(files: dict[str, object]) -> str:
    """Returns why nothing may be changed on the page of a run; empty if it may.

    Args:
        files: What is written of the run as one, by option.
    """
    options = " and ".join(option for option, file in files.items() if file)
    if not options:
        return ""
    return f"A run with {options} keeps to its scene. Start one without to change it."


def _prepare(
    console: Console,
    haptic: HapticDiagram,
    meshcat: Meshcat | None,
    url: str | None,
    pieces: bool,
    record: Path | None,
) -> None:
    """Sets the stage and says where it is to be seen."""
    if meshcat is not None:
        set_stage(meshcat, haptic)
    visualizer = haptic.visualizer
    if visualizer is not None and pieces:
        visualizer.Show("pieces", True)
    if visualizer is not None and record is not None:
        visualizer.StartRecording()
    if url is not None:
        picture = [] if meshcat is None else [meshcat.web_url()]
        for line in describe_page(url, picture):
            console.print(line, soft_wrap=True, markup=False)
        console.print("Ctrl-C ends the run.", style="dim")


def _write_recording(
    haptic: HapticDiagram, meshcat: Meshcat | None, file: Path
) -> None:
    """Writes what was to be seen."""
    if meshcat is None or haptic.visualizer is None:
        return
    haptic.visualizer.StopRecording()
    haptic.visualizer.PublishRecording()
    write_recording(
        meshcat,
        file,
        haptic.scene.description,
        has_friction=haptic.scene.effects.friction is not None,
    )


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
