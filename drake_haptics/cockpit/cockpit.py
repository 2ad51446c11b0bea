"""Sends the page each tick, and reads its requests."""

from __future__ import annotations

import inspect
import math
import textwrap
from time import monotonic

from pydrake.systems.framework import Context

from drake_haptics.authoring.plausibility import make_start_warnings
from drake_haptics.authoring.speedup import find_key_that_helps
from drake_haptics.cockpit.handle_holder import HandleHolder
from drake_haptics.cockpit.scene_changes import (
    CLUSTERING,
    CLUSTERINGS,
    EFFECTS,
    CouplingAdvice,
    SceneChanges,
)
from drake_haptics.cockpit.steering import PagePicture, Steering
from drake_haptics.common.colors import make_legend
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import DeviceReading, GateState
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.simulation.device_monitor import SilenceMonitor
from drake_haptics.simulation.live_values import LiveKey
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.systems.contact.load_shedding import SHED_STAGES
from drake_haptics.systems.output.haptic_picture import PICTURE_VIEWS
from drake_haptics.visualization.meshcat import CAMERAS
from drake_haptics.web.live_page import LivePage
from drake_haptics.web.messages import ACTIVE, SIMULATED, WAITING, Outlook

_LONGEST_DESCRIPTION = 2000
_CLUSTERING_HELP = (
    "Clustering of contacts: shared, which is continuous, or octree, the paper's."
)
# Shortest time between states sent to pages, since a dragged slider changes every
# frame.
_TELL_PERIOD_S = 0.1


class Cockpit:
    """Shows a run on its page, and lets the page control it.

    Attributes:
        steering: Steering of the run, which decides how it continues.
    """

    def __init__(
        self,
        page: LivePage,
        changes: SceneChanges,
        holder: HandleHolder,
        picture: PagePicture,
        advice: CouplingAdvice,
        *,
        name: str,
        locked: str = "",
    ):
        """Begins without a diagram."""
        self.steering = Steering(changes, holder, picture, locked)
        self._page = page
        self._changes = changes
        self._holder = holder
        self._picture = picture
        self._advice = advice
        self._name = name
        self._locked = locked
        # Times at which the state is due next, and was last sent to the page.
        self._tell_s, self._told_s = math.inf, -math.inf
        self._greeted: tuple[LiveKey, ...] = ()
        self._root: Context | None = None
        # Warnings about where the tool began.
        self._start = ""
        # Number of stages of work that are dropped, and the key that would help.
        self._shed, self._relief = 0, ""
        self._silence, self._looked_s = SilenceMonitor(), monotonic()

    def begin(
        self,
        haptic: HapticDiagram,
        statistics: RunStatistics,
        pace: RealTimePacer,
        *,
        is_restart: bool,
    ) -> None:
        """Begins a segment, of a diagram of the scene as it is now.

        Args:
            haptic: The diagram that runs.
            statistics: Statistics of the run.
            pace: Pacer of the run.
            is_restart: Whether the tool begins where the handle is.
        """
        if is_restart:
            found = make_start_warnings(haptic)
            self._start = " ".join(f"{x[0].upper()}{x[1:]}." for x in found)
        self._haptic, self._statistics, self._pace = haptic, statistics, pace
        self._root = None
        self.steering.begin(haptic)
        # Another diagram may have other effects.
        self._greeted = ()
        self._tell()

    def end_tick(self, context: Context) -> bool:
        """Records a tick, and communicates with the page if it is time.

        Returns:
            Whether the segment must end; `Steering.take_change` has the reason.
        """
        self._root = context
        self._page.note(
            context.get_time(), self._statistics.latest, self._pace.last_late_s
        )
        now_s = monotonic()
        asked = self._page.act(now_s, self._look_out)
        if asked and self.steering.obey(asked, context, self._page.camera.X_WC, now_s):
            self._tell_s = max(now_s, self._told_s + _TELL_PERIOD_S)
        if now_s >= self._tell_s:
            self._tell()
        return self.steering.end_tick(context, now_s)

    def _tell(self) -> None:
        """Sends the page the state, and what can be changed if that is new."""
        self._told_s, self._tell_s = monotonic(), math.inf
        if self._greeted != (keys := self._changes.list_keys()):
            self._greeted = keys
            self._greet()
        backend = self._holder.backend
        is_real = backend is not None and backend.shows_force
        warnings = [
            {
                "key": f"coupling.{bound.key}",
                "words": bound.words,
                "why": f"{bound.sentence}.",
            }
            for bound in self._advice.check(self._changes.scene, is_real=is_real)
        ]
        state = {
            **self._changes.describe(),
            "handle": self._holder.name,
            "views": self._picture.views,
            "warnings": warnings,
            "start": self._start,
            "relief": self._relief,
            "error": self.steering.tell_error(),
            "answered": self.steering.answered,
        }
        self._page.tell("state", state)

    def _greet(self) -> None:
        """Sends the page what can be shown and changed."""
        changes, holder = self._changes, self._holder
        scene, site = changes.scene, holder.site
        greeting = {
            "meshcat": self._page.meshcat_url,
            "scene": self._name,
            # A message longer than a datagram would never reach the page.
            "description": textwrap.shorten(
                scene.description, _LONGEST_DESCRIPTION, placeholder=" …"
            ),
            "period_s": 1.0 / scene.device.rate_hz,
            "limits": {"force_N": site.max_force_N, "torque_Nm": site.max_torque_Nm},
            "keys": [
                {
                    "key": item.key,
                    "label": item.label,
                    "unit": item.unit,
                    "low": item.low,
                    "high": item.high,
                    "log": item.is_logarithmic,
                    "group": item.group,
                    "help": item.help,
                    "file": changes.read_file(item),
                }
                for item in changes.list_keys()
            ],
            "choices": [
                {
                    "key": CLUSTERING,
                    "label": "Clustering",
                    "options": list(CLUSTERINGS),
                    "help": _CLUSTERING_HELP,
                    "file": changes.file.contact.clustering,
                }
            ],
            "effects": [
                {
                    "name": effect,
                    "label": effect.capitalize(),
                    "help": (inspect.getdoc(schema) or "").partition("\n")[0],
                    "file": getattr(changes.file.effects, effect) is not None,
                }
                for effect, schema in EFFECTS.items()
            ],
            "handles": [
                {"name": key, "label": label} for key, label in holder.names.items()
            ],
            "views": [
                {"name": key, "label": label} for key, label in PICTURE_VIEWS.items()
            ],
            "cameras": list(CAMERAS),
            "legend": make_legend(scene.effects.friction is not None),
            "locked": self._locked,
            "shed_stages": list(SHED_STAGES),
        }
        self._page.tell("hello", greeting)

    def _look_out(self) -> Outlook:
        """Returns the rest of a frame."""
        assert self._root is not None
        loop, backend = self._haptic.loop, self._holder.backend
        reading = None if backend is None else backend.read()
        X_WH = self._haptic.diagram.GetOutputPort("X_WH").Eval(self._root)
        shed = 0
        if loop.load_shedding is not None:
            relief = loop.load_shedding.GetMyContextFromRoot(self._root)
            shed = math.ceil(relief.get_discrete_state_vector().value()[0])
        self._find_relief(shed)
        before_s, self._looked_s = self._looked_s, monotonic()
        gate = self._find_gate(reading)
        self._picture.mark_felt(gate in (ACTIVE, SIMULATED))
        return Outlook(
            gate=gate,
            p_WH=X_WH[4:].tolist(),
            fault=0 if reading is None else int(reading.fault),
            silent_s=self._silence.add(reading, self._looked_s - before_s),
            shed=shed,
            skipped=self._pace.skipped,
        )

    def _find_relief(self, shed: int) -> None:
        """Finds which key helps, once, when work begins to be dropped."""
        if shed and not self._shed:
            _, query_s, *_ = self._statistics.latest
            costs_us = {"contact_query": 1e6 * query_s}
            self._relief = find_key_that_helps(costs_us, self._changes.scene) or ""
            self._tell_s = monotonic()
        self._shed = shed

    def _find_gate(self, reading: DeviceReading | None) -> int:
        """Returns the index into `GATES` of a reading's state."""
        if reading is None:
            return SIMULATED
        taken = self._holder.taken
        if taken is not None and taken.waits and reading.gate == GateState.IDLE:
            return WAITING
        return int(reading.gate)
