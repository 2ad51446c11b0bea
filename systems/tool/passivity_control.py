"""Keeps the haptic loop from giving the device more energy than it received."""

from __future__ import annotations

import numpy as np
from pydrake.systems.framework import BasicVector, Context, Diagram, DiscreteValues

from drake_haptics._core import AutoDiffVector, PassivityBounds, passivity_control
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    take,
)
from drake_haptics.systems.framework.vector_ports import BuildAround

_AT_ORIGIN = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]


class PassivityControl(Diagram):
    """Passivity observer and controller at the device's port, in the time domain.

    The observer accounts for the energy that the virtual world has received from the
    device. The wrench on a device is held between ticks, so its work is exactly force
    times displacement and, about a fixed axis, torque times angle (Ryu, Kim and
    Hannaford 2004); no velocity is needed. If the balance is negative, the world has
    returned more than it received, and the controller adds the damping that dissipates
    the excess within a tick at the measured twist, up to a limit (Hannaford and Ryu
    2002; in six axes Preusche et al. 2003). The rest of the excess is carried over. The
    controller never adds power to the handle, and while the balance is not negative,
    `F_Ho_W_commanded` is `F_Ho_W_desired` bit for bit.

    A long contact that dissipates would raise the balance without bound, and the
    controller would act too late. Therefore the balance is limited to `reserve_J`.
    Choose it as the largest energy that the world can store and give back
    (`drake_haptics.bounds.sampled_spring.calc_returnable_energy`).

    .. pydrake_system::

        name: PassivityControl
        input_ports:
        - F_Ho_W_desired
        - F_Ho_W_rendered
        - X_WH
        - V_WH
        output_ports:
        - F_Ho_W_commanded
        - energy_J

    Wrenches are [τ; f] on the handle at its origin in the world, N·m and N.

    * `F_Ho_W_desired` is the wrench of the coupling.
    * `F_Ho_W_rendered` is the wrench that the `HapticDevice` has held, within its
      limits, since the last tick.
    * `X_WH` (7) is the handle's pose [qw qx qy qz x y z] in the world, m, and `V_WH`
      its spatial velocity [ω; v], rad/s and m/s.
    * `F_Ho_W_commanded` depends directly on all inputs: there is no delay. The device's
      hold samples it.
    * `energy_J` (1) is the balance, J.

    The state is one discrete group (8), [balance; X_WH at the last tick], updated
    every period from 0 s on.

    Derivatives are those of the branch taken: whether the damping is zero, partial or
    full, and whether the balance is below the reserve or at it.
    """

    def __init__(
        self,
        *,
        period_s: float,
        max_damping_Ns_per_m: float,
        max_rotational_damping_Nms_per_rad: float,
        reserve_J: float,
    ):
        """Constructs the system.

        Args:
            period_s: The device's tick, s.
            max_damping_Ns_per_m: Largest damping, N·s/m. A sampled damper b is itself
                stable on a device of mass m only below 2 m / period_s.
            max_rotational_damping_Nms_per_rad: Largest rotational damping, N·m·s/rad.
            reserve_J: Largest balance that is kept, J.

        Raises:
            ValueError: The period is not positive, another argument is negative, or one
                of them is not finite.
        """
        super().__init__()
        bounds = PassivityBounds(
            period_s,
            max_damping_Ns_per_m,
            max_rotational_damping_Nms_per_rad,
            reserve_J,
        )
        self._port = _ObservedPort(bounds, period_s)
        BuildAround(self, "port", self._port, {"F_Ho_W_commanded": 6, "energy_J": 1})

    def begin(self, context: Context) -> None:
        """Begins with a balance of zero at the handle's present pose.

        Use it for a controller that is added to a running loop, where a wrench may
        already be held.

        Args:
            context: Context of this system.
        """
        self._port.begin(self.GetMutableSubsystemContext(self._port, context))


class _ObservedPort(DifferentiableSystem):
    """The state of a `PassivityControl`, and both outputs from one call of the core."""

    def __init__(self, bounds: PassivityBounds, period_s: float):
        super().__init__()
        self._bounds = bounds
        self._F_Ho_W_desired = self.DeclareVectorInputPort("F_Ho_W_desired", 6)
        self._F_Ho_W_rendered = self.DeclareVectorInputPort("F_Ho_W_rendered", 6)
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._V_WH = self.DeclareVectorInputPort("V_WH", 6)
        # At the first tick no wrench has been held, so that any pose will do.
        self.DeclareDiscreteState(np.array([0.0, *_AT_ORIGIN]))
        # The wrench that is shown, and the next state.
        self._shown_and_state = self.DeclareVectorOutputPort(
            "shown_and_state",
            14,
            self._calc_shown_and_state,
            {self.all_input_ports_ticket(), self.xd_ticket()},
        )
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._update)

    def _calc_shown_and_state(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(
            passivity_control(
                context.get_discrete_state_vector().value(),
                self._F_Ho_W_rendered.Eval(context),
                self._F_Ho_W_desired.Eval(context),
                self._X_WH.Eval(context),
                self._V_WH.Eval(context),
                self._bounds,
            )
        )

    def begin(self, context: Context) -> None:
        """Begins with a balance of zero at the handle's present pose."""
        context.SetDiscreteState(np.array([0.0, *self._X_WH.Eval(context)]))

    def _update(self, context: Context, next_state: DiscreteValues) -> None:
        next_state.set_value(self._shown_and_state.Eval(context)[6:])

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrench and the next state with their derivatives."""
        return passivity_control(
            at.state,
            at["F_Ho_W_rendered"],
            at["F_Ho_W_desired"],
            at["X_WH"],
            at["V_WH"],
            self._bounds,
        )

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the next state with its derivatives."""
        return take(self.differentiate("shown_and_state", at), slice(6, 14))
