"""Sums up a run: how long ticks take where objects are disjoint, and penetrate."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.evaluation.paper.fits import PowerFit, fit_power
from drake_haptics.evaluation.paper.intervals import Interval, find_intervals
from drake_haptics.evaluation.paper.profile import Profile
from drake_haptics.evaluation.paper.scenario import PERIOD_S

# What is shorter flickers at the edge of contact.
_SHORTEST_INTERVAL = 40
# Fewer ticks of a kind have no median to speak of.
_LEAST_TICKS = 20
# A power through fewer points, or through nearly equal ones, is none.
_LEAST_NUMBERS = 3
_LEAST_SPAN = 4.0


@dataclass(frozen=True)
class StateTimes:
    """Times of the ticks of one kind.

    Attributes:
        ticks: How many.
        query: The contact query.
        force: Clustering and force.
        tick: The whole tick.
        contacts: Median number before clustering.
    """

    ticks: int
    query: TickTimes
    force: TickTimes
    tick: TickTimes
    contacts: float


@dataclass(frozen=True)
class ProfileFigures:
    """What a run comes to.

    Attributes:
        name: Of the scenario.
        figure: The paper's chart that is like it; empty if none is.
        pieces: Convex pieces of the tool, and of all objects.
        triangles: Of the tool, and of all objects.
        objects: How many there are.
        disjoint: Ticks in which nothing penetrates; None if there are none.
        penetrating: Those in which something does; None if there are none.
        all_ticks: Both.
        disturbed: The whole tick with all that came between.
        in_time: Share of those ticks that took less than 1 ms.
        most_contacts: Before clustering.
        most_clusters: After it.
        most_touched: Objects in contact at once.
        touched_triangles: Of all objects that are ever touched together.
        deepest_m: Deepest penetration, m.
        busiest: Ticks with at least half the most contacts.
        depth_overhead: Median time of the query where something penetrates, over that
            where nothing does, at the same number of contacts; None where no number
            has ticks enough of both kinds.
        contact_growth: Of the query's median time with the number of contacts; None
            where fewer than three numbers, or nearly equal ones, have ticks enough.
        intervals: Disjoint and penetrating in turn.
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
        """What the loop could do: 99 of 100 ticks take less than its period."""
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
    """Returns the times of some ticks; None of none."""
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
