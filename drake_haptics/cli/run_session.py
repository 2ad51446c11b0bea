"""A run from the opening of its device to the last tick."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context
from rich.console import Console

from drake_haptics.builder import HapticDiagram
from drake_haptics.callback_timer import CallbackTimer
from drake_haptics.cli.build_scene import build_scene
from drake_haptics.cli.enter_key import is_enter_pressed
from drake_haptics.cli.lasting_interrupt import lasting_interrupt
from drake_haptics.cli.status_line import StatusLine
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.device_address import open_device
from drake_haptics.device_watch import DeviceWatch
from drake_haptics.explain import Part, explain_tick
from drake_haptics.scene import Scene
from drake_haptics.simulation import RunError, run
from drake_haptics.tick_clock import TickClock
from drake_haptics.tick_log.loop_log import make_log_header
from drake_haptics.tick_log.tick_recorder import TickRecorder


@dataclass(frozen=True)
class Session:
    """What came of a run.

    Attributes:
        haptic: What ran.
        figures: As `RunStatistics.to_dict` has them, and of a device under `device`
            those of `DeviceWatch.to_dict`.
        parts: Of a tick, if they were to be explained.
        error: Why the run was stopped, if it was.
    """

    haptic: HapticDiagram
    figures: dict[str, Any]
    parts: list[Part]
    error: RunError | None


def run_session(
    console: Console,
    scene: Scene,
    *,
    device: str | None,
    meshcat: Meshcat | None,
    prepare_page: Callable[[HapticDiagram], None],
    duration_s: float | None,
    paced: bool,
    energy: bool,
    explained: bool,
    log: Path | None,
) -> Session:
    """Opens the device, builds the scene and runs it under a status line.

    Args:
        console: Where bars and the status line go.
        scene: What to run.
        device: Address of what is held; None for the scene's simulated one.
        meshcat: The page, if there is one.
        prepare_page: Called with what was built before it runs.
        duration_s: Simulated time, s; until Ctrl-C where None.
        paced: Whether simulated time is clock time. With a device it always is.
        energy: Whether to book energy, where the device is simulated.
        explained: Whether to explain the parts of a tick.
        log: File for every tick, if wanted.
    """
    timer = CallbackTimer() if explained else None
    with ExitStack() as closing:
        check_interrupt = closing.enter_context(lasting_interrupt())
        backend: DeviceBackend | None = None
        recorder = None
        if log is not None:
            recorder = closing.enter_context(TickRecorder(log, make_log_header(scene)))
        if device is not None:
            # Closed whatever happens: at zero force.
            backend = closing.enter_context(open_device(device, scene, meshcat))
        with timer or nullcontext():
            haptic = build_scene(console, scene, meshcat, backend, recorder)
        prepare_page(haptic)
        pace = TickClock(haptic.period_s) if paced or backend is not None else None
        watch = None if backend is None else DeviceWatch(backend, is_enter_pressed)
        status = StatusLine(console, haptic, pace)
        closing.enter_context(status)
        ends = [part.end_tick for part in (status, watch, timer) if part is not None]

        def end_tick(context: Context) -> None:
            check_interrupt()
            for end in ends:
                end(context)

        error = None
        try:
            statistics = run(
                haptic,
                duration_s,
                pace=pace,
                energy=energy and backend is None,
                on_tick=end_tick,
            )
        except RunError as stopped:
            statistics, error = stopped.statistics, stopped
        figures = statistics.to_dict()
        if watch is not None:
            figures["device"] = watch.to_dict()
    parts = explain_tick(haptic, timer) if timer is not None else []
    return Session(haptic, figures, parts, error)
