"""`drake-haptics check MESH` and `drake-haptics decompose MESH`."""

from __future__ import annotations

import contextlib
import threading
from functools import partial
from pathlib import Path

import click

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.console import describe_page, make_console, progress_bar
from drake_haptics.cli.endings import naming
from drake_haptics.cli.options import (
    FiniteRange,
    file_option,
    json_option,
    max_triangles_option,
    read_mesh,
    unit_options,
    write_json,
)
from drake_haptics.common.one_line import count
from drake_haptics.common.real_time import stop_on_signals
from drake_haptics.geometry.decomposition.approximate import check_error
from drake_haptics.geometry.decomposition.decompose import (
    METHODS,
    Decomposition,
    Method,
)
from drake_haptics.geometry.decomposition.decompose import decompose as decompose_mesh
from drake_haptics.geometry.mesh.mesh import MeshError
from drake_haptics.geometry.mesh.report import Severity, length


@click.command(cls=CommandWithExamples)
@click.argument("mesh", type=click.Path())
@unit_options
@max_triangles_option
@click.option(
    "--strict", is_flag=True, help="Fail if the mesh has a defect, repairable or not."
)
@json_option()
def check(
    mesh: str,
    unit: str | None,
    scale: float | None,
    max_triangles: int | None,
    strict: bool,
    json_file: str | None,
) -> None:
    """Report the contents and the defects of a mesh file, and how each is handled."""
    report = read_mesh(mesh, unit, scale, max_triangles).report
    write_json(report.to_dict(), json_file)
    if json_file != "-":
        make_console().print(report)
    if strict and report.unclean:
        raise MeshError(report.refusal)


@click.command(cls=CommandWithExamples)
@click.argument("mesh", type=click.Path())
@unit_options
@max_triangles_option
@click.option(
    "--method",
    type=click.Choice(METHODS),
    default="surface",
    show_default=True,
    help="surface: exact cover; merged: fewer pieces, within --error; hull: one hull"
    " per part; coacd: few rough pieces.",
)
@click.option(
    "--error",
    "error_m",
    type=FiniteRange(0),
    metavar="METERS",
    help="Largest distance of merged pieces from the mesh.",
)
@file_option("--out", help="Write mesh and pieces to an .npz file.")
@click.option("--no-cache", is_flag=True, help="Neither use nor keep results on disk.")
@click.option(
    "--show", is_flag=True, help="Show the pieces in the browser until Ctrl-C."
)
@file_option(
    "--html",
    help="Write the view of the pieces as a web page that needs no other file.",
)
@json_option()
def decompose(
    mesh: str,
    unit: str | None,
    scale: float | None,
    max_triangles: int | None,
    method: Method,
    error_m: float | None,
    out: Path | None,
    no_cache: bool,
    show: bool,
    html: Path | None,
    json_file: str | None,
) -> None:
    """Cut the surface of a mesh into convex pieces, and report them."""
    with naming("--error"):
        check_error(method, error_m)
    taken_in = read_mesh(mesh, unit, scale, max_triangles)
    with progress_bar() as bar:
        result = decompose_mesh(
            taken_in,
            method,
            error_m=error_m,
            progress=partial(bar, "cutting into convex pieces"),
            cache=not no_cache,
        )
    if out is not None:
        result.save(out)
    data = {**result.report.to_dict(), "mesh": taken_in.report.to_dict()}
    write_json(data, json_file)
    if json_file != "-":
        _print_report(result)
    if show or html is not None:
        _view(result, show, html)


def _print_report(result: Decomposition) -> None:
    console = make_console()
    console.print(result.report)
    if result.mesh.report.decimation_error_m:
        console.print(
            f"  The mesh was reduced: its surface is within"
            f" {length(result.mesh.report.decimation_error_m)} of the original one."
        )
    for finding in result.mesh.report.findings:
        if finding.severity is Severity.QUESTION:
            console.print(f"  Question: {finding.message}: {finding.action}")
    unclean = len(result.mesh.report.unclean)
    if unclean:
        console.print(
            f"  The mesh has {count(unclean, 'defect')}, repaired or left;"
            f" drake-haptics check names {'it' if unclean == 1 else 'them'}."
        )


def _view(result: Decomposition, show: bool, html: Path | None) -> None:
    from drake_haptics.geometry.decomposition.viewer import (
        DecompositionViewer,  # starts a web server
    )

    with contextlib.closing(DecompositionViewer(result)) as viewer:
        if html is not None:
            viewer.write_html(html)
        if show:
            ended = threading.Event()
            with stop_on_signals(ended.set):
                for line in describe_page(viewer.url):
                    click.echo(line, err=True)
                click.echo(
                    "Left the pieces in their places; right the same moved apart, with"
                    " their virtual facets in gray.",
                    err=True,
                )
                click.echo("Ctrl-C ends.", err=True)
                ended.wait()
