"""Times every tick of a scenario, and summarizes the run (Figure 11)."""

from __future__ import annotations

import gc
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.evaluation.paper.exploration import PERIOD_S, Scenario, build_loop
from drake_haptics.evaluation.paper.fits import PowerFit, fit_power
from drake_haptics.simulation.profiling import CallbackTimer
from drake_haptics.simulation.run import run

_WARM_UP_TICKS = 20
# Shorter intervals, in ticks, are noise at the edge of contact.
_SHORTEST_INTERVAL = 40
# Least number of ticks for a reliable median.
_LEAST_TICKS = 20
# Least number of points, and least ratio, that determine a power.
_LEAST_NUMBERS = 3
_LEAST_SPAN = 4.0


@dataclass(frozen=True)
class Profile:
    """A run tick by tick, as in a chart of the paper's Figure 11.

    Times are those of the systems' callbacks, in Python and core, within the simulator;
    the whole tick includes everything. The same run is repeated, and the time of a tick
    is the median of the runs, without disturbances.

    Attributes:
        figure: Corresponding chart of the paper; empty without one.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Triangles of the tool, and of all objects.
        time_s: (n,) simulated time of each tick, s.
        query_s: (n,) time of the contact query, s.
        force_s: (n,) time of clustering and force computation, s.
        tick_s: (n,) time of the whole tick, s.
        disturbed_s: (passes n,) time of the whole tick in each run, including
            disturbances, s.
        contacts: (n,) number of contacts before clustering.
        clusters: (n,) number of clusters.
        touched: (n,) number of objects with a contact.
        touched_triangles: Total number of triangles of all objects that are ever
            touched.
        distance_m: (n,) distance of the nearest contact, m, negative in penetration;
            infinite without a contact.
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
    """Runs a scenario at 1 kHz of simulated time, as fast as possible.

    The duration defaults to that of the path, s.
    """
    duration_s = scenario.path.duration_s
    if seconds is not None:
        duration_s = min(duration_s, seconds)
    runs = [_run_once(scenario, duration_s) for _ in range(passes)]
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


class _Pass(NamedTuple):
    """One run: (3, n) times of query, force and tick, s, and its contacts.

    The (n, 4) notes are contacts, clusters, touched objects and nearest distance, m.
    The indices are those of all objects that were ever touched.
    """

    times_s: np.ndarray
    notes: np.ndarray
    ever: set[int]


def _run_once(scenario: Scenario, duration_s: float) -> _Pass:
    with CallbackTimer() as timer:
        haptic = build_loop(scenario, duration_s)
    loop = haptic.loop
    contacts_port = loop.contact_query.GetOutputPort("contacts")
    clusters_port = loop.contact_clustering.GetOutputPort("clusters")
    ever: set[int] = set()
    notes: list[tuple[float, ...]] = []

    def note(context: Context) -> None:
        # Both are already cached, so that reading them takes little time.
        contacts = contacts_port.Eval(loop.contact_query.GetMyContextFromRoot(context))
        clusters = clusters_port.Eval(
            loop.contact_clustering.GetMyContextFromRoot(context)
        )
        touched = set(contacts.object_index.tolist())
        ever.update(touched)
        notes.append(
            (len(contacts), len(clusters), len(touched), contacts.least_distance)
        )
        timer.end_tick(context)

    # Prevents collection of earlier garbage during the run.
    gc.collect()
    run(haptic, duration_s, on_tick=note)
    own_s, tick_s = timer.calc_times()
    force_s = own_s[loop.contact_clustering] + own_s[loop.penalty_force]
    times_s = np.array([own_s[loop.contact_query], force_s, tick_s])
    # The first call only begins a tick, and the first ticks are cold.
    kept = slice(_WARM_UP_TICKS, None)
    return _Pass(times_s[:, kept], np.array(notes[1:])[kept], ever)


@dataclass(frozen=True)
class Interval:
    """Ticks from `start` up to, not including, `stop`, disjoint or penetrating."""

    start: int
    stop: int
    penetrating: bool


def find_intervals(penetrating: np.ndarray, shortest: int = 1) -> list[Interval]:
    """Divides ticks into intervals that are disjoint or penetrating as a whole.

    While an interval has fewer than `shortest` ticks, the shortest is joined with its
    neighbors, so that noise at the edge of contact does not fill a chart with lines.

    Args:
        penetrating: (n,) bool, whether objects penetrate in each tick.
        shortest: Least number of ticks of an interval.

    Returns:
        Intervals of alternating kind that cover all ticks; empty without ticks.
    """
    penetrating = np.asarray(penetrating, dtype=bool)
    if not len(penetrating):
        return []
    changes = np.flatnonzero(penetrating[1:] != penetrating[:-1]) + 1
    edges = [0, *changes.tolist(), len(penetrating)]
    kind = bool(penetrating[0])
    while len(edges) > 2:
        lengths = np.diff(edges)
        k = int(lengths.argmin())
        if lengths[k] >= shortest:
            break
        # Without its edges it joins its neighbors, which are of the same kind.
        if k == 0:
            kind = not kind
            del edges[1]
        elif k == len(lengths) - 1:
            del edges[k]
        else:
            del edges[k : k + 2]
    return [
        Interval(start, stop, kind ^ bool(k % 2))
        for k, (start, stop) in enumerate(pairwise(edges))
    ]


@dataclass(frozen=True)
class StateTimes:
    """Times of ticks of one kind, with their median number of contacts."""

    ticks: int
    query: TickTimes
    force: TickTimes
    tick: TickTimes
    contacts: float


@dataclass(frozen=True)
class ProfileFigures:
    """The figures of a run, including those of a `Profile`.

    Attributes:
        disjoint: Times of ticks in which nothing penetrates; None without such ticks.
        penetrating: Times of ticks in which something penetrates, or None.
        all_ticks: Times of all ticks.
        disturbed: Times of the whole tick, including disturbances.
        in_time: Share of the disturbed ticks that took less than 1 ms.
        deepest_m: Deepest penetration, m.
        busiest: Times of ticks with at least half the most contacts.
        depth_overhead: Ratio of the query's median times with and without penetration,
            at the same number of contacts; None if no number has enough ticks of both
            kinds.
        contact_growth: Growth of the query's median time with the number of contacts;
            None if fewer than three numbers, or nearly equal ones, have enough ticks.
    """

    name: str
    figure: str
    pieces: tuple[int, int]
    triangles: tuple[int, int]
    objects: int
    disjoint: StateTimes | None
    penetrating: StateTimes | None
    all_ticks: StateTimes
    disturbed: TickTimes
    in_time: float
    most_contacts: int
    most_clusters: int
    most_touched: int
    touched_triangles: int
    deepest_m: float
    busiest: StateTimes
    depth_overhead: float | None
    contact_growth: PowerFit | None
    intervals: tuple[Interval, ...]

    @property
    def rate_Hz(self) -> float:
        """Rate of the loop, Hz: 99 of 100 ticks take less than its period."""
        return 1e6 / self.all_ticks.tick.p99_us

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures ready for JSON."""
        return {**asdict(self), "rate_Hz": self.rate_Hz}


def sum_up(profile: Profile) -> ProfileFigures:
    """Returns the figures of a run of at least one tick."""
    inside, outside = profile.penetrating, ~profile.penetrating
    busy = 2 * profile.contacts >= profile.contacts.max()
    return ProfileFigures(
        name=profile.name,
        figure=profile.figure,
        pieces=profile.pieces,
        triangles=profile.triangles,
        objects=profile.objects,
        disjoint=_times_of(profile, outside) if outside.any() else None,
        penetrating=_times_of(profile, inside) if inside.any() else None,
        all_ticks=_times_of(profile, inside | outside),
        disturbed=TickTimes.of(profile.disturbed_s),
        in_time=float((profile.disturbed_s < PERIOD_S).mean()),
        most_contacts=int(profile.contacts.max()),
        most_clusters=int(profile.clusters.max()),
        most_touched=int(profile.touched.max()),
        touched_triangles=profile.touched_triangles,
        deepest_m=max(0.0, -float(profile.distance_m.min())),
        busiest=_times_of(profile, busy),
        depth_overhead=_find_overhead(profile),
        contact_growth=_fit_growth(profile),
        intervals=tuple(find_intervals(inside, _SHORTEST_INTERVAL)),
    )


def _times_of(profile: Profile, which: np.ndarray) -> StateTimes:
    return StateTimes(
        ticks=int(which.sum()),
        query=TickTimes.of(profile.query_s[which]),
        force=TickTimes.of(profile.force_s[which]),
        tick=TickTimes.of(profile.tick_s[which]),
        contacts=float(np.median(profile.contacts[which])),
    )


def _find_overhead(profile: Profile) -> float | None:
    """Returns `depth_overhead`, the mean ratio weighted by ticks."""
    ratios, weights = [], []
    inside, query_s = profile.penetrating, profile.query_s
    for number in np.unique(profile.contacts):
        of_number = profile.contacts == number
        deep, apart = query_s[of_number & inside], query_s[of_number & ~inside]
        if min(len(deep), len(apart)) >= _LEAST_TICKS:
            ratios.append(np.median(deep) / np.median(apart))
            weights.append(min(len(deep), len(apart)))
    return float(np.average(ratios, weights=weights)) if ratios else None


def _fit_growth(profile: Profile) -> PowerFit | None:
    numbers, ticks = np.unique(profile.contacts, return_counts=True)
    numbers = numbers[(ticks >= _LEAST_TICKS) & (numbers > 0)]
    if len(numbers) < _LEAST_NUMBERS or numbers[-1] < _LEAST_SPAN * numbers[0]:
        return None
    medians = [np.median(profile.query_s[profile.contacts == n]) for n in numbers]
    return fit_power(numbers, np.array(medians))
