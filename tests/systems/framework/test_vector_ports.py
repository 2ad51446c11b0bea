"""Parts of a vector as ports."""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource, PassThrough

from drake_haptics.systems.framework.vector_ports import export_parts, import_parts


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


def test_parts_are_joined_in_order_under_their_names():
    builder = DiagramBuilder()
    whole = builder.AddSystem(PassThrough(6))
    import_parts(builder, whole.get_input_port(), {"a": 2, "b": 1, "c": 3})
    builder.ExportOutput(whole.get_output_port(), "whole")
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    assert diagram.num_input_ports() == 3
    for name, values in {"c": [3, 4, 5], "a": [0, 1], "b": [2]}.items():
        diagram.GetInputPort(name).FixValue(context, values)
    np.testing.assert_array_equal(
        diagram.GetOutputPort("whole").Eval(context), np.arange(6.0)
    )
