"""`drake-haptics stability`."""

from __future__ import annotations

from pathlib import Path

import click
from rich.table import Table

from drake_haptics.analysis.jobs.study import StudyError
from drake_haptics.analysis.scene_stability import SceneStability, analyze_scene
from drake_haptics.analysis.stability_page import (
    describe_delay,
    describe_restless,
    describe_situation,
    describe_verdict,
    write_stability_page,
)
from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.completion import complete_scene
from drake_haptics.cli.console import make_console, progress_bar
from drake_haptics.cli.endings import naming
from drake_haptics.cli.options import (
    FiniteRange,
    file_option,
    json_option,
    load_set_scene,
    require_writable,
    set_option,
    write_json,
)
from drake_haptics.common.errors import HapticsError, SceneError
from drake_haptics.report.page import check_page_path
from drake_haptics.simulation.run import RunError


@click.command(cls=CommandWithExamples)
@click.argument("scene", shell_complete=complete_scene)
@click.option(
    "--at",
    "time_s",
    type=FiniteRange(0),
    metavar="S",
    help="Stop the hand at this time of its path.  [default: at the firmest contact]",
)
@click.option(
    "--map",
    "map_size",
    type=click.IntRange(0),
    metavar="N",
    default=20,
    show_default=True,
    help="Stiffnesses and dampings of the map, each; 0 for no map, else at least 2.",
)
@file_option(
    "--out",
    help="The page to write; its picture goes beside it.  [default:"
    " SCENE-stability.html]",
)
@file_option("--store", help="Keep the map's results here, and continue from them.")
@set_option
@json_option()
def stability(
    scene: str,
    time_s: float | None,
    map_size: int,
    out: Path | None,
    store: Path | None,
    settings: tuple[str, ...],
    json_file: str | None,
) -> None:
    """Compute how stable a scene is, and how stiff its coupling may be.

    SCENE is the name of a shipped scene (see `drake-haptics scenes`) or a scene
    file. The hand stops on its path, the tool rests in contact, and the loop of
    device, hand, coupling, tool and contact is linearized there. Writes one page with
    the poles, the margins, the largest stable stiffness by eigenvalue, by simulation
    and by formula, and a map over the coupling's stiffness and damping.
    """
    if map_size == 1:
        raise click.BadParameter("0 for no map, else at least 2", param_hint="--map")
    chosen = load_set_scene(scene, settings)
    path = out or Path(f"{Path(scene).stem}-stability.html")
    require_writable(path, "--out")
    try:
        check_page_path(path)
        with progress_bar() as show, naming(Path(scene).stem, SceneError):
            result = analyze_scene(
                chosen, time_s, map_size=map_size, store=store, progress=show
            )
    except (ValueError, RunError, StudyError) as error:
        words = str(error)
        if words.startswith("time_s "):  # the argument that --at sets
            words = f"--at {words.removeprefix('time_s ')}"
        raise HapticsError(words) from error
    write_stability_page(result, Path(scene).stem, path)
    write_json(result.to_dict(), json_file)
    if json_file != "-":
        _print(result, path)


def _print(result: SceneStability, path: Path) -> None:
    console = make_console()
    console.print(f"[bold]{describe_verdict(result)}[/]")
    console.print(describe_situation(result), style="dim")
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    headings = ["largest stable stiffness", "scene", "eigenvalue", "simulation"]
    for heading in [*headings, "one axis", "formula"]:
        table.add_column(heading, justify="right" if table.columns else "left")
    for limit in result.limits:
        # Short enough for a terminal of 80 columns.
        against = limit.against.rpartition(" ")[2]
        name = f"{limit.kind}, {against}, {limit.unit}"
        table.add_row(name, *limit.format_values())
    console.print(table)
    for limit in result.limits:
        console.print(
            f"{limit.kind}, {limit.against}: what grows first: {limit.limited_by}",
            style="dim",
        )
    console.print(f"further delay that is stable: {describe_delay(result)}")
    if restless := describe_restless(result):
        console.print(restless, style="dim")
    console.print(
        f"Wrote {path} and {path.with_suffix('.png')}.", soft_wrap=True, markup=False
    )
