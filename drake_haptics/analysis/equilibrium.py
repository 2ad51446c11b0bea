"""Finds equilibria of a diagram: fixed points of its sampled motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, System

from drake_haptics.analysis.derivative_check import calc_sizes
from drake_haptics.analysis.diagram_systems import (
    StateLayout,
    Timing,
    find_state_layout,
    find_timings,
)
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.preconditions import (
    check_abstract_state,
    check_conversion,
    check_system_and_context,
    explain_drake_errors,
)
from drake_haptics.analysis.sampled_map import SampledMap, set_state
from drake_haptics.common.value_checks import check_at_least, check_positive

# Singular values below this part of the largest belong to directions that nothing
# holds, such as quaternion lengths and memories of friction; steps avoid them.
_RANK = 1e-11
# Levenberg's damping of a step, relative to the largest singular value.
_FIRST_DAMPING = 1e-8
_LARGEST_DAMPING = 1e2
_RAISE = 10.0
# A step must lower the residual by at least this part.
_LEAST_DECREASE = 1e-4


@dataclass(frozen=True)
class Equilibrium:
    """A state that one period does not change.

    Attributes:
        context: Root context at the equilibrium; only its state differs from the
            user's.
        residual: Largest change of a state over a period, relative to its size or 1.
        iterations: Steps of Newton's method taken.
    """

    context: Context
    residual: float
    iterations: int


@explain_drake_errors("finding an equilibrium")
@on_one_blas_thread
def find_equilibrium(
    diagram: System,
    context: Context,
    *,
    period_s: float | None = None,
    settle_s: float = 0.0,
    tolerance: float = 1e-9,
    max_iterations: int = 50,
) -> Equilibrium:
    """Finds a state near the context's that one period does not change.

    x_d⁺ = x_d for all periodic discrete updates, of one rate or several, and ẋ_c = 0,
    with time and inputs as they are in the context. It uses Newton's method with
    AutoDiffXd derivatives and steps of least length, damped as by Levenberg and
    Marquardt (Nocedal and Wright, Numerical Optimization, 2nd ed., section 10.3) if a
    full step does not help. Quaternions of MultibodyPlants keep unit length.

    Args:
        diagram: Any system that converts to AutoDiffXd.
        context: Its root context; it is not changed.
        period_s: Time that converts a rate to a change, s. Defaults to the shortest
            period, or to 1 s if nothing is updated periodically.
        settle_s: Duration of a simulation before the search, s; only for systems that
            do not depend on time.
        tolerance: Bound of `Equilibrium.residual`; under the constraint law a flush
            contact does not get below 3e-10.
        max_iterations: Bound of `Equilibrium.iterations`.

    Raises:
        ValueError: No equilibrium was reached, and the message says how close the
            search came and what to try; a system has abstract state or no AutoDiffXd
            twin; `settle_s` is given and the system depends on time; or an argument is
            out of range.
    """
    check_system_and_context(diagram, context)
    if period_s is not None:
        check_positive(period_s=period_s)
    check_positive(tolerance=tolerance)
    check_at_least(1, max_iterations=max_iterations)
    check_at_least(0, settle_s=settle_s)
    check_abstract_state(diagram)
    check_conversion(diagram)
    timings = find_timings(diagram, context)
    if period_s is None:
        period_s = timings[0].period_s if timings else 1.0
    if settle_s:
        context = _settle(diagram, context, timings, settle_s)
    one_period = SampledMap(diagram, context, timings)
    search = _Search(one_period, find_state_layout(diagram), period_s)
    while search.residual > tolerance:
        if search.iterations == max_iterations or not search.step():
            raise ValueError(search.explain(tolerance, settle_s))
    found = one_period.context.Clone()
    set_state(found, search.x)
    return Equilibrium(found, search.residual, search.iterations)


class _Search:
    """Newton's method on the changes of the state over a period."""

    def __init__(self, one_period: SampledMap, layout: StateLayout, period_s: float):
        self._one_period = one_period
        self._layout = layout
        self._period_s = period_s
        self._damping = 0.0
        self.iterations = 0
        self.x = self._normalize(one_period.x)
        self._sizes = calc_sizes(self.x)
        self._change = self._calc_change(self.x)

    @property
    def residual(self) -> float:
        """Largest relative change; infinite if one is not finite."""
        relative = np.abs(self._change) / self._sizes
        return float(np.where(np.isfinite(relative), relative, np.inf).max(initial=0.0))

    def step(self) -> bool:
        """Moves to a better state; returns False if there is not one along the step."""
        if not np.isfinite(self._change).all():
            return False
        self.iterations += 1
        # In units of the coordinates' sizes, so that the length of a step is
        # meaningful.
        J = self._calc_jacobian() * self._sizes / self._sizes[:, np.newaxis]
        if not np.isfinite(J).all():
            return False
        U, sigma, Vt = np.linalg.svd(J)
        aim = U.T @ (self._change / self._sizes)
        held = sigma > _RANK * sigma[0]
        merit = float(np.linalg.norm(self._change / self._sizes))
        while self._damping <= _LARGEST_DAMPING:
            damped = sigma**2 + (self._damping * sigma[0]) ** 2
            part = np.zeros_like(sigma)
            part[held] = sigma[held] / damped[held] * aim[held]
            x = self._normalize(self.x - self._sizes * (Vt.T @ part))
            change = self._calc_change(x)
            lower = float(np.linalg.norm(change / self._sizes))
            if lower <= (1.0 - _LEAST_DECREASE) * merit:
                self.x, self._change = x, change
                self._sizes = calc_sizes(x)
                self._damping /= _RAISE**2
                if self._damping < _FIRST_DAMPING:
                    self._damping = 0.0
                return True
            self._damping = max(_FIRST_DAMPING, _RAISE * self._damping)
        return False

    def explain(self, tolerance: float, settle_s: float) -> str:
        """Returns why there is no equilibrium, and what to try."""
        relative = np.abs(self._change) / self._sizes
        worst = int(np.argmax(np.where(np.isfinite(relative), relative, np.inf)))
        longer = "a longer settle_s" if settle_s else "settle_s to simulate first"
        return (
            f"no equilibrium after {self.iterations} iterations:"
            f" {self._layout.names[worst]} still changes by {self._change[worst]:.3g}"
            f" in {self._period_s:g} s, more than {tolerance:g} of its size or 1. Start"
            f" nearer to rest, give {longer}, or more max_iterations; a body that"
            " nothing holds, or a contact that opens and closes, has none"
        )

    def _normalize(self, x: np.ndarray) -> np.ndarray:
        x = x.copy()
        for quaternion in self._layout.quaternions:
            x[list(quaternion)] /= np.linalg.norm(x[list(quaternion)])
        return x

    def _calc_change(self, x: np.ndarray) -> np.ndarray:
        """Returns [T ẋ_c; x_d⁺ - x_d], or NaN if a system reports that it diverged."""
        u, n_c = self._one_period.u, self._one_period.num_continuous
        try:
            values = self._one_period.calc(x, self._one_period.hold(x, u), u)
        except FloatingPointError:
            return np.full_like(x, np.nan)
        return np.concatenate([self._period_s * values.rates, values.update - x[n_c:]])

    def _calc_jacobian(self) -> np.ndarray:
        """Returns the derivative of the changes by the state, (n, n)."""
        one_period, x, n_c = self._one_period, self.x, self._one_period.num_continuous
        found = one_period.differentiate(
            x, one_period.hold(x, one_period.u), one_period.u
        )
        update = np.eye(len(x))
        update[n_c:] = found.update
        J = np.concatenate([self._period_s * found.rates @ update, found.update])
        J[n_c:, n_c:] -= np.eye(len(x) - n_c)
        return J


def _settle(
    diagram: System, context: Context, timings: Sequence[Timing], settle_s: float
) -> Context:
    """Returns the context after a simulation, its time set back to the start.

    Raises:
        ValueError: The system depends on time.
    """
    one_period = SampledMap(diagram, context, timings)
    x, u, time_s = one_period.x, one_period.u, context.get_time()
    held = one_period.hold(x, u)
    now = one_period.calc(x, held, u).stack()
    for share in (0.37, 1.0):
        one_period.context.SetTime(time_s + share * settle_s)
        if not np.array_equal(one_period.calc(x, held, u).stack(), now):
            raise ValueError(
                "settle_s needs a system that does not depend on time, but this one"
                " changes with it: settle by a simulation of your own up to the time"
                " of interest, and give its context"
            )
    # Caches of the simulation stay in the clone.
    settled = context.Clone()
    Simulator(diagram, settled).AdvanceTo(time_s + settle_s)
    settled.SetTime(time_s)
    return settled
