"""Parts of a vector as ports."""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics.systems.vector_ports import export_parts


def test_parts_come_in_order_with_their_names_and_sizes():
    builder = DiagramBuilder()
    source = builder.AddSystem(ConstantVectorSource(np.arange(6.0)))
    export_parts(builder, source.get_output_port(), {"a": 2, "b": 1, "c": 3})
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    parts = {"a": [0, 1], "b": [2], "c": [3, 4, 5]}
    assert diagram.num_output_ports() == len(parts)
    for name, values in parts.items():
        np.testing.assert_array_equal(diagram.GetOutputPort(name).Eval(context), values)
