"""Evaluates one period of a sampled system: its discrete update, then its motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.autodiffutils import ExtractGradient, InitializeAutoDiff
from pydrake.systems.framework import (
    Context,
    DiscreteValues,
    InputPort,
    OutputPort,
    System,
)

from drake_haptics.analysis.diagram_systems import AutoDiffClone, Timing, calc_path
from drake_haptics.common.one_line import one_line
from drake_haptics.common.subsystems import walk_leaves


@dataclass(frozen=True)
class SampledValues:
    """The results of one period of a sampled system, or their derivatives.

    Attributes:
        update: (n_d,) x_d⁺, the discrete groups after the update at t from x(t⁻); or
            (n_d, n + m), its derivative by [x_c; x_d; u].
        rates: (n_c,) ẋ_c with x_d⁺ held; or (n_c, n + m), by [x_c; x_d⁺; u].
        output: (p,) y at t⁻; or (p, n + m), by [x_c; x_d; u].
    """

    update: np.ndarray
    rates: np.ndarray
    output: np.ndarray

    __repr__ = one_line

    def stack(self) -> np.ndarray:
        """Returns all rows, (n_d + n_c + p, ...)."""
        return np.concatenate([self.update, self.rates, self.output])


class SampledMap:
    """x_d⁺ = f_d(x_c, x_d, u), ẋ_c = f_c(x_c, x_d⁺, u), y = g(x_c, x_d, u) of a system.

    It is evaluated in doubles and in AutoDiffXd, at one time and with all other inputs
    as they are in the context. All discrete groups that are updated periodically are
    updated, whatever their period.

    Attributes:
        x: (n,) the context's state [x_c; all discrete groups].
        u: (m,) the value of the input port, empty without one.
        num_continuous: n_c.
        context: A clone of the context, which the functions leave changed.
    """

    def __init__(
        self,
        system: System,
        context: Context,
        timings: Sequence[Timing],
        *,
        input_port: InputPort | None = None,
        output_port: OutputPort | None = None,
    ):
        """Reads state and input.

        Args:
            system: Any system; its AutoDiffXd twin is made on first use.
            context: Its root context; only a clone is used.
            timings: The timings that `find_timings` found.
            input_port: A vector port of the system, which has a value.
            output_port: A vector port of the system.

        Raises:
            ValueError: A system has several timings, which pydrake cannot evaluate one
                at a time.
        """
        names = [timing.system for timing in timings]
        several = sorted({name for name in names if names.count(name) > 1})
        if several:
            raise ValueError(
                f"{several[0]} updates its state at several timings, which cannot be"
                " evaluated singly: make a system of each"
            )
        self.context = context.Clone()
        self._system = system
        self._updated = [
            calc_path(system, leaf) in names for leaf in walk_leaves(system)
        ]
        self._input = None if input_port is None else int(input_port.get_index())
        self._output = None if output_port is None else int(output_port.get_index())
        self._twin: AutoDiffClone | None = None
        self.num_continuous = self.context.num_continuous_states()
        self.x = get_state(self.context)
        self.u = np.zeros(0)
        if input_port is not None:
            self.u = np.array(input_port.Eval(self.context))

    def hold(self, x: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Returns [x_c; x_d⁺] (n,), from which the motion starts."""
        return self._step(self._system, self.context, x, u)

    def calc(self, x: np.ndarray, held: np.ndarray, u: np.ndarray) -> SampledValues:
        """Returns the values of the three functions.

        Args:
            x: (n,) state at which update and output are taken.
            held: (n,) state [x_c; x_d⁺] at which the rates are taken.
            u: (m,) the input.
        """
        return self._calc(self._system, self.context, x, held, u)

    def differentiate(
        self, x: np.ndarray, held: np.ndarray, u: np.ndarray
    ) -> SampledValues:
        """Returns the derivatives of the three functions, with the arguments of `calc`.

        A row without derivatives is zero; `check_derivatives` finds out whether it
        should be.

        Raises:
            RuntimeError: A system has no AutoDiffXd twin, or cannot be evaluated.
        """
        size = len(x) + len(u)
        seed = InitializeAutoDiff(np.concatenate([x, u])).ravel()
        seed_held = InitializeAutoDiff(np.concatenate([held, u])).ravel()
        n = len(x)
        twin = self._twin = self._twin or AutoDiffClone(self._system)
        self._set(self._system, self.context, x, u)
        twin.follow(self.context)
        found = self._calc(twin.system, twin.context, seed[:n], seed_held[:n], seed[n:])
        return SampledValues(
            extract_gradient(found.update, size),
            extract_gradient(found.rates, size),
            extract_gradient(found.output, size),
        )

    def _calc(
        self,
        system: System,
        context: Context,
        x: np.ndarray,
        held: np.ndarray,
        u: np.ndarray,
    ) -> SampledValues:
        """Returns the values in the scalar type of the system."""
        update = self._step(system, context, x, u)[self.num_continuous :]
        output = np.zeros(0)
        if self._output is not None:
            output = system.get_output_port(self._output).Eval(context)
        rates = np.zeros(0)
        if self.num_continuous:
            self._set(system, context, held, u)
            rates = system.EvalTimeDerivatives(context).CopyToVector()
        return SampledValues(update, rates, output)

    def _step(
        self, system: System, context: Context, x: np.ndarray, u: np.ndarray
    ) -> np.ndarray:
        self._set(system, context, x, u)
        next_x = [x[: self.num_continuous]]
        for leaf, updated in zip(walk_leaves(system), self._updated, strict=True):
            if leaf.num_discrete_state_groups() == 0:
                continue
            own = leaf.GetMyContextFromRoot(context)
            if updated:
                next_x += _copy_groups(leaf.EvalUniquePeriodicDiscreteUpdate(own))
            else:
                next_x += _copy_groups(own.get_discrete_state())
        return np.concatenate(next_x)

    def _set(
        self, system: System, context: Context, x: np.ndarray, u: np.ndarray
    ) -> None:
        set_state(context, x)
        if self._input is not None:
            system.get_input_port(self._input).FixValue(context, u)


def get_state(context: Context) -> np.ndarray:
    """Returns the state [x_c; all discrete groups] (n,) of a context."""
    x_c = context.get_continuous_state_vector().CopyToVector()
    return np.concatenate([x_c, *_copy_groups(context.get_discrete_state())])


def set_state(context: Context, x: np.ndarray) -> None:
    """Sets the state [x_c; all discrete groups] (n,) of a context."""
    end = context.num_continuous_states()
    if end:
        context.SetContinuousState(x[:end])
    for i in range(context.num_discrete_state_groups()):
        start, end = end, end + context.get_discrete_state(i).size()
        context.SetDiscreteState(i, x[start:end])


def _copy_groups(values: DiscreteValues) -> list[np.ndarray]:
    return [values.get_vector(i).CopyToVector() for i in range(values.num_groups())]


def extract_gradient(values: np.ndarray, size: int) -> np.ndarray:
    """Returns the gradient (len(values), size), zero where all are constants."""
    if len(values) == 0:
        return np.zeros((0, size))
    gradient = ExtractGradient(values.reshape(-1, 1))
    return gradient if gradient.shape[1] else np.zeros((len(values), size))
