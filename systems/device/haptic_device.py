"""A haptic device, real or simulated, that takes a wrench and gives a pose."""

from __future__ import annotations

from collections.abc import Callable

from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder, System

from drake_haptics._core import ConstraintStepper, ContactServo
from drake_haptics.systems.device.rendered_force_hold import RenderedForceHold

# Takes a stepper and the tool's first pose.
_StartServo = Callable[[ConstraintStepper, RigidTransform], ContactServo]


class HapticDevice(Diagram):
    """A haptic device, real or simulated, behind one set of ports.

    .. pydrake_system::

        name: HapticDevice
        input_ports:
        - F_Ho_W_commanded
        - coupled_motions
        - handle_slopes (if the backend has it)
        output_ports:
        - X_WH
        - V_WH
        - F_Ho_W_rendered
        - status
        - reading (if the backend has it)

    * `F_Ho_W_commanded` (6) is the wrench [τ; f] to render on the handle at its origin
      in the world, N·m and N.
    * `coupled_motions` (39) is that of `RenderedForceHold`; it need not be connected.
    * `handle_slopes` (72) is that of `DeviceIo`.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.
    * `F_Ho_W_rendered` and `status` are those of the `RenderedForceHold` before the
      device.
    * `reading` is that of `DeviceIo`.

    A backend is a system with the input `F_Ho_W_rendered` and the outputs `X_WH` and
    `V_WH`, neither of which depends directly on the input: a `SimulatedArm`, or a
    `DeviceIo` for any other device.
    """

    def __init__(
        self,
        backend: System,
        *,
        period_s: float,
        max_force_N: float,
        max_torque_Nm: float,
    ):
        """Constructs the device.

        Args:
            backend: System behind the port, not yet in a diagram.
            period_s: The tick, s.
            max_force_N: Largest force shown, N.
            max_torque_Nm: Largest torque shown, N·m.

        Raises:
            ValueError: The period or a limit is out of range.
        """
        super().__init__()
        self._period_s = period_s
        self._max_force_N = max_force_N
        self._max_torque_Nm = max_torque_Nm
        builder = DiagramBuilder()
        hold = builder.AddNamedSystem(
            "rendered_force_hold",
            RenderedForceHold(period_s, max_force_N, max_torque_Nm),
        )
        builder.AddSystem(backend)
        builder.Connect(
            hold.GetOutputPort("F_Ho_W_rendered"),
            backend.GetInputPort("F_Ho_W_rendered"),
        )
        for port in map(hold.get_input_port, range(hold.num_input_ports())):
            builder.ExportInput(port, port.get_name())
        self._wants_slopes = backend.HasInputPort("handle_slopes")
        if self._wants_slopes:
            builder.ExportInput(backend.GetInputPort("handle_slopes"), "handle_slopes")
        builder.ExportOutput(backend.GetOutputPort("X_WH"), "X_WH")
        builder.ExportOutput(backend.GetOutputPort("V_WH"), "V_WH")
        builder.ExportOutput(hold.GetOutputPort("F_Ho_W_rendered"), "F_Ho_W_rendered")
        builder.ExportOutput(hold.GetOutputPort("status"), "status")
        if backend.HasOutputPort("reading"):
            builder.ExportOutput(backend.GetOutputPort("reading"), "reading")
        builder.BuildInto(self)
        self._start_contact_servo: _StartServo | None = getattr(
            backend, "start_contact_servo", None
        )

    @property
    def period_s(self) -> float:
        """The tick, s."""
        return self._period_s

    @property
    def max_force_N(self) -> float:
        """Largest force shown, N."""
        return self._max_force_N

    @property
    def max_torque_Nm(self) -> float:
        """Largest torque shown, N·m."""
        return self._max_torque_Nm

    @property
    def start_contact_servo(self) -> _StartServo | None:
        """Function that starts the contact servo of a `DeviceIo`; None for others."""
        return self._start_contact_servo

    @property
    def wants_slopes(self) -> bool:
        """Whether the backend can use `handle_slopes`."""
        return self._wants_slopes
