"""The exchange with a device that is not simulated, once per tick."""

from __future__ import annotations

import math

import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import (
    Context,
    Diagram,
    DiagramBuilder,
    EventStatus,
    LeafSystem,
    State,
)

from drake_haptics._core import FrameChange
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import DeviceBackend, DeviceCommand, DeviceReading
from drake_haptics.systems.framework.differentiable_system import (
    export_parts,
    get_no_witness_functions,
)


class DeviceIo(Diagram):
    """Reads a device's handle and writes the wrench that it is to show.

    The handle is read in the updates of a tick, before any other system samples it, and
    the wrench that follows from it is written as soon as the tick is computed: the
    loop adds no delay of its own. Both talk to the one device there is, so two
    Contexts of this system are not independent.

    .. pydrake_system::

        name: DeviceIo
        input_ports:
        - F_Ho_W_rendered
        - handle_slopes
        output_ports:
        - X_WH
        - V_WH
        - reading

    * `F_Ho_W_rendered` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N.
    * `handle_slopes` (72) is [K; B] of that wrench as `HandleModel` documents it; may
      be left unconnected.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.
    * `reading` (abstract) is the `DeviceReading` that both are of.

    The state is one discrete group (13), [X_WH; V_WH], and the reading, both replaced
    by an unrestricted update every period from 0 s on. It raises FloatingPointError
    where a reading is not finite.
    """

    def __init__(
        self,
        backend: DeviceBackend,
        X_WB: RigidTransform,
        period_s: float,
        first_reading: DeviceReading,
    ):
        """Constructs the system.

        Args:
            backend: The device, open.
            X_WB: Where its base stands in the world.
            period_s: The tick, s.
            first_reading: What the outputs show before the first tick.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        builder = DiagramBuilder()
        exchange = builder.AddNamedSystem(
            "exchange", _Exchange(backend, _Frame(X_WB), period_s, first_reading)
        )
        for name in ("F_Ho_W_rendered", "handle_slopes"):
            builder.ExportInput(exchange.GetInputPort(name), name)
        export_parts(
            builder, exchange.GetOutputPort("handle_state"), {"X_WH": 7, "V_WH": 6}
        )
        builder.ExportOutput(exchange.GetOutputPort("reading"), "reading")
        builder.BuildInto(self)


class _Frame:
    """Transforms between a device's base frame and the world."""

    def __init__(self, X_WB: RigidTransform):
        self._from_base = FrameChange(pose_to_vector(X_WB))

    def to_world(self, reading: DeviceReading) -> np.ndarray:
        """Returns [X_WH; V_WH] (13,)."""
        return self._from_base.change_motion(reading.X_BH, reading.V_BH)

    def to_base(
        self, F_W: np.ndarray, slopes_W: np.ndarray | None, at: DeviceReading
    ) -> DeviceCommand:
        """Returns a command for the handle that was read."""
        F_B = self._from_base.change_wrench_back(F_W)
        if slopes_W is None:
            return DeviceCommand(F_B, at.X_BH, at.V_BH)
        K_B, B_B = self._from_base.change_slopes_back(slopes_W)
        return DeviceCommand(F_B, at.X_BH, at.V_BH, K_B, B_B)


class _Exchange(LeafSystem):
    """The state of a `DeviceIo` and its events."""

    DoGetWitnessFunctions = get_no_witness_functions

    def __init__(
        self,
        backend: DeviceBackend,
        frame: _Frame,
        period_s: float,
        first_reading: DeviceReading,
    ):
        super().__init__()
        self._backend = backend
        self._frame = frame
        self._F_Ho_W_rendered = self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self._slopes = self.DeclareVectorInputPort("handle_slopes", 72)
        handle_state = self.DeclareDiscreteState(frame.to_world(first_reading))
        self._reading = self.DeclareAbstractState(Value[object](first_reading))
        self.DeclareStateOutputPort("handle_state", handle_state)
        self.DeclareStateOutputPort("reading", self._reading)
        # Unrestricted updates come before all discrete ones of the same time.
        self.DeclarePeriodicUnrestrictedUpdateEvent(period_s, 0.0, self._read)
        # Publish events come after the updates of a tick and the step to the next, but
        # before whoever paces the simulation waits for that.
        self.DeclarePeriodicPublishEvent(period_s, 0.0, self._write)

    def _read(self, context: Context, state: State) -> None:
        reading = self._backend.read()
        if reading is None:
            return
        motion = self._frame.to_world(reading)
        if not math.isfinite(sum(motion.tolist())):
            raise FloatingPointError("the device's reading is not finite")
        state.get_mutable_discrete_state().set_value(motion)
        state.get_mutable_abstract_state(int(self._reading)).set_value(reading)

    def _write(self, context: Context) -> EventStatus:
        slopes = self._read_slopes(context)
        reading = context.get_abstract_state(int(self._reading)).get_value()
        self._backend.write(
            self._frame.to_base(self._F_Ho_W_rendered.Eval(context), slopes, reading)
        )
        return EventStatus.Succeeded()

    def _read_slopes(self, context: Context) -> np.ndarray | None:
        try:
            return self._slopes.Eval(context)
        except RuntimeError:
            # To ask first would take as long as to read, at every tick.
            return (
                self._slopes.Eval(context) if self._slopes.HasValue(context) else None
            )
