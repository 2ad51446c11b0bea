"""The parts of a built diagram: names of systems and of the outputs that feed them."""

from __future__ import annotations

from pydrake.systems.framework import Diagram

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


def sources(diagram: Diagram) -> dict[str, str]:
    """Returns the output that feeds each input, both as "system.port"."""
    return {
        f"{system.get_name()}.{system.get_input_port(i).get_name()}": (
            f"{source.get_name()}.{source.get_output_port(j).get_name()}"
        )
        for (system, i), (source, j) in diagram.connection_map().items()
    }
