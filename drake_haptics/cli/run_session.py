"""A run from the opening of its device to the last tick."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, nullcontext
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
from drake_haptics.cli.status_line import StatusLine
from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.device.backend import DeviceBackend, DeviceError
from drake_haptics.device_address import open_device
from drake_haptics.device_watch import DeviceWatch
from drake_haptics.explain import Part, explain_tick
from drake_haptics.run_statistics import RunStatistics
from drake_haptics.scene import Scene
from drake_haptics.simulation import RunError, run
from drake_haptics.systems.picture_views import SHOWN_AT_FIRST
from drake_haptics.tick_clock import TickClock
from drake_haptics.tick_log.loop_log import make_log_header
from drake_haptics.tick_log.tick_recorder import TickRecorder


@dataclass(frozen=True)
class Session:
    """What came of a run.

    Attributes:
        haptic: What ran last.
        scene: As it is at the end, with what the page has changed.
        figures: As `RunStatistics.to_dict` has them, and of a device under `device`
            those of `DeviceWatch.to_dict`.
        parts: Of a tick, if they were to be explained.
        error: Why the run was stopped, if it was.
    """

    haptic: HapticDiagram
    scene: Scene
    figures: dict[str, Any]
    parts: list[Part]
    error: RunError | None


@dataclass(frozen=True)
class PageOptions:
    """The page of a run.

    Attributes:
        listener: Its port.
        name: Of the scene.
        locked: Why nothing may be changed on it; empty if it may.
        views: Of `PICTURE_VIEWS`, what it shows at first.
    """

    listener: socket.socket
    name: str
    locked: str = ""
    views: frozenset[str] = SHOWN_AT_FIRST


def run_session(
    console: Console,
    scene: Scene,
    *,
    device: str | None,
    meshcat: Meshcat | None,
    page: PageOptions | None,
    prepare: Callable[[HapticDiagram, str | None], None],
    duration_s: float | None,
    energy: bool,
    explained: bool,
    log: Path | None,
    check_interrupt: Callable[[], None],
) -> Session:
    """Opens the device, builds the scene and runs it under a status line.

    Args:
        console: Where bars and the status line go.
        scene: What to run.
        device: Address of what is held; None for the scene's simulated one.
        meshcat: Where to draw, if there is to be a picture.
        page: To show and steer the run, at the pace of the clock; None for none.
        prepare: Called with what was built before it runs, and the page's address.
        duration_s: Simulated time, s; until Ctrl-C where None.
        energy: Whether to book energy, where the device is simulated.
        explained: Whether to explain the parts of a tick.
        log: File for every tick, if wanted.
        check_interrupt: Of a `lasting_interrupt`; called after every tick.
    """
    timer = CallbackTimer() if explained else None
    with ExitStack() as stack:
        recorder = None
        if log is not None:
            recorder = stack.enter_context(TickRecorder(log, make_log_header(scene)))
        # A device is closed whatever happens: at zero force.
        cockpit = backend = None
        if page is not None and meshcat is not None:
            cockpit = CockpitRun(
                scene,
                meshcat,
                page.listener,
                name=page.name,
                device=device,
                locked=page.locked,
                views=page.views,
            )
            stack.enter_context(closing(cockpit))
            backend = cockpit.backend
        elif device is not None:
            backend = stack.enter_context(open_device(device, scene, meshcat))
        with timer or nullcontext(), _address_in_words(device):
            haptic = build_scene(console, scene, meshcat, backend, recorder)
        prepare(haptic, None if cockpit is None else cockpit.url)
        is_paced = cockpit is not None or backend is not None
        pace = TickClock(haptic.period_s) if is_paced else None
        status = StatusLine(console, haptic, pace)
        stack.enter_context(status)
        onlookers = _Onlookers(check_interrupt, status, timer)
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
        figures = statistics.to_dict() | onlookers.describe_device()
    parts = explain_tick(haptic, timer) if timer is not None else []
    return Session(haptic, last, figures, parts, error)


@contextmanager
def _address_in_words(device: str | None) -> Iterator[None]:
    """Says of a device that does not answer where it was looked for."""
    try:
        yield
    except DeviceError as error:
        raise DeviceError(f"{device}: {error}") from error


class _Onlookers:
    """Those who look at every tick: the status line, the device's watch, the timer."""

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

    def begin(self, haptic: HapticDiagram) -> None:
        """Looks at a diagram from now on."""
        self._status.follow(haptic)
        if haptic.backend is not self._backend:
            self._backend, self._watch = haptic.backend, None
            if haptic.backend is not None:
                self._watch = DeviceWatch(haptic.backend, is_enter_pressed)
        looking = (self._status, self._watch, self._timer)
        self._ends = [part.end_tick for part in looking if part is not None]

    def end_tick(self, context: Context) -> None:
        """Looks at a tick."""
        self._check_interrupt()
        for end in self._ends:
            end(context)

    def describe_device(self) -> dict[str, Any]:
        """Returns `device` of the figures, of the device that was held last."""
        return {} if self._watch is None else {"device": self._watch.to_dict()}
