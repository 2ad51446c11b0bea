"""`drake-haptics device`."""

from __future__ import annotations

from pathlib import Path

import click

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.completion import complete_scene
from drake_haptics.cli.console import make_console
from drake_haptics.cli.endings import naming
from drake_haptics.cli.live_line import ChangeLog
from drake_haptics.cli.options import (
    FiniteRange,
    json_option,
    load_set_scene,
    set_option,
    write_call,
    write_json,
)
from drake_haptics.cli.status_line import (
    DRIVER_REMEDY,
    DriverStatusLine,
    describe_gate,
    make_driver_summary,
)
from drake_haptics.common.errors import SceneError
from drake_haptics.common.real_time import stop_on_signals
from drake_haptics.loop.drivers import make_simulated_driver
from drake_haptics.scene.validation import RATES_HZ


@click.command(cls=CommandWithExamples)
@click.argument("scene", default="cup_spoon", shell_complete=complete_scene)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    default=7400,
    show_default=True,
    help="UDP port to listen at; 0: any free one.",
)
@click.option(
    "--bind",
    default="127.0.0.1",
    show_default=True,
    metavar="ADDRESS",
    help="IPv4 address to listen at. Any host that reaches it can move the device.",
)
@click.option(
    "--rate",
    type=FiniteRange(*RATES_HZ),
    metavar="HZ",
    help="Ticks per second.  [default: the scene's]",
)
@click.option(
    "--ttl-ms",
    type=FiniteRange(0, 1000, min_open=True),
    metavar="MS",
    default=100.0,
    show_default=True,
    help="Upper limit of a command's life, at whose end the force goes to zero and the"
    " device is at fault. The host chooses the life; `run` chooses 50 ms, so that only"
    " a lower limit changes it.",
)
@click.option(
    "--duration",
    type=FiniteRange(0, min_open=True),
    metavar="S",
    help="Stop after so many seconds.  [default: at Ctrl-C]",
)
@set_option
@json_option()
def device(
    scene: str,
    port: int,
    bind: str,
    rate: float | None,
    ttl_ms: float,
    duration: float | None,
    settings: tuple[str, ...],
    json_file: str | None,
) -> None:
    """Serve a simulated device to `drake-haptics run` in another terminal.

    SCENE is the name of a shipped scene (see `drake-haptics scenes`) or a scene
    file: the device is its device, in its hand, which begins to move when the host
    enables the device.

    Whatever fails, host, network or this program's end, the device goes to zero
    force.
    """
    console = make_console(stderr=json_file == "-")
    chosen = load_set_scene(scene, settings)
    with naming(Path(scene).stem, SceneError):
        driver = make_simulated_driver(
            chosen, rate_hz=rate, max_ttl_s=1e-3 * ttl_ms, bind=bind, port=port
        )
    console.print("The device waits. In another terminal:")
    console.print(
        f"  {write_call('run', scene, settings)} --device {driver.url}",
        style="bold",
        soft_wrap=True,
        markup=False,
    )
    console.print("Ctrl-C ends it.", style="dim")
    with (
        stop_on_signals(driver.stop),
        DriverStatusLine(console, driver) as status,
        ChangeLog(
            console, lambda: describe_gate(driver.reading, DRIVER_REMEDY)
        ) as changes,
    ):

        def on_tick() -> None:
            status.update()
            changes.update()

        driver.run(duration, on_tick=on_tick)
    figures = driver.to_dict()
    console.print(make_driver_summary(figures))
    write_json(figures, json_file)
