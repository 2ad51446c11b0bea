"""The exact linear map of a sampled system over one period.

Drake's `Linearize` takes a system that is all continuous or one discrete group. A
haptic loop is neither: a device moves continuously, and its controller samples it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

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

from drake_haptics.analysis.derivative_check import check_derivatives
from drake_haptics.analysis.diagram_systems import list_state_names
from drake_haptics.analysis.drake_errors import explain_drake_errors
from drake_haptics.analysis.sampled_map import SampledMap, SampledValues
from drake_haptics.analysis.sampled_preconditions import (
    check_abstract_state,
    check_conversion,
    check_events,
    find_period,
)

_Port = TypeVar("_Port", InputPort, OutputPort)


@dataclass(frozen=True)
class SampledLinearization:
    """x⁺ = A x + B u, y = C x + D u about an equilibrium, x = [x_c; discrete groups].

    The state is that just before a sampling instant; u is held over the period.

    Attributes:
        A: (n, n).
        B: (n, m), without columns if no input was chosen.
        C: (p, n), without rows if no output was chosen.
        D: (p, m).
        period_s: T, s.
        state_names: (n,), as "plant/tool_x" or "controller/xd[0]".
        state: (n,) the equilibrium.
        equilibrium_residual: Largest change of a state over one period, relative to
            its size or 1, whichever is larger.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    period_s: float
    state_names: tuple[str, ...]
    state: np.ndarray
    equilibrium_residual: float

    def eigenvalues(self) -> np.ndarray:
        """Returns the eigenvalues of A (n,), complex, largest magnitude first."""
        values = np.linalg.eigvals(self.A).astype(complex)
        return values[np.argsort(-np.abs(values), kind="stable")]

    def spectral_radius(self) -> float:
        """Returns the largest magnitude of an eigenvalue: stable below 1."""
        return float(np.abs(self.eigenvalues()).max())

    def to_linear_system(self) -> LinearSystem:
        """Returns Drake's discrete-time system of the same matrices and period."""
        return LinearSystem(self.A, self.B, self.C, self.D, self.period_s)

    def to_dict(self) -> dict[str, Any]:
        """Returns the fields and the eigenvalues ([re, im] each), ready for JSON."""
        return {
            "A": self.A.tolist(),
            "B": self.B.tolist(),
            "C": self.C.tolist(),
            "D": self.D.tolist(),
            "period_s": self.period_s,
            "state_names": list(self.state_names),
            "state": self.state.tolist(),
            "equilibrium_residual": self.equilibrium_residual,
            "eigenvalues": [[z.real, z.imag] for z in self.eigenvalues()],
        }


@explain_drake_errors("linearizing over one period")
def linearize_sampled(
    diagram: System,
    context: Context,
    *,
    period_s: float | None = None,
    input_port: int | str | None = None,
    output_port: int | str | None = None,
    tolerance: float = 1e-8,
) -> SampledLinearization:
    """Linearizes a system over one period, its discrete and continuous parts together.

    In Drake's order: all discrete groups are updated at t from the state before it,
    x_d⁺ = f_d(x_c, x_d, u); then ẋ_c = f_c(x_c, x_d⁺, u) flows over T with x_d⁺ and u
    held, exactly, by the matrix exponential (zero-order hold: Franklin, Powell and
    Workman, Digital Control of Dynamic Systems, section 4.3.3). Time and all other
    inputs stay what they are in the context. Derivatives are AutoDiffXd's, compared
    with differences of doubles.

    Only a clone of the context is evaluated. To find events that Drake would ignore,
    the clone is simulated for part of a period: publish events run there.

    Args:
        diagram: Any system that converts to AutoDiffXd: discrete, continuous or both.
        context: Its root context, at an equilibrium.
        period_s: T, s; needed only if nothing is updated periodically.
        input_port: Index or name of the vector input u, or none.
        output_port: Index or name of the vector output y, or none.
        tolerance: Bound of `equilibrium_residual`.

    Raises:
        ValueError: The state is no equilibrium (see `find_equilibrium`); there are
            several periods (see `monodromy`), offsets, abstract states, unrestricted
            or per-step updates; a system does not convert, or loses derivatives; a
            port is not there, abstract or open; Drake refuses otherwise.
    """
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance must be between 0 and 1, is {tolerance}")
    check_abstract_state(diagram)
    period, updates = find_period(diagram, context, period_s)
    check_conversion(diagram)
    one_period = SampledMap(
        diagram,
        context,
        updates=updates,
        input_port=_find_input(diagram, context, input_port),
        output_port=_find_output(diagram, output_port),
    )
    x, u, n_c = one_period.x, one_period.u, one_period.num_continuous
    if len(x) == 0:
        raise ValueError("the system has no state: there is nothing to linearize")
    check_events(diagram, one_period.context, period)
    names = list_state_names(diagram)
    held = one_period.hold(x, u)
    values = one_period.calc(x, held, u)
    residual = _check_equilibrium(x, values, period, names, tolerance)
    jacobian = one_period.differentiate(x, held, u)
    check_derivatives(
        one_period,
        jacobian,
        x,
        held,
        u,
        [*names[n_c:], *names[:n_c], *(f"y[{i}]" for i in range(len(values.output)))],
        [*names, *(f"u[{i}]" for i in range(len(u)))],
    )
    A_B = _compose(jacobian, n_c, len(x), period)
    return SampledLinearization(
        A=A_B[:, : len(x)],
        B=A_B[:, len(x) :],
        C=jacobian.output[:, : len(x)],
        D=jacobian.output[:, len(x) :],
        period_s=period,
        state_names=tuple(names),
        state=x,
        equilibrium_residual=residual,
    )


def _compose(jacobian: SampledValues, n_c: int, n: int, period_s: float) -> np.ndarray:
    """Returns [A B] (n, n + m): update, then exact flow with the rest held."""
    size = jacobian.update.shape[1]
    # [x_c; x_d; u] -> [x_c; x_d⁺; u]
    update = np.eye(size)
    update[n_c:n] = jacobian.update
    rates = np.zeros((size, size))
    rates[:n_c] = jacobian.rates
    return (expm(rates * period_s) @ update)[:n]


def _check_equilibrium(
    x: np.ndarray,
    values: SampledValues,
    period_s: float,
    names: list[str],
    tolerance: float,
) -> float:
    """Returns the largest relative change over a period, or raises ValueError."""
    n_c = len(values.rates)
    change = np.concatenate([period_s * values.rates, values.update - x[n_c:]])
    relative = np.abs(change) / np.maximum(np.abs(x), 1.0)
    worst = int(np.argmax(np.where(np.isfinite(relative), relative, np.inf)))
    if not relative[worst] <= tolerance:
        raise ValueError(
            f"not an equilibrium: {names[worst]} changes by {change[worst]:.3g} in one"
            f" period, more than {tolerance:g} of its size or 1: use the context that"
            " find_equilibrium returns"
        )
    return float(relative[worst])


def _find_input(
    system: System, context: Context, chosen: int | str | None
) -> InputPort | None:
    """Returns the vector input port of an index or a name."""
    ports = [system.get_input_port(i) for i in range(system.num_input_ports())]
    port = _find_port("input_port", ports, chosen)
    if port is not None and not port.HasValue(context):
        raise ValueError(
            f"input_port {port.get_name()} has no value: fix it in the context with"
            " FixValue"
        )
    return port


def _find_output(system: System, chosen: int | str | None) -> OutputPort | None:
    """Returns the vector output port of an index or a name."""
    ports = [system.get_output_port(i) for i in range(system.num_output_ports())]
    return _find_port("output_port", ports, chosen)


def _find_port(kind: str, ports: list[_Port], chosen: int | str | None) -> _Port | None:
    """Returns the vector port of an index or a name."""
    if chosen is None:
        return None
    names = [port.get_name() for port in ports]
    index = names.index(chosen) if chosen in names else chosen
    if not isinstance(index, int) or not 0 <= index < len(ports):
        raise ValueError(f"{kind} must be one of {names} or its index, is {chosen!r}")
    if ports[index].get_data_type() != PortDataType.kVectorValued:
        raise ValueError(f"{kind} {names[index]} is abstract: choose a vector port")
    return ports[index]
