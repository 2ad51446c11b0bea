"""The time after which updates of several rates come round together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from drake_haptics.analysis.diagram_systems import Timing
from drake_haptics.analysis.sampled_preconditions import check_positive

# Periods are taken for fractions of a second with denominators up to this.
_LARGEST_DENOMINATOR = 10**7
# A common period of more of the shortest is an accident of rounding.
_MOST_PERIODS = 10_000
# Times are the same that differ by less than this part of a period.
_SAME_TIME = 1e-9


def find_hyperperiod(
    timings: Sequence[Timing], hyperperiod_s: float | None = None
) -> float:
    """Returns the smallest common multiple of all periods, s, or checks a given one.

    Args:
        timings: Of all periodic updates.
        hyperperiod_s: Returned, if it is a multiple of all periods.

    Raises:
        ValueError: It is none; or it is not given, and there are no periods, or no
            common multiple below 10000 of the shortest.
    """
    periods = sorted({timing.period_s for timing in timings})
    if hyperperiod_s is not None:
        check_positive("hyperperiod_s", hyperperiod_s)
        for period in periods:
            count = hyperperiod_s / period
            if round(count) < 1 or abs(count - round(count)) > _SAME_TIME * count:
                raise ValueError(
                    "hyperperiod_s must be a multiple of all periods, but"
                    f" {hyperperiod_s:g} s is {count:g} times {period:g} s"
                )
        return hyperperiod_s
    if not periods:
        raise ValueError("hyperperiod_s must be given: nothing is updated periodically")
    exact = [Fraction(p).limit_denominator(_LARGEST_DENOMINATOR) for p in periods]
    found = float(
        Fraction(
            math.lcm(*(fraction.numerator for fraction in exact)),
            math.gcd(*(fraction.denominator for fraction in exact)),
        )
    )
    rational = all(
        abs(float(fraction) - period) <= _SAME_TIME * period
        for fraction, period in zip(exact, periods, strict=True)
    )
    if not rational or found > _MOST_PERIODS * periods[0]:
        raise ValueError(
            f"the periods {', '.join(f'{p:g}' for p in periods)} s have no common"
            f" multiple below {_MOST_PERIODS} of the shortest: give hyperperiod_s, or"
            " change a rate"
        )
    return found


def snap_to_update(time_s: float, timings: Sequence[Timing]) -> float:
    """Returns the first of the updates that are at a time but for round-off, s.

    Drake multiplies period by count, so that 3 · 0.1 s is after 0.3 s: a simulation up
    to the second of them would do the other's update too.
    """
    near = [time_s]
    for timing in timings:
        count = round((time_s - timing.offset_s) / timing.period_s)
        due = timing.offset_s + count * timing.period_s
        if abs(due - time_s) <= _SAME_TIME * timing.period_s:
            near.append(due)
    return min(near)
