"""Ports of diagrams for parts of a system's vector."""

from __future__ import annotations

from collections.abc import Mapping

from pydrake.systems.framework import (
    Diagram,
    DiagramBuilder,
    InputPort,
    OutputPort,
    System,
)
from pydrake.systems.primitives import Demultiplexer, Multiplexer


def export_parts(
    builder: DiagramBuilder, vector: OutputPort, sizes: Mapping[str, int]
) -> None:
    """Exports consecutive parts of a vector output as outputs of the diagram.

    A system of Drake splits it, which takes little time compared with a port that
    Python calculates.

    Args:
        builder: Builder of the diagram.
        vector: Output port of a system in the diagram.
        sizes: Size of each part by the name of its port, in order. The rest of the
            vector is not exported.
    """
    rest = vector.size() - sum(sizes.values())
    all_sizes = [*sizes.values(), *([rest] if rest else [])]
    parts = builder.AddNamedSystem("parts", Demultiplexer(all_sizes))
    builder.Connect(vector, parts.get_input_port(0))
    for i, name in enumerate(sizes):
        builder.ExportOutput(parts.get_output_port(i), name)


def BuildAround(
    diagram: Diagram, name: str, system: System, sizes: Mapping[str, int]
) -> None:
    """Builds a diagram of one system, with the system's ports.

    Args:
        diagram: Diagram under construction.
        name: Name of the system in it.
        system: System, not yet in a diagram.
        sizes: Parts of the system's first output that are ports of the diagram in its
            place, as for `export_parts`.
    """
    builder = DiagramBuilder()
    builder.AddNamedSystem(name, system)
    for port in map(system.get_input_port, range(system.num_input_ports())):
        builder.ExportInput(port, port.get_name())
    first, *others = map(system.get_output_port, range(system.num_output_ports()))
    export_parts(builder, first, sizes)
    for port in others:
        builder.ExportOutput(port, port.get_name())
    builder.BuildInto(diagram)


def import_parts(
    builder: DiagramBuilder,
    vector: InputPort,
    sizes: Mapping[str, int],
    own: OutputPort | None = None,
) -> None:
    """Exports consecutive parts of a vector input as inputs of the diagram.

    A system of Drake joins them, which takes less time per tick than another port that
    Python reads.

    Args:
        builder: Builder of the diagram.
        vector: Input port of a system in the diagram.
        sizes: Size of each part by the name of its port, in order.
        own: Output port of a system in the diagram that feeds the last part, which then
            is not an input of the diagram.
    """
    all_sizes = [*sizes.values(), *([] if own is None else [own.size()])]
    joint = builder.AddNamedSystem("joint", Multiplexer(all_sizes))
    builder.Connect(joint.get_output_port(), vector)
    for i, name in enumerate(sizes):
        builder.ExportInput(joint.get_input_port(i), name)
    if own is not None:
        builder.Connect(own, joint.get_input_port(len(sizes)))
