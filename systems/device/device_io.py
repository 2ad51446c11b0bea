"""Exchanges data with a device that is not simulated, once per tick."""

from __future__ import annotations

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, Diagram, LeafSystem, State

from drake_haptics._core import ConstraintStepper, ContactServo, FrameChange, ServoTool
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceCommand,
    DeviceReading,
    Fault,
    GateState,
    check_reading,
)
from drake_haptics.systems.framework.differentiable_system import (
    get_no_witness_functions,
)
from drake_haptics.systems.framework.vector_ports import BuildAround


class DeviceIo(Diagram):
    """Reads a device's handle and writes the wrench that it is to render.

    The handle is read in the updates of a tick, before any other system samples it, and
    the resulting wrench is written as soon as the tick is computed, so that the loop
    adds no delay. All Contexts of this system talk to the same device, so they are not
    independent.

    .. pydrake_system::

        name: DeviceIo
        input_ports:
        - F_Ho_W_rendered
        - handle_slopes (if the backend uses it)
        output_ports:
        - X_WH
        - V_WH
        - reading

    * `F_Ho_W_rendered` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N.
    * `handle_slopes` (72) is [K; B] of that wrench as `HandleModel` documents it; it
      need not be connected.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m.
    * `V_WH` (6) is its spatial velocity [ω; v] in the world, rad/s and m/s.
    * `reading` (abstract) is the `DeviceReading` from which both come.

    The state is one discrete group (37), [X_WH; V_WH] and the numbers of the reading,
    replaced by an unrestricted update every period from 0 s on. It raises
    FloatingPointError if a reading is not finite, and ValueError if one of its arrays
    has the wrong size or its quaternion is not unit.
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
            X_WB: Pose of the device's base in the world.
            period_s: The tick, s.
            first_reading: Reading that the outputs show before the first tick.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._backend = backend
        self._q_WB = pose_to_vector(X_WB)
        exchange = _Exchange(backend, X_WB, period_s, first_reading)
        BuildAround(self, "exchange", exchange, {"X_WH": 7, "V_WH": 6})

    def start_contact_servo(
        self, stepper: ConstraintStepper, X_WT: RigidTransform
    ) -> ContactServo:
        """Starts the backend's contact servo with a tool at rest.

        Args:
            stepper: Stepper with the servo's period, its objects posed.
            X_WT: Pose of the tool in the world.

        Raises:
            DeviceError: The backend has no such thread.
        """
        start = np.concatenate([pose_to_vector(X_WT), np.zeros(6)])
        return self._backend.start_contact_servo(ServoTool(stepper, self._q_WB, start))


class _Exchange(LeafSystem):
    """The state of a `DeviceIo` and its events."""

    DoGetWitnessFunctions = get_no_witness_functions

    def __init__(
        self,
        backend: DeviceBackend,
        X_WB: RigidTransform,
        period_s: float,
        first_reading: DeviceReading,
    ):
        super().__init__()
        self._backend = backend
        self._frame = FrameChange(pose_to_vector(X_WB))
        self._eval_F_Ho_W_rendered = self.DeclareVectorInputPort(
            "F_Ho_W_rendered", 6
        ).Eval
        self._slopes = (
            self.DeclareVectorInputPort("handle_slopes", 72)
            if backend.uses_slopes
            else None
        )
        # Drake copies the state twice per tick. Numbers take a tenth of the time of a
        # Python object, and one group takes less time than two.
        state = self.DeclareDiscreteState(self._to_state(first_reading))
        self._eval_state = self.DeclareStateOutputPort("state", state).Eval
        self.DeclareAbstractOutputPort(
            "reading",
            Value[object],
            self._calc_reading,
            {self.discrete_state_ticket(state)},
        )
        # Unrestricted updates come before all discrete ones of the same time.
        self.DeclarePeriodicUnrestrictedUpdateEvent(period_s, 0.0, self._read)
        # Publish events come after the updates of a tick and the step to the next, but
        # before the simulation's pacer waits for that.
        self.DeclarePeriodicPublishEvent(period_s, 0.0, self._write)

    def _read(self, context: Context, state: State) -> None:
        reading = self._backend.read()
        if reading is not None:
            state.get_mutable_discrete_state(0).set_value(self._to_state(reading))

    def _to_state(self, reading: DeviceReading) -> np.ndarray:
        """Returns the state (37,): [X_WH; V_WH], then the numbers of a reading."""
        try:
            return self._frame.change_reading(
                reading.X_BH,
                reading.V_BH,
                reading.F_Ho_B,
                reading.sequence,
                reading.time_s,
                reading.buttons,
                reading.gate,
                reading.fault,
            )
        except (AttributeError, TypeError, ValueError):
            # None of these tells which part of a reading is wrong.
            check_reading(reading)
            raise

    def _write(self, context: Context) -> None:
        state = self._eval_state(context)
        self._backend.write(
            DeviceCommand(
                self._frame.change_wrench_back(self._eval_F_Ho_W_rendered(context)),
                state[_X_BH],
                state[_V_BH],
                *self._calc_slopes(context),
            )
        )

    def _calc_slopes(self, context: Context) -> tuple[np.ndarray, ...]:
        """Returns K_B and B_B, or nothing if they are not used or not connected."""
        if self._slopes is None or not self._slopes.HasValue(context):
            return ()
        return self._frame.change_slopes_back(self._slopes.Eval(context))

    def _calc_reading(self, context: Context, reading: AbstractValue) -> None:
        state = self._eval_state(context)
        sequence, time_s, buttons, gate, fault = state[32:].tolist()
        reading.set_value(
            DeviceReading(
                int(sequence),
                time_s,
                state[_X_BH],
                state[_V_BH],
                state[26:32],
                int(buttons),
                GateState(gate),
                Fault(fault),
            )
        )


# Parts of the state, after [X_WH; V_WH].
_X_BH, _V_BH = slice(13, 20), slice(20, 26)
