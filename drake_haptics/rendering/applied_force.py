"""Several users of the one port through which a plant takes applied forces."""

from __future__ import annotations

from pydrake.multibody.plant import (
    ExternallyAppliedSpatialForceMultiplexer,
    MultibodyPlant,
)
from pydrake.systems.framework import DiagramBuilder, OutputPort


def AddAppliedSpatialForce(
    builder: DiagramBuilder, plant: MultibodyPlant, forces: OutputPort
) -> None:
    """Connects forces to a plant beside all that are connected to it already.

    Where the plant's port `applied_spatial_force` is free, this is `Connect`. Where
    something feeds it, such as another `AddHapticRendering`, a thruster, or the mouse
    of a newer Drake's `AddDefaultVisualization`, that and `forces` go through an
    `ExternallyAppliedSpatialForceMultiplexer`, and both act.

    Args:
        builder: Of the diagram with the plant.
        plant: Finalized.
        forces: A list of `ExternallyAppliedSpatialForce`, of a system in the builder.

    Raises:
        ValueError: The port is an input of the diagram itself, to which nothing can be
            connected any more.
    """
    port = plant.get_applied_spatial_force_input_port()
    earlier = find_applied_force(builder, plant)
    if earlier is None:
        builder.Connect(forces, port)
        return
    builder.Disconnect(earlier, port)
    both = builder.AddNamedSystem(
        f"{forces.get_system().get_name()}_{forces.get_name()}_beside_others",
        ExternallyAppliedSpatialForceMultiplexer(num_inputs=2),
    )
    builder.Connect(earlier, both.get_input_port(0))
    builder.Connect(forces, both.get_input_port(1))
    builder.Connect(both.get_output_port(), port)


def find_applied_force(
    builder: DiagramBuilder, plant: MultibodyPlant
) -> OutputPort | None:
    """Returns what feeds a plant's port `applied_spatial_force` so far.

    Raises:
        ValueError: As `AddAppliedSpatialForce`.
    """
    port = plant.get_applied_spatial_force_input_port()
    if not builder.IsConnectedOrExported(port):
        return None
    source = builder.connection_map().get((plant, port.get_index()))
    if source is None:
        raise ValueError(
            f"plant {plant.get_name()!r}: its port {port.get_name()} is exported as an"
            " input of the diagram, so that no other force can act: call ExportInput"
            " not on it, but on an input of an ExternallyAppliedSpatialForceMultiplexer"
            " that you pass to AddAppliedSpatialForce"
        )
    system, index = source
    return system.get_output_port(index)
