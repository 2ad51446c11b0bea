"""Runs a scenario through the simulator and times every tick of it."""

from __future__ import annotations

import gc
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.callback_timer import CallbackTimer
from drake_haptics.paper.scenario import PERIOD_S, Scenario, build_loop
from drake_haptics.simulation import run

_WARM_UP_TICKS = 20


@dataclass(frozen=True)
class Profile:
    """A run tick by tick: what one chart of the paper's Figure 11 shows.

    Times are those of the systems' own callbacks, Python and core, as they run within
    the simulator; the whole tick is all that the computer does for it.

    Attributes:
        name: Of the scenario.
        figure: The paper's chart that is like it; empty if none is.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Of the tool, and of all objects.
        objects: How many there are.
        tolerance_m: Nearer pairs are contacts, m.
        time_s: (n,) of each tick, s.
        query_s: (n,) time of the contact query, s.
        force_s: (n,) time of clustering and force computation, s.
        tick_s: (n,) time of the whole tick, s.
        contacts: (n,) before clustering.
        clusters: (n,) after it.
        touched: (n,) objects with a contact.
        touched_triangles: Of all objects that are ever touched together.
        distance_m: (n,) of the nearest contact, m, negative where it penetrates;
            the tolerance where there is none.
    """

    name: str
    figure: str
    pieces: tuple[int, int]
    triangles: tuple[int, int]
    objects: int
    tolerance_m: float
    time_s: np.ndarray
    query_s: np.ndarray
    force_s: np.ndarray
    tick_s: np.ndarray
    contacts: np.ndarray
    clusters: np.ndarray
    touched: np.ndarray
    touched_triangles: int
    distance_m: np.ndarray

    @property
    def penetrating(self) -> np.ndarray:
        """(n,) bool, whether objects penetrate."""
        return self.distance_m < 0.0


def measure_profile(scenario: Scenario, seconds: float | None = None) -> Profile:
    """Runs a scenario at 1 kHz of simulated time, as fast as it can.

    Args:
        scenario: What to run.
        seconds: How much of its path, s; all of it if not given.
    """
    duration_s = scenario.path.duration_s
    if seconds is not None:
        duration_s = min(duration_s, seconds)
    with CallbackTimer() as timer:
        haptic = build_loop(scenario, duration_s)
    loop = haptic.loop
    contacts_port = loop.contact_query.get_contacts_output_port()
    clusters_port = loop.contact_clustering.get_clusters_output_port()
    # One row more for the monitor's call at the start.
    notes = np.zeros((round(duration_s / PERIOD_S) + 2, 4))
    ever_touched: set[int] = set()
    tick = 0

    def note(context: Context) -> None:
        nonlocal tick
        # Both are cached by now, and what is read here is all that is not the loop's.
        contacts = contacts_port.Eval(loop.contact_query.GetMyContextFromRoot(context))
        clusters = clusters_port.Eval(
            loop.contact_clustering.GetMyContextFromRoot(context)
        )
        nearest_m = min(contacts.distance.tolist(), default=np.inf)
        touched = set(contacts.object_index.tolist())
        ever_touched.update(touched)
        notes[tick] = len(contacts), len(clusters), len(touched), nearest_m
        tick += 1
        timer.end_tick(context)

    # The garbage of earlier scenarios is not this one's.
    gc.collect()
    run(haptic, duration_s, on_tick=note)
    own_s, tick_s = timer.calc_times()
    # The first call only begins a tick, and the first ticks meet cold memory.
    notes = notes[tick - len(tick_s) : tick]
    kept = slice(_WARM_UP_TICKS, None)
    contacts, clusters, touched = notes[kept, :3].astype(int).T
    force_s = own_s[loop.contact_clustering] + own_s[loop.penalty_force]
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
        tolerance_m=scenario.contact.tolerance_m,
        time_s=(np.arange(len(tick_s)) * PERIOD_S)[kept],
        query_s=own_s[loop.contact_query][kept],
        force_s=force_s[kept],
        tick_s=tick_s[kept],
        contacts=contacts,
        clusters=clusters,
        touched=touched,
        touched_triangles=sum(len(objects[i].piece_of_triangle) for i in ever_touched),
        distance_m=np.minimum(notes[kept, 3], scenario.contact.tolerance_m),
    )
