"""A cockpit whose page is a list of its requests by tick."""

from types import SimpleNamespace

from box_scenes import TOOL_HALF_HEIGHT

from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.web.live_page import look_from_the_front

# Waypoints over a plate, of a path that presses it.
ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)
PRESSING = (0.2, 0.0, 0.0, TOOL_HALF_HEIGHT - 0.01)
# What a page asks for.
FRICTION = {"do": "effect", "name": "friction", "on": True}
STIFFER = {"do": "set", "key": "coupling.stiffness_N_per_m", "to": 1200}
MOUSE = {"do": "handle", "to": "mouse"}


def find_tool(haptic, root):
    """The tool's pose (7,)."""
    return haptic.diagram.GetOutputPort("X_WT").Eval(root).copy()


class ScriptedPage:
    """Makes requests after some ticks, and keeps what it is told."""

    def __init__(self, script):
        self._script = {tick: list(asked) for tick, asked in script.items()}
        self.meshcat_url = "http://localhost:6999/"
        self.camera = SimpleNamespace(X_WC=look_from_the_front([0, 0, 0.05], 0.1))
        self.times, self.hellos, self.states, self.outlooks = [], [], [], []

    def note(self, time_s, latest, late_s):
        """Keeps a tick."""
        assert len(latest) == 12
        self.times.append(time_s)

    def act(self, now_s, describe):
        """Returns the requests after this tick."""
        if len(self.times) % 33 == 0:
            self.outlooks.append(describe())
        return self._script.get(len(self.times), [])

    def close(self, why=""):
        """Ends, with a reason if the run failed."""

    def tell(self, name, body):
        """Keeps a message."""
        {"hello": self.hellos, "state": self.states}[name].append(body)


class CockpitRig:
    """A scene that runs as fast as it can, by a clock that goes with its ticks.

    Attributes:
        page: A `ScriptedPage`.
        haptics: Diagrams that ran, one after the other.
        seen: Return values of `watch` at each tick.
    """

    def __init__(
        self,
        scene,
        meshcat,
        monkeypatch,
        script,
        *,
        address=None,
        watch=None,
        **options,
    ):
        self.page = ScriptedPage(script)
        monkeypatch.setattr(
            "drake_haptics.cockpit.cockpit.monotonic",
            lambda: self.ticks * self.period_s,
        )
        monkeypatch.setattr(
            "drake_haptics.cockpit.cockpit_run.LivePage", lambda *_, **__: self.page
        )
        self.period_s = 1.0 / scene.device.rate_hz
        self.ticks = 0
        self._run = CockpitRun(
            scene, meshcat, None, name="test", device=address, **options
        )
        self.changes, self.cockpit = self._run._changes, self._run._cockpit
        self.holder = self._run._holder
        self.haptics, self.seen = [], []
        self._watch = watch or (lambda haptic, root: root.get_time())

    def run(self, duration_s, *, energy=False, pace=None):
        """Runs and returns the statistics."""
        pace = pace or RealTimePacer(
            self.period_s, lambda: self.ticks * self.period_s, lambda _: None
        )
        self.statistics = RunStatistics(self.period_s, pace)
        self.last = self._run.run(
            BuildHapticDiagram(self._run.scene, device=self._run.backend),
            duration_s,
            pace=pace,
            statistics=self.statistics,
            energy=energy,
            on_begin=self.haptics.append,
            on_tick=self._end_tick,
        )
        return self.statistics.to_dict()

    def _end_tick(self, root):
        self.ticks += 1
        self.seen.append(self._watch(self.haptics[-1], root))
