"""`drake-haptics scenes`."""

from __future__ import annotations

import click
from rich.table import Table

from drake_haptics.cli import lessons
from drake_haptics.cli.console import make_console
from drake_haptics.cli.lesson import TaughtCommand
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.scene_file import load_scene


@click.command(cls=TaughtCommand, lesson=lessons.SCENES)
def scenes() -> None:
    """List the scenes that come along."""
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("scene", no_wrap=True)
    table.add_column("what happens")
    for name, path in list_scenes().items():
        table.add_row(name, load_scene(path).description)
    console = make_console()
    console.print(table)
    console.print("\nTo run one: drake-haptics run SCENE", style="dim")
