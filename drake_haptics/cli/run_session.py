"""Opens the device of a scene, builds the scene and runs it."""

from __future__ import annotations

import math
import os
import select
import sys
import warnings
from collections.abc import Callable
from contextlib import ExitStack, closing, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context
from rich.console import Console
from rich.progress import Progress, TaskID

from drake_haptics.authoring.plausibility import check_plausibility
from drake_haptics.cli.endings import naming, warn
from drake_haptics.cli.live_line import ChangeLog
from drake_haptics.cli.options import name_scale_options
from drake_haptics.cli.status_line import StatusLine, describe_held
from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.cockpit.handle_holder import (
    ForceOnRequest,
    SoftStartDevice,
    take_device,
)
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import DeviceBackend, DeviceError
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.loop.open_device import NoPageError, open_device
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneWarning, calc_skin_speed
from drake_haptics.simulation.device_monitor import DeviceWatch
from drake_haptics.simulation.profiling import CallbackTimer, Part, explain_tick
from drake_haptics.simulation.run import RunError, run
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.tick_log.tick_recorder import TickRecorder

# Enough for what a person may have typed.
_BUFFER_BYTES = 4096


def is_enter_pressed() -> bool:
    """Returns whether a line has been typed since the last call.

    It is always False if the input is not a terminal.
    """
    if sys.stdin is None or not sys.stdin.isatty():
        return False
    keys = sys.stdin.fileno()
    pressed = False
    while select.select([keys], [], [], 0.0)[0]:
        # Not by sys.stdin, which would buffer further lines.
        if not os.read(keys, _BUFFER_BYTES):
            break  # the terminal has gone
        pressed = True
    return pressed


def build_scene(
    console: Console,
    scene: Scene,
    meshcat: Meshcat | None,
    device: DeviceBackend | None,
    recorder: TickRecorder | None,
) -> HapticDiagram:
    """Builds the diagram, with a bar while meshes are cut into pieces.

    Warnings about the scene are written to stderr afterwards, one line each.
    """
    bars = Progress(console=console, transient=True, disable=not console.is_terminal)
    tasks: dict[str, TaskID] = {}

    def report(name: str, share: float) -> None:
        if name not in tasks:
            tasks[name] = bars.add_task(f"Cutting {name} into convex pieces", total=1)
        bars.update(tasks[name], completed=share)

    with warnings.catch_warnings(record=True) as caught, bars:
        warnings.simplefilter("always", SceneWarning)
        haptic = BuildHapticDiagram(
            scene, device=device, recorder=recorder, meshcat=meshcat, progress=report
        )
    # After the bar is gone.
    for warning in caught:
        warn(str(warning.message))
    for sentence in check_plausibility(haptic):
        warn(name_scale_options(sentence))
    return haptic


@dataclass(frozen=True)
class Session:
    """The outcome of a run.

    Attributes:
        haptic: The diagram that ran last.
        scene: The scene at the end, with the changes of the page.
        figures: Figures of `RunStatistics.to_dict`, with `contact_law`,
            `skin_speed_m_per_s` (None if infinite), and for a device those of
            `DeviceWatch.to_dict` as `device`.
        parts: Parts of a tick, if an explanation was requested.
        error: Error that stopped the run, if one did.
    """

    haptic: HapticDiagram
    scene: Scene
    figures: dict[str, Any]
    parts: list[Part]
    error: RunError | None


def run_session(
    console: Console,
    scene: Scene,
    *,
    device: str | None,
    meshcat: Meshcat | None,
    open_page: Callable[[Scene, Meshcat], CockpitRun] | None,
    prepare: Callable[[HapticDiagram, str | None], None],
    duration_s: float | None,
    energy: bool,
    explained: bool,
    log: Path | None,
    check_interrupt: Callable[[], None],
) -> Session:
    """Opens the device, builds the scene and runs it under a status line.

    Warnings of the run are written to stderr after it, one line each, because a blocked
    terminal must not block the loop.

    Args:
        console: Console for bars and the status line.
        scene: The scene to run.
        device: Address of the device; None for the scene's simulated one.
        meshcat: Meshcat to draw in; None for no picture.
        open_page: Opens the page that shows and controls the run, in real time; None
            for no page.
        prepare: Called with the diagram before it runs, and the page's address.
        duration_s: Simulated time, s; None runs until Ctrl-C.
        energy: Whether to account for energy, if the device is simulated.
        explained: Whether to explain the parts of a tick.
        log: File that records every tick; None for no log.
        check_interrupt: Function of a `lasting_interrupt`.
    """
    timer = CallbackTimer() if explained else None
    with ExitStack() as stack:
        recorder = None
        if log is not None:
            recorder = stack.enter_context(TickRecorder(log, make_log_header(scene)))
        # A device is closed at zero force, whatever happens.
        cockpit = backend = None
        if open_page is not None and meshcat is not None:
            cockpit = stack.enter_context(closing(open_page(scene, meshcat)))
            backend = cockpit.backend
        elif device is not None:
            try:
                backend = stack.enter_context(open_device(device, scene, meshcat))
            except NoPageError as missing:
                raise DeviceError(f"{missing}: omit --headless") from missing
            if backend.shows_force:
                backend = take_device(backend, scene)
        with timer or nullcontext(), naming(str(device), DeviceError):
            haptic = build_scene(console, scene, meshcat, backend, recorder)
        prepare(haptic, None if cockpit is None else cockpit.url)
        is_paced = cockpit is not None or backend is not None
        pace = RealTimePacer(haptic.period_s) if is_paced else None
        status = StatusLine(console, haptic, pace)
        stack.enter_context(status)
        onlookers = _Onlookers(check_interrupt, status, timer)
        if not console.is_terminal:
            # Without a status line, changes are logged at once.
            changes = ChangeLog(
                Console(stderr=True, force_terminal=False), onlookers.describe_gate
            )
            stack.enter_context(changes)
            onlookers.changes = changes
        caught = stack.enter_context(warnings.catch_warnings(record=True))
        energy = energy and backend is None
        statistics = RunStatistics(haptic.period_s, pace=pace)
        error = None
        try:
            if cockpit is not None and pace is not None:
                haptic = cockpit.run(
                    haptic,
                    duration_s,
                    pace=pace,
                    statistics=statistics,
                    energy=energy,
                    on_begin=onlookers.begin,
                    on_tick=onlookers.end_tick,
                )
            else:
                onlookers.begin(haptic)
                # Ctrl-C ends such a run normally; the statistics are kept.
                with suppress(KeyboardInterrupt):
                    run(
                        haptic,
                        duration_s,
                        pace=pace,
                        energy=energy,
                        on_tick=onlookers.end_tick,
                        statistics=statistics,
                    )
        except RunError as stopped:
            error = stopped
        last = scene if cockpit is None else cockpit.scene
        speed = calc_skin_speed(last.contact, 1.0 / last.device.rate_hz)
        figures = {
            **statistics.to_dict(),
            "contact_law": last.contact.law,
            "skin_speed_m_per_s": speed if math.isfinite(speed) else None,
            **onlookers.describe_device(),
        }
    for warning in caught:
        warn(str(warning.message))
    parts = explain_tick(haptic, timer) if timer is not None else []
    return Session(haptic, last, figures, parts, error)


class _Onlookers:
    """Observes every tick by the status line, the device's watch and the timer."""

    def __init__(
        self,
        check_interrupt: Callable[[], None],
        status: StatusLine,
        timer: CallbackTimer | None,
    ):
        self._check_interrupt = check_interrupt
        self._status = status
        self._timer = timer
        self._backend: DeviceBackend | None = None
        self._watch: DeviceWatch | None = None
        self._ends: list[Callable[[Context], None]] = []
        self.changes: ChangeLog | None = None

    def begin(self, haptic: HapticDiagram) -> None:
        """Observes a diagram from now on."""
        self._status.follow(haptic)
        if haptic.backend is not self._backend:
            self._backend, self._watch = haptic.backend, None
            if haptic.backend is not None:
                self._watch = DeviceWatch(haptic.backend, is_enter_pressed)
        waiting = None
        if isinstance(haptic.backend, SoftStartDevice):
            waiting = ForceOnRequest(haptic.backend, is_enter_pressed)
        looking = (self._status, self._watch, waiting, self._timer)
        self._ends = [part.end_tick for part in looking if part is not None]

    def end_tick(self, context: Context) -> None:
        """Observes a tick."""
        self._check_interrupt()
        for end in self._ends:
            end(context)
        if self.changes is not None:
            self.changes.update()

    def describe_gate(self) -> str:
        """Returns whether the device shows force; empty if it cannot."""
        if self._backend is None or not self._backend.shows_force:
            return ""
        return describe_held(self._backend, self._backend.read())

    def describe_device(self) -> dict[str, Any]:
        """Returns the figures of the last device; empty without one."""
        return {} if self._watch is None else {"device": self._watch.to_dict()}
