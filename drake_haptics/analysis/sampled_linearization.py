"""Linearizes a sampled system exactly over one period.

Drake's `Linearize` takes a system that is all continuous or has one discrete group. A
haptic loop is neither: a device moves continuously, and its controller samples it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from pydrake.systems.framework import (
    Context,
    InputPort,
    OutputPort,
    PortDataType,
    System,
)
from pydrake.systems.primitives import LinearSystem
from scipy.linalg import expm

from drake_haptics.analysis.derivative_check import (
    calc_sizes,
    check_derivatives,
    find_wrong_rows,
    move_beside,
)
from drake_haptics.analysis.diagram_systems import find_state_layout, find_timings
from drake_haptics.analysis.jobs.blas_threads import on_one_blas_thread
from drake_haptics.analysis.modes import PeriodMap, check_return
from drake_haptics.analysis.preconditions import (
    check_abstract_state,
    check_conversion,
    check_events,
    check_system_and_context,
    explain_drake_errors,
    find_period,
)
from drake_haptics.analysis.sampled_map import SampledMap, SampledValues
from drake_haptics.common.one_line import one_line

_Port = TypeVar("_Port", InputPort, OutputPort)


@dataclass(frozen=True)
class SampledLinearization(PeriodMap):
    """x⁺ = A x + B u, y = C x + D u about an equilibrium; u is held over the period.

    Attributes:
        B: (n, m), without columns if no input was chosen.
        C: (p, n), without rows if no output was chosen.
        D: (p, m).
        update: (n, n) the discrete update alone, x_c unchanged.
        rates: (n, n) rates of the motion after it, zero in the rows of x_d:
            A = exp(T rates) update.
        kinks: Names of the states and outputs whose slope differs between the two sides
            of the equilibrium, as at a contact that just opens or rests without speed;
            their derivative is that of AutoDiffXd.
    """

    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    update: np.ndarray
    rates: np.ndarray
    kinks: tuple[str, ...]

    __repr__ = one_line

    def to_linear_system(self) -> LinearSystem:
        """Returns Drake's discrete-time system of the same matrices and period."""
        return LinearSystem(self.A, self.B, self.C, self.D, self.period_s)


@explain_drake_errors("linearizing over one period")
@on_one_blas_thread
def linearize_sampled(
    diagram: System,
    context: Context,
    *,
    period_s: float | None = None,
    input_port: int | str | None = None,
    output_port: int | str | None = None,
    tolerance: float = 1e-8,
) -> SampledLinearization:
    """Linearizes a system with discrete and continuous parts over one period.

    In Drake's order: all discrete groups are updated at t from the state before it,
    x_d⁺ = f_d(x_c, x_d, u); then ẋ_c = f_c(x_c, x_d⁺, u) flows over T with x_d⁺ and u
    held, exactly, by the matrix exponential (zero-order hold: Franklin, Powell and
    Workman, Digital Control of Dynamic Systems, section 4.3.3). Time and all other
    inputs keep their values in the context. Derivatives are AutoDiffXd's, and are
    compared with differences of doubles.

    Only a clone of the context is evaluated. To find events that Drake would ignore,
    the clone is simulated for part of a period: publish events run there.

    Args:
        diagram: Any system that converts to AutoDiffXd: discrete, continuous or both.
        context: Its root context, at an equilibrium.
        period_s: T, s; only needed if nothing is updated periodically.
        input_port: Index or name of the vector input u; None for no input.
        output_port: Index or name of the vector output y; None for no output.
        tolerance: Bound of `equilibrium_residual`.

    Raises:
        ValueError: The state is not an equilibrium (see `find_equilibrium`); there are
            several periods (see `calc_monodromy`), offsets, abstract states, or
            unrestricted or per-step updates; a system does not convert, or loses
            derivatives; a port does not exist, is abstract or is open; or Drake refuses
            the diagram.
    """
    check_system_and_context(diagram, context)
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance must be between 0 and 1, is {tolerance}")
    check_abstract_state(diagram)
    timings = find_timings(diagram, context)
    period = find_period(timings, period_s)
    check_conversion(diagram)
    one_period = SampledMap(
        diagram,
        context,
        timings,
        input_port=_find_input(diagram, context, input_port),
        output_port=_find_output(diagram, output_port),
    )
    x, u, n_c = one_period.x, one_period.u, one_period.num_continuous
    if len(x) == 0:
        raise ValueError("the system has no state: there is nothing to linearize")
    check_events(diagram, context, period)
    layout = find_state_layout(diagram)
    names = layout.names
    held = one_period.hold(x, u)
    values = one_period.calc(x, held, u)
    change = np.concatenate([period * values.rates, values.update - x[n_c:]])
    residual = check_return(x, change, names, tolerance)
    outputs = [f"y[{i}]" for i in range(len(values.output))]
    _check_nearby(one_period, names, outputs)
    n, jacobian = len(x), one_period.differentiate(x, held, u)
    kinks = find_wrong_rows(
        _step_from(one_period, np.concatenate([x, u]), held),
        jacobian.stack(),
        calc_sizes(np.concatenate([x, u])),
    )
    rows = [*names[n_c:], *names[:n_c], *outputs]
    update, rates = _extend(jacobian, n_c, n)
    A_B = expm(rates * period) @ update
    return SampledLinearization(
        A=A_B[:n, :n],
        B=A_B[:n, n:],
        C=jacobian.output[:, :n],
        D=jacobian.output[:, n:],
        update=update[:n, :n],
        rates=rates[:n, :n],
        period_s=period,
        state_names=names,
        state=x,
        quaternions=layout.quaternions,
        equilibrium_residual=residual,
        kinks=tuple(name for name, kink in zip(rows, kinks, strict=True) if kink),
    )


def _check_nearby(
    one_period: SampledMap, names: tuple[str, ...], outputs: list[str]
) -> None:
    """Compares derivatives with differences near the state.

    A lost derivative is lost on both sides, but a limit, such as that of a device's
    torque, may happen to be at one of the two points.
    """
    try:
        _check_beside(one_period, names, outputs, 1.0)
    except ValueError:
        _check_beside(one_period, names, outputs, -1.0)


def _check_beside(
    one_period: SampledMap, names: tuple[str, ...], outputs: list[str], side: float
) -> None:
    n, n_c = len(one_period.x), one_period.num_continuous
    point = move_beside(np.concatenate([one_period.x, one_period.u]), side)
    held = one_period.hold(point[:n], point[n:])
    check_derivatives(
        _step_from(one_period, point, held),
        one_period.differentiate(point[:n], held, point[n:]).stack(),
        calc_sizes(point),
        [*names[n_c:], *names[:n_c], *outputs],
        [*names, *(f"u[{i}]" for i in range(len(point) - n))],
    )


def _step_from(
    one_period: SampledMap, point: np.ndarray, held: np.ndarray
) -> Callable[[np.ndarray], np.ndarray]:
    """Returns the values as a function of a step from a point [x; u]."""
    x, u = np.split(point, [len(held)])

    def function(step: np.ndarray) -> np.ndarray:
        step_x, step_u = np.split(step, [len(held)])
        return one_period.calc(x + step_x, held + step_x, u + step_u).stack()

    return function


def _extend(jacobian: SampledValues, n_c: int, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns update and rates of [x_c; x_d; u], each (n + m, n + m)."""
    size = jacobian.update.shape[1]
    update = np.eye(size)
    update[n_c:n] = jacobian.update
    rates = np.zeros((size, size))
    rates[:n_c] = jacobian.rates
    return update, rates


def _find_input(
    system: System, context: Context, chosen: int | str | None
) -> InputPort | None:
    """Returns the vector input port with an index or a name."""
    ports = [system.get_input_port(i) for i in range(system.num_input_ports())]
    port = _find_port("input_port", ports, chosen)
    if port is not None and not port.HasValue(context):
        raise ValueError(
            f"input_port {port.get_name()} has no value: fix it in the context with"
            " FixValue"
        )
    return port


def _find_output(system: System, chosen: int | str | None) -> OutputPort | None:
    """Returns the vector output port with an index or a name."""
    ports = [system.get_output_port(i) for i in range(system.num_output_ports())]
    return _find_port("output_port", ports, chosen)


def _find_port(kind: str, ports: list[_Port], chosen: int | str | None) -> _Port | None:
    """Returns the vector port with an index or a name."""
    if chosen is None:
        return None
    names = [port.get_name() for port in ports]
    index = names.index(chosen) if chosen in names else chosen
    if not isinstance(index, int) or not 0 <= index < len(ports):
        raise ValueError(f"{kind} must be one of {names} or its index, is {chosen!r}")
    if ports[index].get_data_type() != PortDataType.kVectorValued:
        raise ValueError(f"{kind} {names[index]} is abstract: choose a vector port")
    return ports[index]
