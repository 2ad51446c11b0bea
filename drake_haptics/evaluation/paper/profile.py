"""Runs a scenario through the simulator and times every tick of it."""

from __future__ import annotations

import gc
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.evaluation.paper.scenario import PERIOD_S, Scenario, build_loop
from drake_haptics.simulation.profiling import CallbackTimer
from drake_haptics.simulation.run import run

_WARM_UP_TICKS = 20


@dataclass(frozen=True)
class Profile:
    """A run tick by tick: what one chart of the paper's Figure 11 shows.

    Times are those of the systems' own callbacks, Python and core, as they run within
    the simulator; the whole tick is all that the computer does for it. The run is made
    several times, the same each time, and a tick's time is the median of these: what
    it takes, not what disturbed it.

    Attributes:
        name: Of the scenario.
        figure: The paper's chart that is like it; empty if none is.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Of the tool, and of all objects.
        objects: How many there are.
        time_s: (n,) of each tick, s.
        query_s: (n,) time of the contact query, s.
        force_s: (n,) time of clustering and force computation, s.
        tick_s: (n,) time of the whole tick, s.
        disturbed_s: (passes n,) time of the whole tick in each run, with all that
            came between, s.
        contacts: (n,) before clustering.
        clusters: (n,) after it.
        touched: (n,) objects with a contact.
        touched_triangles: Of all objects that are ever touched together.
        distance_m: (n,) of the nearest contact, m, negative where it penetrates;
            infinite where there is none.
    """

    name: str
    figure: str
    pieces: tuple[int, int]
    triangles: tuple[int, int]
    objects: int
    time_s: np.ndarray
    query_s: np.ndarray
    force_s: np.ndarray
    tick_s: np.ndarray
    disturbed_s: np.ndarray
    contacts: np.ndarray
    clusters: np.ndarray
    touched: np.ndarray
    touched_triangles: int
    distance_m: np.ndarray

    @property
    def penetrating(self) -> np.ndarray:
        """(n,) bool, whether objects penetrate."""
        return self.distance_m < 0.0


def measure_profile(
    scenario: Scenario, seconds: float | None = None, passes: int = 3
) -> Profile:
    """Runs a scenario at 1 kHz of simulated time, as fast as it can.

    Args:
        scenario: What to run.
        seconds: How much of its path, s; all of it if not given.
        passes: How often; each is the same but for its times.
    """
    duration_s = scenario.path.duration_s
    if seconds is not None:
        duration_s = min(duration_s, seconds)
    runs = [_run(scenario, duration_s) for _ in range(passes)]
    # (times, passes, ticks)
    query_s, force_s, tick_s = np.array([run.times_s for run in runs]).swapaxes(0, 1)
    first = runs[0]
    contacts, clusters, touched = first.notes[:, :3].astype(int).T
    objects = [item.decomposition for item in scenario.objects]
    return Profile(
        name=scenario.name,
        figure=scenario.figure,
        pieces=(len(scenario.tool.pieces), sum(len(o.pieces) for o in objects)),
        triangles=(
            len(scenario.tool.mesh.triangles),
            sum(len(o.piece_of_triangle) for o in objects),
        ),
        objects=len(objects),
        time_s=(np.arange(len(first.notes)) + _WARM_UP_TICKS) * PERIOD_S,
        query_s=np.median(query_s, axis=0),
        force_s=np.median(force_s, axis=0),
        tick_s=np.median(tick_s, axis=0),
        disturbed_s=tick_s.ravel(),
        contacts=contacts,
        clusters=clusters,
        touched=touched,
        touched_triangles=sum(len(objects[i].piece_of_triangle) for i in first.ever),
        distance_m=first.notes[:, 3],
    )


@dataclass(frozen=True)
class _Pass:
    """One run: (3, n) times of query, force and tick, s; (n, 4) notes; who was met."""

    times_s: np.ndarray
    notes: np.ndarray
    ever: set[int]


def _run(scenario: Scenario, duration_s: float) -> _Pass:
    with CallbackTimer() as timer:
        haptic = build_loop(scenario, duration_s)
    loop = haptic.loop
    contacts_port = loop.contact_query.get_contacts_output_port()
    clusters_port = loop.contact_clustering.get_clusters_output_port()
    ever: set[int] = set()
    notes: list[tuple[float, ...]] = []

    def note(context: Context) -> None:
        # Both are cached by now, and what is read here is all that is not the loop's.
        contacts = contacts_port.Eval(loop.contact_query.GetMyContextFromRoot(context))
        clusters = clusters_port.Eval(
            loop.contact_clustering.GetMyContextFromRoot(context)
        )
        nearest_m = min(contacts.distance.tolist(), default=np.inf)
        touched = set(contacts.object_index.tolist())
        ever.update(touched)
        notes.append((len(contacts), len(clusters), len(touched), nearest_m))
        timer.end_tick(context)

    # The garbage of earlier runs is not this one's.
    gc.collect()
    run(haptic, duration_s, on_tick=note)
    own_s, tick_s = timer.calc_times()
    force_s = own_s[loop.contact_clustering] + own_s[loop.penalty_force]
    times_s = np.array([own_s[loop.contact_query], force_s, tick_s])
    # The first call only begins a tick, and the first ticks meet cold memory.
    kept = slice(_WARM_UP_TICKS, None)
    return _Pass(times_s[:, kept], np.array(notes[1:])[kept], ever)
