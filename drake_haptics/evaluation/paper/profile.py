"""Times every tick of a scenario in the simulator, and sums up the run (Figure 11)."""

from __future__ import annotations

import gc
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.evaluation.paper.exploration import PERIOD_S, Scenario, build_loop
from drake_haptics.evaluation.paper.fits import PowerFit, fit_power
from drake_haptics.simulation.profiling import CallbackTimer
from drake_haptics.simulation.run import run

_WARM_UP_TICKS = 20
# Shorter intervals, in ticks, are flicker at the edge of contact.
_SHORTEST_INTERVAL = 40
# Fewer ticks of a kind give no reliable median.
_LEAST_TICKS = 20
# Fewer points, or nearly equal ones, do not determine a power.
_LEAST_NUMBERS = 3
_LEAST_SPAN = 4.0


@dataclass(frozen=True)
class Profile:
    """A run tick by tick, as one chart of the paper's Figure 11 shows it.

    Times are those of the systems' own callbacks, Python and core, as they run within
    the simulator; the whole tick is all that the computer does for it. The run is made
    several times, the same each time, and a tick's time is the median of these, without
    the disturbances of single runs.

    Attributes:
        name: Name of the scenario.
        figure: Chart of the paper that is like it; empty if none is.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Triangles of the tool, and of all objects.
        objects: Number of objects.
        time_s: (n,) simulated time of each tick, s.
        query_s: (n,) time of the contact query, s.
        force_s: (n,) time of clustering and force computation, s.
        tick_s: (n,) time of the whole tick, s.
        disturbed_s: (passes n,) time of the whole tick in each run, disturbances
            included, s.
        contacts: (n,) number of contacts before clustering.
        clusters: (n,) number of clusters.
        touched: (n,) number of objects with a contact.
        touched_triangles: Triangles of all objects that are ever touched, together.
        distance_m: (n,) distance of the nearest contact, m, negative where it
            penetrates; infinite without a contact.
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
        scenario: Scenario to run.
        seconds: Duration of its path that is run, s. Defaults to all of it.
        passes: Number of runs, which are the same but for their times.
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


@dataclass(frozen=True)
class _Pass:
    """One run.

    Attributes:
        times_s: (3, n) times of query, force and tick, s.
        notes: (n, 4) contacts, clusters, objects touched and nearest distance, m.
        ever: Indices of the objects that were ever touched.
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
        # Both are cached by now, so that a tick is longer by this reading alone.
        contacts = contacts_port.Eval(loop.contact_query.GetMyContextFromRoot(context))
        clusters = clusters_port.Eval(
            loop.contact_clustering.GetMyContextFromRoot(context)
        )
        nearest_m = min(contacts.distance.tolist(), default=np.inf)
        touched = set(contacts.object_index.tolist())
        ever.update(touched)
        notes.append((len(contacts), len(clusters), len(touched), nearest_m))
        timer.end_tick(context)

    # Garbage of earlier runs is not collected during this one.
    gc.collect()
    run(haptic, duration_s, on_tick=note)
    own_s, tick_s = timer.calc_times()
    force_s = own_s[loop.contact_clustering] + own_s[loop.penalty_force]
    times_s = np.array([own_s[loop.contact_query], force_s, tick_s])
    # The first call only begins a tick, and the first ticks meet cold memory.
    kept = slice(_WARM_UP_TICKS, None)
    return _Pass(times_s[:, kept], np.array(notes[1:])[kept], ever)


@dataclass(frozen=True)
class Interval:
    """Ticks of one kind.

    Attributes:
        start: First tick of the interval.
        stop: Tick after its last.
        penetrating: Whether objects penetrate; else they are disjoint.
    """

    start: int
    stop: int
    penetrating: bool

    @property
    def letter(self) -> str:
        """The mark of the paper's Figure 11: P or D."""
        return "P" if self.penetrating else "D"


def find_intervals(penetrating: np.ndarray, shortest: int = 1) -> list[Interval]:
    """Divides ticks into intervals that are disjoint or penetrating as a whole.

    As long as there is an interval of fewer than `shortest` ticks, the shortest of
    all is joined with its neighbors, so that what flickers at the edge of contact
    does not fill a chart with lines.

    Args:
        penetrating: (n,) bool, whether objects penetrate in each tick.
        shortest: Ticks of the shortest interval that is reported.

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
        # Without its edges it is one with the neighbors, which are of one kind.
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
    """Times of the ticks of one kind.

    Attributes:
        ticks: Number of the ticks.
        query: Times of the contact query.
        force: Times of clustering and force.
        tick: Times of the whole tick.
        contacts: Median number of contacts before clustering.
    """

    ticks: int
    query: TickTimes
    force: TickTimes
    tick: TickTimes
    contacts: float


@dataclass(frozen=True)
class ProfileFigures:
    """The figures of a run.

    Attributes:
        name: Name of the scenario.
        figure: Chart of the paper that is like it; empty if none is.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Triangles of the tool, and of all objects.
        objects: Number of objects.
        disjoint: Times of ticks in which nothing penetrates; None without such ticks.
        penetrating: Times of ticks in which something penetrates; None without such
            ticks.
        all_ticks: Times of all ticks.
        disturbed: Times of the whole tick, disturbances included.
        in_time: Share of the disturbed ticks that took less than 1 ms.
        most_contacts: Most contacts at a tick, before clustering.
        most_clusters: Most clusters at a tick.
        most_touched: Most objects in contact at a tick.
        touched_triangles: Triangles of all objects that are ever touched, together.
        deepest_m: Deepest penetration, m.
        busiest: Times of ticks with at least half the most contacts.
        depth_overhead: Median time of the query where something penetrates, over that
            where nothing does, at the same number of contacts; None if no number has
            enough ticks of both kinds.
        contact_growth: Growth of the query's median time with the number of contacts;
            None if fewer than three numbers, or nearly equal ones, have enough ticks.
        intervals: Intervals, disjoint and penetrating in turn.
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
    inside = profile.penetrating
    times = _times_of(profile, np.ones_like(inside))
    assert times is not None
    busy = _times_of(profile, 2 * profile.contacts >= profile.contacts.max())
    assert busy is not None
    return ProfileFigures(
        name=profile.name,
        figure=profile.figure,
        pieces=profile.pieces,
        triangles=profile.triangles,
        objects=profile.objects,
        disjoint=_times_of(profile, ~inside),
        penetrating=_times_of(profile, inside),
        all_ticks=times,
        disturbed=TickTimes.of(profile.disturbed_s),
        in_time=float((profile.disturbed_s < PERIOD_S).mean()),
        most_contacts=int(profile.contacts.max()),
        most_clusters=int(profile.clusters.max()),
        most_touched=int(profile.touched.max()),
        touched_triangles=profile.touched_triangles,
        deepest_m=max(0.0, -float(profile.distance_m.min())),
        busiest=busy,
        depth_overhead=_find_overhead(profile),
        contact_growth=_fit_growth(profile),
        intervals=tuple(find_intervals(inside, _SHORTEST_INTERVAL)),
    )


def _times_of(profile: Profile, which: np.ndarray) -> StateTimes | None:
    """Returns the times of some ticks; None without ticks."""
    if not which.any():
        return None
    query, force, tick = (
        TickTimes.of(seconds[which])
        for seconds in (profile.query_s, profile.force_s, profile.tick_s)
    )
    return StateTimes(
        ticks=int(which.sum()),
        query=query,
        force=force,
        tick=tick,
        contacts=float(np.median(profile.contacts[which])),
    )


def _find_overhead(profile: Profile) -> float | None:
    """Returns `depth_overhead`: the mean ratio, numbers weighed by their ticks."""
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
    """Returns `contact_growth`."""
    numbers, ticks = np.unique(profile.contacts, return_counts=True)
    numbers = numbers[(ticks >= _LEAST_TICKS) & (numbers > 0)]
    if len(numbers) < _LEAST_NUMBERS or numbers[-1] < _LEAST_SPAN * numbers[0]:
        return None
    medians = [np.median(profile.query_s[profile.contacts == n]) for n in numbers]
    return fit_power(numbers, np.array(medians))
