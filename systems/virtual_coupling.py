"""The spring and damper between the device's handle and the tool."""

from __future__ import annotations

from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import (
    BasicVector,
    Context,
    InputPort,
    LeafSystem,
    OutputPort,
    ValueProducer,
)

from drake_haptics._core import CouplingGains, coupling_wrench
from drake_haptics.pose_vector import pose_to_vector

_WRENCH_MODEL_SIZE = 78


class VirtualCoupling(LeafSystem):
    """Six-axis spring and damper between handle and tool.

    It draws the tool to X_WH X_HT; what it does to the handle is the reaction. The
    device thus feels at most this stiffness, however stiff the contact is
    (Adams and Hannaford 1999). It has no state and adds no delay.

    .. pydrake_system::

        name: VirtualCoupling
        input_ports:
        - X_WH
        - V_WH
        - X_WTool
        - V_WTool
        output_ports:
        - wrench_model
        - F_display

    `X_WH` and `X_WTool` are poses [qw qx qy qz x y z] of the handle and the tool in
    the world, m; `V_WH` and `V_WTool` their spatial velocities [ω; v] at the
    frame's origin, rad/s and m/s.

    * `wrench_model` (78) is [F; K; B] on the tool at its origin, as `PenaltyForce`
      documents it.
    * `F_display` (6) is the wrench [τ; f] on the handle at its origin in the world,
      N·m and N.
    """

    def __init__(self, gains: CouplingGains, X_HT: RigidTransform):
        """Constructs the system.

        Args:
            gains: Of the spring and the damper.
            X_HT: Pose of the tool in the handle at which the spring rests.
        """
        super().__init__()
        self._gains = gains
        self._q_HT = pose_to_vector(X_HT)
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._V_WH = self.DeclareVectorInputPort("V_WH", 6)
        self._X_WTool = self.DeclareVectorInputPort("X_WTool", 7)
        self._V_WTool = self.DeclareVectorInputPort("V_WTool", 6)
        # One call of the core serves both ports.
        self._wrenches = self.DeclareCacheEntry(
            "wrenches",
            ValueProducer(Value[object], self._calc_wrenches),
            {self.all_input_ports_ticket()},
        )
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model",
            _WRENCH_MODEL_SIZE,
            self._calc_wrench_model,
            {self._wrenches.ticket()},
        )
        self._F_display = self.DeclareVectorOutputPort(
            "F_display", 6, self._calc_F_display, {self._wrenches.ticket()}
        )

    def get_handle_pose_input_port(self) -> InputPort:
        """Returns the input `X_WH`."""
        return self._X_WH

    def get_handle_velocity_input_port(self) -> InputPort:
        """Returns the input `V_WH`."""
        return self._V_WH

    def get_tool_pose_input_port(self) -> InputPort:
        """Returns the input `X_WTool`."""
        return self._X_WTool

    def get_tool_velocity_input_port(self) -> InputPort:
        """Returns the input `V_WTool`."""
        return self._V_WTool

    def get_wrench_model_output_port(self) -> OutputPort:
        """Returns the output `wrench_model`."""
        return self._wrench_model

    def get_display_wrench_output_port(self) -> OutputPort:
        """Returns the output `F_display`."""
        return self._F_display

    def _calc_wrenches(self, context: Context, wrenches: AbstractValue) -> None:
        wrenches.set_value(
            coupling_wrench(
                self._X_WH.Eval(context),
                self._V_WH.Eval(context),
                self._q_HT,
                self._X_WTool.Eval(context),
                self._V_WTool.Eval(context),
                self._gains,
            )
        )

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._wrenches.Eval(context)[:_WRENCH_MODEL_SIZE])

    def _calc_F_display(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._wrenches.Eval(context)[_WRENCH_MODEL_SIZE:])
