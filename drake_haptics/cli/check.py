"""`drake-haptics check MESH`."""

from __future__ import annotations

import click

from drake_haptics.cli import lessons
from drake_haptics.cli.console import make_console
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.cli.mesh_options import (
    json_option,
    max_triangles_option,
    read_mesh,
    unit_options,
    write_json,
)
from drake_haptics.common.errors import MeshError


@click.command(cls=TaughtCommand, lesson=lessons.CHECK)
@click.argument("mesh", type=click.Path())
@unit_options
@max_triangles_option
@click.option(
    "--strict", is_flag=True, help="Fail if the mesh has a defect, repairable or not."
)
@json_option
def check(
    mesh: str,
    unit: str | None,
    scale: float | None,
    max_triangles: int | None,
    strict: bool,
    json_file: str | None,
) -> None:
    """Report what a mesh file is, what is wrong with it and what is done about it."""
    report = read_mesh(mesh, unit, scale, max_triangles).report
    if json_file is not None:
        write_json(report.to_dict(), json_file)
    if json_file != "-":
        make_console().print(report)
    if strict and report.unclean:
        raise MeshError(report.refusal)
