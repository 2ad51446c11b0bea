"""Parts of a vector as ports of their own."""

from __future__ import annotations

from collections.abc import Mapping

from pydrake.systems.framework import DiagramBuilder, InputPort, OutputPort
from pydrake.systems.primitives import Demultiplexer, Multiplexer


def export_parts(
    builder: DiagramBuilder, vector: OutputPort, sizes: Mapping[str, int]
) -> None:
    """Exports consecutive parts of a vector output as outputs of the diagram.

    Drake's own system splits it, which takes no time to speak of beside a port that
    Python calculates.

    Args:
        builder: Of the diagram.
        vector: Of a system in it.
        sizes: Size of each part by the name of its port, in order.
    """
    parts = builder.AddNamedSystem("parts", Demultiplexer(list(sizes.values())))
    builder.Connect(vector, parts.get_input_port(0))
    for i, name in enumerate(sizes):
        builder.ExportOutput(parts.get_output_port(i), name)


def import_parts(
    builder: DiagramBuilder,
    vector: InputPort,
    sizes: Mapping[str, int],
    own: OutputPort | None = None,
) -> None:
    """Exports consecutive parts of a vector input as inputs of the diagram.

    Drake's own system joins them; a port that Python reads takes longer, in every tick.

    Args:
        builder: Of the diagram.
        vector: Of a system in it.
        sizes: Size of each part by the name of its port, in order.
        own: The last part, of a system in the diagram; no input.
    """
    all_sizes = [*sizes.values(), *([] if own is None else [own.size()])]
    joint = builder.AddNamedSystem("joint", Multiplexer(all_sizes))
    builder.Connect(joint.get_output_port(), vector)
    for i, name in enumerate(sizes):
        builder.ExportInput(joint.get_input_port(i), name)
    if own is not None:
        builder.Connect(own, joint.get_input_port(len(sizes)))
