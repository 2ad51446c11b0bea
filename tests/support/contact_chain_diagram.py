"""The contact query, clustering and force as a Drake diagram, and its twin."""

from __future__ import annotations

import numpy as np
from contact_state import KV, K, State, T
from pydrake.autodiffutils import (
    AutoDiffXd,
    ExtractGradient,
    ExtractValue,
    InitializeAutoDiff,
)
from pydrake.systems.framework import DiagramBuilder

from drake_haptics._core import AutoDiffVector
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.systems.contact.contact_clustering import ContactClustering
from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.contact.penalty_force import PenaltyForce


def read_outputs(diagram, context, names) -> np.ndarray:
    """Returns outputs of a diagram, one after another."""
    return np.concatenate([diagram.GetOutputPort(name).Eval(context) for name in names])


class ContactChain:
    """The chain from poses and velocities to wrenches, around a state.

    Attributes:
        diagram: Its inputs are X_WT, V_WT, X_WO_<i> and V_WO_<i>, its outputs
            those of `PenaltyForce` that are vectors.
        context: Context at the state.
    """

    def __init__(self, state: State, moving: tuple[bool, ...]):
        """Builds it.

        Args:
            state: State of the diagram's context.
            moving: Whether each object has ports; the others rest where they are.
        """
        objects = [
            ContactObject(str(i), body, None if moves else vector_to_pose(q))
            for i, (body, q, moves) in enumerate(
                zip(state.bodies[1:], state.q[1:], moving, strict=True)
            )
        ]
        gains = K[: len(objects)], KV[: len(objects)]
        builder = DiagramBuilder()
        query = ContactQuery(state.bodies[0], objects, T)
        delta = 2 * T if state.method == "octree" else None
        self.query = builder.AddNamedSystem("contact_query", query)
        clustering = ContactClustering(state.method, T, delta)
        builder.AddNamedSystem("contact_clustering", clustering)
        force = builder.AddNamedSystem("penalty_force", PenaltyForce(objects, *gains))
        builder.Connect(
            query.GetOutputPort("contacts"), clustering.GetInputPort("contacts")
        )
        builder.Connect(
            clustering.GetOutputPort("clusters"), force.GetInputPort("clusters")
        )
        inputs: dict[str, int] = {}
        for system in (force, query):
            for i in range(system.num_input_ports()):
                port = system.get_input_port(i)
                name = port.get_name()
                if name in inputs:
                    builder.ConnectInput(inputs[name], port)
                elif name != "clusters":
                    inputs[name] = builder.ExportInput(port, name)
        for name in ("wrench_model", "F_To_W", "F_O_W"):
            if force.HasOutputPort(name):
                builder.ExportOutput(force.GetOutputPort(name), name)
        self.diagram = builder.Build()
        self._moving = [0, *(1 + i for i, moves in enumerate(moving) if moves)]
        self.context = self.diagram.CreateDefaultContext()
        self._fix(self.diagram, self.context, self.variables(state))
        # The query learns what is near as that of the state did, and as often.
        for _ in range(4):
            self._fix(self.diagram, self.context, self.variables(state))
            self.diagram.get_output_port(0).Eval(self.context)

    def variables(self, state: State) -> np.ndarray:
        """Returns pose and velocity (13) of each body that moves."""
        return np.hstack([state.q, state.V])[self._moving].ravel()

    def evaluate(self, x: np.ndarray, *outputs: str) -> np.ndarray:
        """Returns outputs at other variables, by the query that knows this state."""
        context = self.context.Clone()
        self._fix(self.diagram, context, x)
        return read_outputs(self.diagram, context, outputs)

    def differentiate(self, x: np.ndarray, *outputs: str) -> AutoDiffVector:
        """Returns the outputs with their derivatives by the variables."""
        context = self.context.Clone()
        self._fix(self.diagram, context, x)
        self.query.prepare_conversion(self.query.GetMyMutableContextFromRoot(context))
        twin = self.diagram.ToScalarType[AutoDiffXd]()
        of_twin = twin.CreateDefaultContext()
        of_twin.SetTimeStateAndParametersFrom(context)
        self._fix(twin, of_twin, InitializeAutoDiff(x).ravel())
        answer = read_outputs(twin, of_twin, outputs)
        return AutoDiffVector(ExtractValue(answer).ravel(), ExtractGradient(answer))

    def _fix(self, system, context, x: np.ndarray) -> None:
        for row, body in enumerate(self._moving):
            name = "T" if body == 0 else f"O_{body - 1}"
            of_body = x[13 * row : 13 * row + 13]
            system.GetInputPort(f"X_W{name}").FixValue(context, of_body[:7])
            system.GetInputPort(f"V_W{name}").FixValue(context, of_body[7:])
