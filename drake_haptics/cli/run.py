"""`drake-haptics run`."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from pathlib import Path

import click
from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context
from rich.console import Console

from drake_haptics.builder import HapticDiagram
from drake_haptics.callback_timer import CallbackTimer
from drake_haptics.cli.build_scene import build_scene
from drake_haptics.cli.enter_key import is_enter_pressed
from drake_haptics.cli.mesh_options import write_json
from drake_haptics.cli.parts_table import make_parts_table
from drake_haptics.cli.status_line import StatusLine, make_summary
from drake_haptics.device_address import open_device
from drake_haptics.device_watch import DeviceWatch
from drake_haptics.errors import UserError
from drake_haptics.explain import explain_tick
from drake_haptics.recording import write_recording
from drake_haptics.scene import Scene, load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.simulation import RunError
from drake_haptics.simulation import run as run_haptic
from drake_haptics.stage import open_meshcat, set_stage
from drake_haptics.tick_clock import TickClock
from drake_haptics.tick_log.loop_log import make_log_header
from drake_haptics.tick_log.tick_recorder import TickRecorder

_EXPLAINED_S = 2.0


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
    "--device",
    metavar="ADDRESS",
    help="Hold a device instead of the simulated one: udp://HOST:PORT of a driver (try"
    " `drake-haptics device`), haply://HOST, lcm:, or without one meshcat: (sliders,"
    " gamepad) and mouse:.",
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
    help="Write what is to be seen as one HTML file that plays in any browser.",
)
@click.option(
    "--log",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Note every tick in a file, for `drake-haptics log`.",
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

    Exits with 0 at the end or at Ctrl-C, with 1 if something given cannot be used,
    with 3 if the simulation became unstable.
    """
    if (headless or explain) and (pieces or port) and not record:
        option = "--headless" if headless else "--explain"
        raise click.UsageError(f"{option} has no page for --pieces and --port")
    if explain:
        headless = True
        duration = duration or _EXPLAINED_S
    chosen = _choose_scene(scene, tool, environment, tool_scale, environment_scale)
    if record is not None and not record.absolute().parent.is_dir():
        raise UserError(f"--record: there is no folder {record.parent}")
    if log is not None and device == f"replay:{log}":
        raise UserError(f"--log: {log} is the log that is replayed; give another file")
    console = Console(highlight=False, stderr=json_file == "-")
    meshcat = None if headless and record is None else open_meshcat(port)
    timer = CallbackTimer() if explain else None
    with ExitStack() as closing:
        backend, recorder = None, None
        if log is not None:
            recorder = closing.enter_context(TickRecorder(log, make_log_header(chosen)))
        if device is not None:
            # Closed whatever happens: at zero force.
            backend = closing.enter_context(open_device(device, chosen, meshcat))
        with timer or nullcontext():
            haptic = build_scene(console, chosen, meshcat, backend, recorder)
        if meshcat is not None:
            _prepare_page(console, haptic, meshcat, pieces, record, headless)
        # A device is never hurried.
        live = backend is not None or not headless
        pace = TickClock(haptic.period_s) if live else None
        watch = None if backend is None else DeviceWatch(backend, is_enter_pressed)
        status = StatusLine(console, haptic, pace)
        closing.enter_context(status)
        on_tick: list[Callable[[Context], None]] = [status.end_tick]
        if watch is not None:
            on_tick.append(watch.end_tick)
        if timer is not None:
            on_tick.append(timer.end_tick)

        def end_tick(context: Context) -> None:
            for end in on_tick:
                end(context)

        try:
            statistics = run_haptic(
                haptic,
                duration,
                pace=pace,
                energy=json_file is not None and backend is None,
                on_tick=end_tick,
            )
            unstable = None
        except RunError as error:
            statistics, unstable = error.statistics, error
    figures = statistics.to_dict()
    if watch is not None:
        figures["device"] = watch.to_dict()
    console.print(make_summary(figures))
    if timer is not None:
        parts = explain_tick(haptic, timer)
        figures["parts"] = [part.to_dict() for part in parts]
        console.print()
        console.print(make_parts_table(parts))
    if record is not None and meshcat is not None and haptic.visualizer is not None:
        haptic.visualizer.StopRecording()
        haptic.visualizer.PublishRecording()
        write_recording(
            meshcat,
            record,
            chosen.description,
            has_friction=chosen.effects.friction is not None,
        )
        console.print(f"Wrote [bold]{record}[/].", soft_wrap=True)
    if log is not None:
        console.print(f"Wrote [bold]{log}[/].", soft_wrap=True)
    if json_file is not None:
        write_json(figures, json_file)
    if unstable is not None:
        raise _UnstableError(str(unstable)) from unstable


def _prepare_page(
    console: Console,
    haptic: HapticDiagram,
    meshcat: Meshcat,
    pieces: bool,
    record: Path | None,
    headless: bool,
) -> None:
    """Sets the stage and says where it is to be seen."""
    set_stage(meshcat, haptic)
    visualizer = haptic.visualizer
    if visualizer is not None and pieces:
        visualizer.ColorPieces()
    if visualizer is not None and record is not None:
        visualizer.StartRecording()
    if not headless:
        url = (haptic.backend and haptic.backend.url) or meshcat.web_url()
        console.print(f"Open [bold]{url}[/] to see it.", soft_wrap=True)
        console.print("Ctrl-C ends the run.", style="dim")


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
