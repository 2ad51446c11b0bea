"""Makes devices of arms: a scene's simulated arm over UDP, any arm over LCM."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from pydrake.lcm import DrakeLcm
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder, System
from pydrake.systems.lcm import LcmPublisherSystem, LcmSubscriberSystem

from drake_haptics._core import FrameChange
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.device.driver import DeviceDriver
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)
from drake_haptics.device.lcm.lcm_device import COMMAND_CHANNEL, STATUS_CHANNEL
from drake_haptics.loop.contact import whole_or_nothing
from drake_haptics.loop.simulated_device import (
    make_hand_path,
    make_simulated_device,
    place_base,
)
from drake_haptics.scene.schema import Scene
from drake_haptics.systems.lcm.haptic_command_receiver import HapticCommandReceiver
from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender

# A slower driver does not make the arm's motion slower; longer steps would diverge.
_LONGEST_STEP_S = 1e-3


class SimulatedDriverArm:
    """A simulated arm for a driver; a `drake_haptics.device.driver.DrivenArm`.

    Arm and hand are those that `BuildHapticDiagram` makes for the scene. The hand holds
    the handle at the start of its path until the device first becomes active, and then
    follows the path.

    Args:
        scene: Scene that names device, base, grasp and hand, and the driver's rate.

    Raises:
        SceneError: A preset, a grip or the path is invalid.
    """

    def __init__(self, scene: Scene):
        path = make_hand_path(scene.hand.path)
        device = make_simulated_device(scene, path)
        self._max_force_N = device.max_force_N
        self._max_torque_Nm = device.max_torque_Nm
        self._period_s = 1.0 / scene.device.rate_hz
        self._ticks = 0
        self._starts = False
        simulator = Simulator(device)
        step_s = min(self._period_s, _LONGEST_STEP_S)
        ResetIntegratorFromFlags(simulator, "runge_kutta2", step_s)
        simulator.get_mutable_integrator().set_fixed_step_mode(True)
        simulator.Initialize()
        self._simulator = simulator
        self._context = simulator.get_context()
        self._F_WH = device.GetInputPort("F_Ho_W_commanded").FixValue(
            simulator.get_mutable_context(), np.zeros(6)
        )
        self._X_WH = device.GetOutputPort("X_WH")
        self._V_WH = device.GetOutputPort("V_WH")
        X_BW = place_base(scene, path).inverse()
        self._to_base = FrameChange(pose_to_vector(X_BW))
        self._motion = self._read_motion()

    @property
    def max_force_N(self) -> float:
        """Largest force that the device shows, N."""
        return self._max_force_N

    @property
    def max_torque_Nm(self) -> float:
        """Largest torque that the device shows, N·m."""
        return self._max_torque_Nm

    def start(self) -> None:
        """Starts the hand along its path."""
        self._starts = True

    def step(self, F_Ho_B: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Advances arm and hand by one period.

        Args:
            F_Ho_B: (6,) wrench [τ; f] of the motors on the handle, N·m and N.

        Returns:
            X_BH (7,) = [qw qx qy qz x y z], m, and V_BH (6,) = [ω; v], rad/s and m/s;
            both NaN once the simulation has diverged.
        """
        if self._starts:
            self._ticks += 1
            # Motors hold the wrench over the period.
            self._F_WH.GetMutableData().get_mutable_value().SetFromVector(
                self._to_base.change_wrench_back(F_Ho_B)
            )
            self._advance()
        return self._motion[:7], self._motion[7:]

    def _advance(self) -> None:
        """Simulates a period; a simulation that has diverged cannot continue."""
        if np.isnan(self._motion).any():
            return
        try:
            self._simulator.AdvanceTo(self._ticks * self._period_s)
            self._motion = self._read_motion()
        except FloatingPointError:
            self._motion = np.full(13, np.nan)

    def _read_motion(self) -> np.ndarray:
        """Returns [X_BH; V_BH] (13,)."""
        return self._to_base.change_motion(
            self._X_WH.Eval(self._context), self._V_WH.Eval(self._context)
        )


def make_simulated_driver(
    scene: Scene, *, rate_hz: float | None, max_ttl_s: float, bind: str, port: int
) -> DeviceDriver:
    """Returns a driver of a scene's simulated device, within that device's limits.

    Args:
        scene: Scene that names the device, its place and its hand.
        rate_hz: Ticks per second, Hz. None for the scene's rate.
        max_ttl_s: Longest time that a command is shown without a newer one, s.
        bind: IPv4 address to listen at.
        port: UDP port to listen at.

    Raises:
        SceneError: The scene cannot be simulated.
        HapticsError: The address or port is not available.
        ValueError: A limit or the rate is out of range.
    """
    if rate_hz is not None:
        scene = replace(scene, device=replace(scene.device, rate_hz=rate_hz))
    arm = SimulatedDriverArm(scene)
    return DeviceDriver(
        arm,
        max_force_N=arm.max_force_N,
        max_torque_Nm=arm.max_torque_Nm,
        max_ttl_s=max_ttl_s,
        rate_hz=scene.device.rate_hz,
        bind=bind,
        port=port,
    )


class _ReceivedCommand(lcmt_haptic_command):
    """A command for a subscriber that must not raise, because the device would stop."""

    @classmethod
    def decode(cls, data: bytes) -> lcmt_haptic_command:  # type: ignore[override]
        """Returns the command; an empty one, which the gate ignores, if damaged."""
        try:
            return lcmt_haptic_command.decode(data)
        except ValueError:
            return lcmt_haptic_command()


def AddLcmDriver(
    builder: DiagramBuilder,
    arm: System,
    lcm: DrakeLcm,
    *,
    period_s: float,
    max_force_N: float,
    max_torque_Nm: float,
) -> HapticCommandReceiver:
    """Adds the systems that make an arm a device on LCM, behind the gate.

    Run the diagram in real time, because the time of its context is the gate's clock.
    Bytes that are not a command are ignored.

    Args:
        builder: Builder with the arm and Drake's `LcmInterfaceSystem` of the same
            `lcm`; without the latter, call `lcm.HandleSubscriptions(0)` before each
            tick.
        arm: A backend as documented in `HapticDevice`, whose world is the base frame B.
        lcm: LCM instance to send and listen with.
        period_s: The device's tick, s.
        max_force_N: Largest force ever shown, N.
        max_torque_Nm: Largest torque ever shown, N·m.

    Returns:
        The gate, whose output `gate_status` is its state.

    Raises:
        ValueError: The period or a limit is out of range, the arm takes another
            wrench, or the builder has a driver already.
        TypeError: An argument has the wrong type; the message names it.
    """
    require_kinds(builder=(builder, DiagramBuilder), arm=(arm, System))
    # Drake may end the process for a second connection.
    if builder.IsConnectedOrExported(arm.GetInputPort("F_Ho_W_rendered")):
        raise ValueError("arm: its input F_Ho_W_rendered is connected already")
    with whole_or_nothing(builder):
        gate = builder.AddNamedSystem(
            "haptic_command_receiver",
            HapticCommandReceiver(
                period_s, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm
            ),
        )
        sender = builder.AddNamedSystem(
            "haptic_status_sender", HapticStatusSender(period_s)
        )
        commands = builder.AddNamedSystem(
            "haptic_command_subscriber",
            LcmSubscriberSystem.Make(COMMAND_CHANNEL, _ReceivedCommand, lcm),
        )
        statuses = builder.AddNamedSystem(
            "haptic_status_publisher",
            LcmPublisherSystem.Make(STATUS_CHANNEL, lcmt_haptic_status, lcm, period_s),
        )
        X_BH, V_BH = arm.GetOutputPort("X_WH"), arm.GetOutputPort("V_WH")
        for output, input in [
            (commands.get_output_port(), gate.GetInputPort("lcmt_haptic_command")),
            (X_BH, gate.GetInputPort("X_BH")),
            (V_BH, gate.GetInputPort("V_BH")),
            (gate.GetOutputPort("F_Ho_B"), arm.GetInputPort("F_Ho_W_rendered")),
            (X_BH, sender.GetInputPort("X_BH")),
            (V_BH, sender.GetInputPort("V_BH")),
            (gate.GetOutputPort("gate_status"), sender.GetInputPort("gate_status")),
            (sender.GetOutputPort("lcmt_haptic_status"), statuses.get_input_port()),
        ]:
            builder.Connect(output, input)
    return gate
