"""Runs a scene and reports its figures."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import click
from pydrake.geometry import Meshcat
from rich.console import Console
from rich.table import Table

from drake_haptics.authoring.scene_from_meshes import make_scene_for_meshes
from drake_haptics.authoring.speedup import suggest_speedup
from drake_haptics.cli.console import describe_page, make_console
from drake_haptics.cli.endings import ExitCode, lasting_interrupt, naming
from drake_haptics.cli.options import (
    load_set_scene,
    name_scale_options,
    refuse_overwriting,
    set_values,
    write_json,
)
from drake_haptics.cli.run_session import run_session
from drake_haptics.cli.status_line import describe_fault, make_summary
from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.common.errors import HapticsError, SceneError
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.scene_file import write_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.profiling import Part
from drake_haptics.systems.output.haptic_picture import SHOWN_AT_FIRST
from drake_haptics.visualization.meshcat import (
    configure_camera,
    start_meshcat,
    write_recording,
)
from drake_haptics.web.link import FIRST_PORT, open_page_port


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


_MESH_OPTIONS = {
    "tool.mesh": "--tool",
    "tool.scale": "--tool-scale",
    "environment.mesh": "--environment",
    "environment.scale": "--environment-scale",
}


def choose_scene(
    scene: str | None,
    tool: str | None,
    environment: str | None,
    tool_scale: float,
    environment_scale: float,
    settings: Sequence[str],
) -> tuple[Scene, str]:
    """Returns the scene that the arguments of `run` name, and a name for it.

    Raises:
        HapticsError: There is no such scene, or a setting is invalid.
    """
    if scene is not None:
        return load_set_scene(scene, settings), Path(scene).stem
    _refuse_settings_of_meshes(settings)
    assert tool is not None and environment is not None
    try:
        made = make_scene_for_meshes(
            tool,
            environment,
            tool_scale=tool_scale,
            environment_scale=environment_scale,
        )
    except SceneError as error:
        raise SceneError(name_scale_options(str(error))) from error
    if made.tool.center:
        click.echo(
            f"{Path(tool).name} has its origin far beside the mesh: the tool is"
            " centered (tool.center: true in a scene file).",
            err=True,
        )
    return set_values(made, settings), f"{Path(tool).stem} on {Path(environment).stem}"


def _refuse_settings_of_meshes(settings: Sequence[str]) -> None:
    """Refuses to change the meshes for which the path of the hand is made."""
    for setting in settings:
        key = setting.partition("=")[0]
        if option := _MESH_OPTIONS.get(key.replace("[0]", "")):
            raise HapticsError(
                f"--set {key}: give {option} instead; the hand's path is made for it"
            )


def run_scene(
    scene: Scene,
    name: str,
    *,
    device: str | None,
    duration_s: float | None,
    headless: bool,
    explain: bool,
    record: Path | None,
    log: Path | None,
    scene_file: Path | None,
    json_file: str | None,
    pieces: bool,
    port: int | None,
) -> None:
    """Runs a scene with the options of `run`, and prints the results.

    Raises:
        HapticsError: An option would overwrite the log that is replayed.
        click.ClickException: The simulation became unstable, or the device is at fault
            at the end.
    """
    if device is not None:
        refuse_overwriting([device.removeprefix("replay:")])
    console = make_console(stderr=json_file == "-")
    page = None
    if not headless:
        locked = _explain_lock({"--record": record, "--log": log, "--json": json_file})
        views = SHOWN_AT_FIRST | {"pieces"} if pieces else SHOWN_AT_FIRST
        with naming("--port"):
            listener = open_page_port(port)
        page = partial(
            CockpitRun,
            listener=listener,
            name=name,
            device=device,
            locked=locked,
            views=views,
        )
    meshcat = None if headless and record is None else start_meshcat()
    # Includes the report, which a second Ctrl-C must not lose.
    with lasting_interrupt() as check_interrupt, naming(name, SceneError):
        session = run_session(
            console,
            scene,
            device=device,
            meshcat=meshcat,
            open_page=page,
            prepare=lambda haptic, url: _prepare(
                console, haptic, meshcat, url, port, pieces, record
            ),
            duration_s=duration_s,
            energy=json_file is not None,
            explained=explain,
            log=log,
            check_interrupt=check_interrupt,
        )
        console.print(make_summary(session.figures))
        if explain:
            session.figures["parts"] = [part.to_dict() for part in session.parts]
            console.print()
            console.print(make_parts_table(session.parts))
            speed = session.figures["skin_speed_m_per_s"]
            if speed is not None:
                words = (
                    f"Above {speed:g} m/s the tool crosses contact.tolerance_m in one"
                    " step: contact begins as deep as that step has taken it."
                )
                console.print(words, soft_wrap=True, markup=False)
            relief = suggest_speedup(session.parts, session.scene)
            if relief is not None:
                console.print(relief, soft_wrap=True, markup=False)
        if record is not None:
            _write_recording(session.haptic, meshcat, record)
            console.print(f"Wrote {record}.", soft_wrap=True, markup=False)
        if log is not None:
            console.print(f"Wrote {log}.", soft_wrap=True, markup=False)
        if scene_file is not None:
            head = f"{name} with all its keys, written by drake-haptics run."
            write_scene(session.scene, scene_file, [head])
            again = shlex.join(["drake-haptics", "run", str(scene_file)])
            console.print(f"Wrote {scene_file}: {again}", soft_wrap=True, markup=False)
        write_json(session.figures, json_file)
    if session.error is not None:
        raise _BadEndError(str(session.error)) from session.error
    if (fault := session.figures.get("device", {}).get("fault", "NONE")) != "NONE":
        driver = " is its driver still running?" if fault == "STALE" else ""
        raise _BadEndError(
            f"the run ended with its device at fault ({describe_fault(fault)}):{driver}"
            " docs/connect-a-device.md says what each fault means"
        )


def _explain_lock(files: dict[str, object]) -> str:
    """Returns why nothing may be changed on the page of a run; empty if it may.

    Args:
        files: Files that record the whole run, by option.
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
    port: int | None,
    pieces: bool,
    record: Path | None,
) -> None:
    if meshcat is not None:
        configure_camera(meshcat, haptic)
    visualizer = haptic.visualizer
    if visualizer is not None and pieces:
        visualizer.Show("pieces", True)
    if visualizer is not None and record is not None:
        visualizer.StartRecording()
    if url is not None:
        picture = [] if meshcat is None else [meshcat.web_url()]
        for line in describe_page(url, picture, wished_port=port or FIRST_PORT):
            console.print(line, soft_wrap=True, markup=False)
        console.print("Ctrl-C ends the run.", style="dim")


def _write_recording(
    haptic: HapticDiagram, meshcat: Meshcat | None, file: Path
) -> None:
    if meshcat is None or haptic.visualizer is None:
        return
    haptic.visualizer.StopRecording()
    haptic.visualizer.PublishRecording()
    write_recording(
        meshcat,
        file,
        haptic.scene.description,
        haptic.visualizer.recorded_sizes,
        max_force_N=haptic.loop.device.max_force_N,
        max_torque_Nm=haptic.loop.device.max_torque_Nm,
        has_friction=haptic.scene.effects.friction is not None,
    )


class _BadEndError(click.ClickException):
    """A run that diverged, or whose device was at fault at the end."""

    exit_code = ExitCode.NO
