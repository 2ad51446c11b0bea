"""`drake-haptics scenes` and `drake-haptics devices`: list what is included."""

from __future__ import annotations

from dataclasses import asdict

import click
from rich.table import Table

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.console import make_console
from drake_haptics.cli.options import json_option, write_json
from drake_haptics.scene.device_preset import (
    DevicePreset,
    list_device_presets,
    load_device_preset,
)
from drake_haptics.scene.library import list_scenes
from drake_haptics.scene.scene_file import load_scene


@click.command(cls=CommandWithExamples)
def scenes() -> None:
    """List the scenes that are included."""
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("scene", no_wrap=True)
    table.add_column("what happens")
    for name, path in list_scenes().items():
        table.add_row(name, load_scene(path).description)
    console = make_console()
    console.print(table)
    console.print("\nTo run one: drake-haptics run SCENE", style="dim")


# Width of the table of devices.
_WIDTH = 80


@click.command(cls=CommandWithExamples)
@json_option()
def devices(json_file: str | None) -> None:
    """List the devices whose limits are included.

    Forces, torques and stiffnesses are the largest that the device is rated for. A
    device with a twin can be simulated; the others are used with `run --device`.
    """
    presets = {name: load_device_preset(name) for name in list_device_presets()}
    write_json({name: _to_dict(preset) for name, preset in presets.items()}, json_file)
    if json_file != "-":
        _print_devices(presets)


def _to_dict(preset: DevicePreset) -> dict[str, object]:
    """Returns the preset's values, with its model as yes or no."""
    figures = asdict(preset)
    del figures["model"]
    return figures | {"has_twin": preset.has_model}


def _print_devices(presets: dict[str, DevicePreset]) -> None:
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("device", no_wrap=True)
    for heading in [
        "force\nN",
        "torque\nN·m",
        "stiffness\nN/m",
        "torsional\nN·m/rad",
        "reach\nm",
        "\naxes",
        "\ntwin",
    ]:
        table.add_column(heading, justify="right", no_wrap=True)
    for name, preset in presets.items():
        table.add_row(
            name,
            f"{preset.max_force_N:g}",
            f"{preset.max_torque_Nm:g}",
            _format(preset.max_stiffness_N_per_m),
            _format(preset.max_rotational_stiffness_Nm_per_rad),
            f"{preset.workspace_radius_m:g}",
            f"{preset.actuated_axes}",
            "yes" if preset.has_model else "no",
        )
    console = make_console()
    # A narrower terminal wraps the rows; truncated, they would lose numbers.
    console.width = max(_WIDTH, console.width)
    console.print(table)
    console.print(
        "\nforce, torque and stiffness: the largest that it is rated for; reach: the"
        " radius of its workspace; axes: how many of the handle's six have motors;"
        " twin: whether it can be simulated",
        style="dim",
    )
    for source in sorted({preset.source for preset in presets.values()}):
        named = [name for name, preset in presets.items() if preset.source == source]
        console.print(f"{', '.join(named)}: {source}", style="dim")


def _format(value: float | None) -> str:
    return "" if value is None else f"{value:g}"
