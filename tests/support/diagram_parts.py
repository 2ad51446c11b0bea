"""The parts of a built diagram: names of systems and ports, and what outputs have."""

from __future__ import annotations

from pydrake.systems.framework import Context, Diagram, OutputPort, System

from drake_haptics.scene.schema import (
    BrakingParameters,
    FrictionParameters,
    GravityParameters,
    PassivityParameters,
    ShadingParameters,
)

# The systems of every scene.
SYSTEMS = {
    "device",
    "virtual_coupling",
    "haptic_tool",
    "contact_query",
    "contact_clustering",
    "penalty_force",
}
# Every effect, with its defaults.
EVERY = {
    "shading": ShadingParameters(),
    "friction": FrictionParameters(),
    "braking": BrakingParameters(),
    "gravity": GravityParameters(),
    "passivity": PassivityParameters(),
}


def names(diagram: Diagram) -> set[str]:
    return {system.get_name() for system in diagram.GetSystems()}


def inputs(system: System) -> set[str]:
    ports = map(system.get_input_port, range(system.num_input_ports()))
    return {port.get_name() for port in ports}


def outputs(system: System) -> set[str]:
    ports = map(system.get_output_port, range(system.num_output_ports()))
    return {port.get_name() for port in ports}


def sources(diagram: Diagram) -> dict[str, str]:
    """Returns the output that feeds each input, both as "system.port"."""
    return {
        f"{system.get_name()}.{system.get_input_port(i).get_name()}": (
            f"{source.get_name()}.{source.get_output_port(j).get_name()}"
        )
        for (system, i), (source, j) in diagram.connection_map().items()
    }


def unfed(diagram: Diagram) -> set[str]:
    """Returns the inputs that no output feeds, as "system.port"."""
    systems = diagram.GetSystems()
    every = {f"{one.get_name()}.{port}" for one in systems for port in inputs(one)}
    return every - sources(diagram).keys()


def read_port(port: OutputPort, root: Context):
    """Returns what an output port within a diagram has, by the Context of all of it."""
    return port.Eval(port.get_system().GetMyContextFromRoot(root))


def read_output(system: System, name: str, root: Context):
    """Returns what an output of a system has, as `read_port`."""
    return read_port(system.GetOutputPort(name), root)


def read_tool(haptic, root: Context):
    """Returns [X_WT; V_WT] (13,)."""
    tool = haptic.loop.haptic_tool.GetMyContextFromRoot(root)
    return tool.get_discrete_state_vector().value()
