"""Base class of systems with AutoDiff twins, and vectors with derivatives."""

from __future__ import annotations

import sys
from abc import abstractmethod
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pydrake.autodiffutils import (
    AutoDiffXd,
    ExtractGradient,
    ExtractValue,
    InitializeAutoDiff,
)
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import (
    BasicVector_,
    CacheEntry,
    Context,
    Context_,
    DependencyTicket,
    DiscreteValues_,
    InputPort,
    InputPort_,
    LeafSystem,
    LeafSystem_,
    OutputPort,
    PortDataType,
    ValueProducer,
)
from pydrake.systems.scalar_conversion import TemplateSystem

from drake_haptics._core import AutoDiffVector, make_witness_override

# After each unrestricted update Drake asks every Python system for its witness
# functions. Calling this override takes less time than finding none.
get_no_witness_functions = make_witness_override()


# Value of a cache entry before its first one. (A Value of Drake 1.58 cannot hold None.)
NOTHING = "nothing"


class AutoDiffPoint:
    """The point at which a system is differentiated: its inputs, state and time.

    All vectors have derivatives by the same D variables; entries that do not depend on
    them have zeros.

    Attributes:
        state: The discrete state, all groups concatenated.
        time_s: The time (1,), s.
        parameters: The abstract parameters.
    """

    def __init__(
        self,
        twin: LeafSystem_[AutoDiffXd],
        context: Context_[AutoDiffXd],
        inputs: Iterable[int],
    ):
        """Reads the given inputs of a twin that have a value.

        Raises:
            ValueError: An abstract input carries no derivatives, or inputs have
                derivatives by different numbers of variables.
        """
        self._system = twin.GetSystemPathname()
        vectors: dict[str, np.ndarray] = {}
        self._inputs: dict[str, Any] = {}
        for port in map(twin.get_input_port, inputs):
            if not port.HasValue(context):
                continue
            kept = vectors if _is_vector(port) else self._inputs
            kept[port.get_name()] = port.Eval(context)
        state = [
            context.get_discrete_state(i).CopyToVector()
            for i in range(context.num_discrete_state_groups())
        ]
        self.parameters: tuple[Any, ...] = tuple(
            context.get_abstract_parameter(i).get_value()
            for i in range(context.num_abstract_parameters())
        )
        # Names that no port has.
        vectors["\0state"] = np.concatenate([np.zeros(0), *state])
        vectors["\0time"] = np.array([context.get_time()])
        self.num_derivatives = _find_num_derivatives(twin, vectors, self._inputs)
        # Values that are constant upstream have no derivatives yet.
        for name, value in self._inputs.items():
            if value.num_derivatives < self.num_derivatives:
                self._inputs[name] = value.with_variables(self.num_derivatives)
        for name, vector in vectors.items():
            self._inputs[name] = _to_core(vector, self.num_derivatives)
        self.state: AutoDiffVector = self._inputs.pop("\0state")
        self.time_s: AutoDiffVector = self._inputs.pop("\0time")

    def __contains__(self, port: str) -> bool:
        """Returns whether an input is connected or fixed."""
        return port in self._inputs

    def __getitem__(self, port: str) -> Any:
        """Returns an input: an `AutoDiffVector`, or the value of an abstract port.

        Raises:
            ValueError: The input is neither connected nor fixed, or the output does not
                depend on it.
        """
        if port not in self._inputs:
            raise ValueError(f"input {port} of {self._system} has no value")
        return self._inputs[port]

    def hold(self, value: np.ndarray) -> AutoDiffVector:
        """Returns numbers (n,) that depend on no variable."""
        return AutoDiffVector(value, np.zeros((len(value), self.num_derivatives)))

    def sum_wrench_models(self, ports: Iterable[InputPort]) -> AutoDiffVector:
        """Returns the sum (78,) of those wrench models that have a value."""
        value, gradient = np.zeros(78), np.zeros((78, self.num_derivatives))
        for name in (port.get_name() for port in ports):
            if name in self:
                value += self[name].value
                gradient += self[name].gradient
        return AutoDiffVector(value, gradient)


def join(parts: Sequence[AutoDiffVector]) -> AutoDiffVector:
    """Returns one vector of one or more others, in their order."""
    return AutoDiffVector(
        np.concatenate([part.value for part in parts]),
        np.concatenate([part.gradient for part in parts]),
    )


def take(vector: AutoDiffVector, rows: slice | list[int]) -> AutoDiffVector:
    """Returns some entries of a vector."""
    return AutoDiffVector(vector.value[rows], vector.gradient[rows])


# Conversion both ways: `ToAutoDiffXd` of pydrake 1.51 refuses a system outside of a
# diagram that converts one way only. Without the scope, pydrake reads the source of the
# whole stack to find this module.
@TemplateSystem.define(
    "_Convertible_", T_list=[float, AutoDiffXd], scope=sys.modules[__name__]
)
def _Convertible_(T: type) -> type:
    if T is float:

        class Impl(LeafSystem):
            def _construct(self, converter: Any = None) -> None:
                LeafSystem.__init__(self, converter=converter)

            def _construct_copy(self, other: Any, converter: Any = None) -> None:
                # Drake clones a system by converting it to another scalar and back.
                raise TypeError(
                    f"{other.GetSystemPathname()} cannot be cloned, and does not"
                    " convert back to doubles: build it once more, or keep the system"
                    " that it was made from"
                )

    else:

        class Impl(LeafSystem_[AutoDiffXd]):  # type: ignore[no-redef]
            def _construct(self, converter: Any = None) -> None:
                raise TypeError("the twin is made by conversion")

            def _construct_copy(self, other: Any, converter: Any = None) -> None:
                LeafSystem_[AutoDiffXd].__init__(self, converter=converter)
                _declare_twin(self, other)

    return Impl


if TYPE_CHECKING:
    from pydrake.systems.framework import LeafSystem as _Convertible
else:
    _Convertible = _Convertible_[float]


class DifferentiableSystem(_Convertible):
    """A LeafSystem of doubles that Drake can convert to AutoDiffXd.

    The twin has the same ports, discrete state, abstract parameters and periodic
    update, and asks this system for values and derivatives, so that the system itself
    remains one fast call of the core per tick. The twin has no publish events: it draws
    and prints nothing.

    A system defines `differentiate` if it has outputs, and `differentiate_update` if it
    has state. Systems with other state, with numeric parameters, or with discrete state
    without one periodic update do not convert.

    Attributes:
        undifferentiated: Names of inputs that the twin does not read, and of outputs
            that have no value there. They carry data between systems of doubles that
            makes a tick faster and is available at other ports too.
    """

    undifferentiated: frozenset[str] = frozenset()
    DoGetWitnessFunctions = get_no_witness_functions

    def DeclareObjectCacheEntry(
        self,
        description: str,
        calc: Callable[[Context, AbstractValue], None],
        prerequisites: set[DependencyTicket],
    ) -> CacheEntry:
        """Declares a cache entry of a Python object, at first `NOTHING`."""
        return self.DeclareCacheEntry(
            description=description,
            value_producer=ValueProducer(
                allocate=lambda: Value[object](NOTHING), calc=calc
            ),
            prerequisites_of_calc=prerequisites,
        )

    @abstractmethod
    def differentiate(self, port: str, at: AutoDiffPoint) -> Any:
        """Returns an output with its derivatives.

        Args:
            port: Name of the output.
            at: Point of differentiation, with the inputs that the output depends on
                directly.

        Returns:
            An `AutoDiffVector`; for an abstract output, a value that carries
            derivatives: it has `num_derivatives`, and `with_variables` if that can be
            zero.
        """

    @abstractmethod
    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the discrete state after the periodic update, all groups."""


def _declare_twin(twin: LeafSystem_[AutoDiffXd], system: DifferentiableSystem) -> None:
    """Declares the ports, state, parameters and update of a system in its twin.

    Raises:
        ValueError: The system has no derivatives, or something that a twin cannot have.
        TypeError: The system lacks a method that a twin would call.
    """
    if hasattr(system, "no_derivatives"):
        raise ValueError(
            f"no derivatives: {system.GetSystemPathname()} {system.no_derivatives}"
        )
    defaults = system.CreateDefaultContext()
    timing = system.GetUniquePeriodicDiscreteUpdateAttribute()
    for impossible, what in [
        (defaults.num_continuous_states(), "continuous state"),
        (defaults.num_abstract_states(), "abstract state"),
        (defaults.num_numeric_parameter_groups(), "numeric parameters"),
        (
            bool(defaults.num_discrete_state_groups()) != (timing is not None),
            "discrete state without one periodic update, or the reverse",
        ),
    ]:
        if impossible:
            raise ValueError(
                f"{system.GetSystemPathname()} has {what}: no system of type"
                " AutoDiffXd can be made from it"
            )
    outputs = [system.get_output_port(i) for i in range(system.num_output_ports())]
    needed = {
        "differentiate"
        for output in outputs
        if output.get_name() not in system.undifferentiated
    }
    if timing is not None:
        needed.add("differentiate_update")
    for method in sorted(needed):
        if hasattr(getattr(system, method), "__isabstractmethod__"):
            raise TypeError(f"{type(system).__name__} must define {method}")
    for port in map(system.get_input_port, range(system.num_input_ports())):
        if _is_vector(port):
            twin.DeclareVectorInputPort(port.get_name(), port.size())
        else:
            twin.DeclareAbstractInputPort(port.get_name(), Value[object]())
    for i in range(defaults.num_abstract_parameters()):
        twin.DeclareAbstractParameter(defaults.get_abstract_parameter(i).Clone())
    for i in range(defaults.num_discrete_state_groups()):
        twin.DeclareDiscreteState(_to_constants(defaults.get_discrete_state(i).value()))
    if timing is not None:
        twin.DeclarePeriodicDiscreteUpdateEvent(
            timing.period_sec(),
            timing.offset_sec(),
            lambda context, next_state: _update(twin, system, context, next_state),
        )
    for output in outputs:
        inputs = [
            i
            for i in _list_inputs(system)
            if system.HasDirectFeedthrough(i, output.get_index())
        ]
        _declare_output(twin, system, output, inputs)


def _refuse(context: Context_[AutoDiffXd], value: AbstractValue) -> None:
    raise ValueError("the port has no value under AutoDiffXd")


def _list_inputs(system: DifferentiableSystem) -> list[int]:
    """Returns the inputs that a twin reads."""
    return [
        i
        for i in range(system.num_input_ports())
        if system.get_input_port(i).get_name() not in system.undifferentiated
    ]


def _declare_output(
    twin: LeafSystem_[AutoDiffXd],
    system: DifferentiableSystem,
    output: OutputPort,
    inputs: list[int],
) -> None:
    """Declares an output of a twin that depends directly on some inputs."""
    name = output.get_name()
    if name in system.undifferentiated:
        twin.DeclareAbstractOutputPort(
            name, Value[object], _refuse, {twin.nothing_ticket()}
        )
        return
    tickets = {twin.xd_ticket(), twin.time_ticket(), twin.pa_ticket()}
    tickets |= {twin.get_input_port(i).ticket() for i in inputs}

    def calc_vector(
        context: Context_[AutoDiffXd], vector: BasicVector_[AutoDiffXd]
    ) -> None:
        answer = system.differentiate(name, AutoDiffPoint(twin, context, inputs))
        vector.SetFromVector(_from_core(answer))

    def calc_abstract(context: Context_[AutoDiffXd], value: AbstractValue) -> None:
        value.set_value(
            system.differentiate(name, AutoDiffPoint(twin, context, inputs))
        )

    if _is_vector(output):
        twin.DeclareVectorOutputPort(name, output.size(), calc_vector, tickets)
    else:
        twin.DeclareAbstractOutputPort(name, Value[object], calc_abstract, tickets)


def _update(
    twin: LeafSystem_[AutoDiffXd],
    system: DifferentiableSystem,
    context: Context_[AutoDiffXd],
    next_state: DiscreteValues_[AutoDiffXd],
) -> None:
    at = AutoDiffPoint(twin, context, _list_inputs(system))
    answer = _from_core(system.differentiate_update(at))
    start = 0
    for i in range(next_state.num_groups()):
        group = next_state.get_vector(i)
        group.SetFromVector(answer[start : start + group.size()])
        start += group.size()


def _to_constants(values: np.ndarray) -> np.ndarray:
    """Returns Drake's scalars without derivatives."""
    return InitializeAutoDiff(values, np.zeros((values.size, 0))).ravel()


def _is_vector(port: InputPort_[AutoDiffXd] | OutputPort) -> bool:
    return port.get_data_type() == PortDataType.kVectorValued


def _find_num_derivatives(
    twin: LeafSystem_[AutoDiffXd],
    vectors: dict[str, np.ndarray],
    values: dict[str, Any],
) -> int:
    """Returns the number D of variables, 0 if nothing has derivatives."""
    sizes = {
        entry.derivatives().size for vector in vectors.values() for entry in vector
    }
    for name, value in values.items():
        if not hasattr(value, "num_derivatives"):
            raise ValueError(
                f"input {name} of {twin.GetSystemPathname()} is a"
                f" {type(value).__name__}, which carries no derivatives: fix or"
                " connect the value that a system of type AutoDiffXd gives"
            )
        sizes.add(value.num_derivatives)
    sizes.discard(0)
    if len(sizes) > 1:
        raise ValueError(
            f"inputs of {twin.GetSystemPathname()} have derivatives by different"
            f" numbers of variables: {sorted(sizes)}"
        )
    return sizes.pop() if sizes else 0


def _to_core(vector: np.ndarray, num_derivatives: int) -> AutoDiffVector:
    """Converts Drake's scalars to the core's; constants get zero derivatives."""
    gradient = ExtractGradient(vector.reshape(-1, 1))
    if gradient.shape[1] == 0:
        gradient = np.zeros((len(vector), num_derivatives))
    return AutoDiffVector(ExtractValue(vector.reshape(-1, 1)).ravel(), gradient)


def _from_core(vector: AutoDiffVector) -> np.ndarray:
    """Converts the core's scalars to Drake's."""
    return InitializeAutoDiff(vector.value, vector.gradient).ravel()
