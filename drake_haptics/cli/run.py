"""`drake-haptics run`."""

from __future__ import annotations

from pathlib import Path

import click

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.completion import complete_address, complete_scene
from drake_haptics.cli.options import (
    FiniteRange,
    file_option,
    json_option,
    set_option,
    unit_option,
)
from drake_haptics.geometry.mesh.units import meters_per_unit

_EXPLAINED_S = 2.0


@click.command(cls=CommandWithExamples)
@click.argument("scene", required=False, shell_complete=complete_scene)
@click.option(
    "--tool",
    metavar="MESH",
    type=click.Path(readable=False),
    help="Instead of SCENE: mesh file of the tool.",
)
@click.option(
    "--environment",
    metavar="MESH",
    type=click.Path(readable=False),
    help="Instead of SCENE: mesh file of the environment.",
)
@unit_option("both mesh files")
@click.option(
    "--tool-scale",
    type=FiniteRange(0, min_open=True),
    metavar="METERS",
    help="Meters per unit of the tool's file, if it differs from the environment's.",
)
@click.option(
    "--environment-scale",
    type=FiniteRange(0, min_open=True),
    metavar="METERS",
    help="The same for the environment's file.",
)
@set_option
@click.option(
    "--device",
    metavar="ADDRESS",
    shell_complete=complete_address,
    help="Use a device instead of the simulated one: udp://HOST:PORT of a driver (try"
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
    help="Show no page; without --device, run as fast as the computer can.",
)
@click.option(
    "--explain",
    is_flag=True,
    help="Print the parts of a tick, why each is there and its share of the time,"
    f" measured in this run. Runs --headless, for {_EXPLAINED_S:g} s where --duration"
    " is not given.",
)
@file_option(
    "--record", help="Write the view as one HTML file that plays in any browser."
)
@file_option("--log", help="Record every tick in a file, for the command `log`.")
@file_option(
    "--write-scene",
    help="At the end write the scene, with what --set and the page have changed, as"
    " a scene file to go on from.",
)
@json_option("Write the figures as JSON; - writes them to stdout, alone.")
@click.option("--pieces", is_flag=True, help="Color the convex pieces.")
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
    unit: str | None,
    tool_scale: float | None,
    environment_scale: float | None,
    settings: tuple[str, ...],
    device: str | None,
    duration: float | None,
    headless: bool,
    explain: bool,
    record: Path | None,
    log: Path | None,
    write_scene: Path | None,
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
    if scene is None and (tool is None or environment is None):
        raise click.UsageError("give SCENE, or both --tool and --environment")
    if scene is not None and any(
        given is not None
        for given in (tool, environment, unit, tool_scale, environment_scale)
    ):
        raise click.UsageError("give either SCENE or --tool and --environment")
    if explain:
        headless, duration = True, duration or _EXPLAINED_S
    # Imported here, because it takes a second, which help and Tab must not take.
    from drake_haptics.cli.run_scene import choose_scene, run_scene

    run_scene(
        *choose_scene(
            scene,
            tool,
            environment,
            tool_scale or meters_per_unit(unit, None),
            environment_scale or meters_per_unit(unit, None),
            settings,
        ),
        device=device,
        duration_s=duration,
        headless=headless,
        explain=explain,
        record=record,
        log=log,
        scene_file=write_scene,
        json_file=json_file,
        pieces=pieces,
        port=port,
    )
