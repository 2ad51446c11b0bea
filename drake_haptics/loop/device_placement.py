"""Places a device in a scene, and makes its port."""

from __future__ import annotations

import time
from dataclasses import dataclass

from pydrake.math import RigidTransform

from drake_haptics.common.one_line import count
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.device.backend import (
    DeviceBackend,
    DeviceError,
    DeviceReading,
    check_reading,
)
from drake_haptics.loop.simulated_device import find_base, make_hand_path
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import warn_caller
from drake_haptics.systems.device.device_io import DeviceIo
from drake_haptics.systems.device.haptic_device import HapticDevice

_LOOK_AGAIN_S = 0.01
# Drivers report their limits in single precision.
_ROUNDING = 1e-6


@dataclass(frozen=True)
class DevicePlacement:
    """The placement of a scene's device and of its handle.

    Attributes:
        X_WB: Pose of the device's base in the world.
        X_BH: Pose of the handle in the base at the start of the scene's hand, for
            devices that can be placed anywhere.
        workspace_radius_m: Radius of the workspace, m.
        max_force_N: Largest force to be shown, of the scene or else of the preset, N.
        max_torque_Nm: Largest torque to be shown, of the scene or else of the preset,
            N·m.
    """

    X_WB: RigidTransform
    X_BH: RigidTransform
    workspace_radius_m: float
    max_force_N: float
    max_torque_Nm: float


def find_device_site(scene: Scene) -> DevicePlacement:
    """Returns the placement of a scene's device.

    Raises:
        SceneError: There is no such preset, or the hand's path is not valid.
    """
    path = make_hand_path(scene.hand.path)
    X_WB = find_base(scene, path)
    X_TH = scene.tool.grasp.to_rigid_transform().inverse()
    preset = load_device_preset(scene.device.preset)
    force, torque = scene.device.max_force_N, scene.device.max_torque_Nm
    return DevicePlacement(
        X_WB=X_WB,
        X_BH=X_WB.inverse() @ path.start @ X_TH,
        workspace_radius_m=preset.workspace_radius_m,
        max_force_N=preset.max_force_N if force is None else force,
        max_torque_Nm=preset.max_torque_Nm if torque is None else torque,
    )


def wait_for_reading(backend: DeviceBackend, timeout_s: float = 3.0) -> DeviceReading:
    """Returns the first reading of a device.

    Args:
        backend: Open device.
        timeout_s: Longest time to wait for the reading, s.

    Raises:
        DeviceError: The device has sent no usable reading.
        ValueError: The reading is invalid; see `check_reading`.
    """
    end_s = time.monotonic() + timeout_s
    while (reading := backend.read()) is None:
        if time.monotonic() > end_s:
            rejected = backend.get_link_status().rejected
            was = "was" if rejected == 1 else "were"
            raise DeviceError(
                f"the device has sent nothing usable for {timeout_s:g} s:"
                f" {count(rejected, 'packet')} came and {was} refused. Is each state"
                " packed as docs/device-protocol.md says, all of it finite, the"
                " quaternion of the pose of length 1?"
                if rejected
                else f"the device has sent nothing for {timeout_s:g} s: is its driver"
                " or service running at the address given, and does it serve no other"
                " host? For udp://, `drake-haptics device` is a driver to try"
            )
        time.sleep(_LOOK_AGAIN_S)
    check_reading(reading)
    return reading


def place_device(
    scene: Scene, backend: DeviceBackend, X_WH: RigidTransform | None = None
) -> RigidTransform:
    """Returns X_WB, the pose of the base of a scene's device.

    If neither the scene nor the backend gives that pose, the base is placed so that the
    handle's present position is where the scene's hand would start, outside all
    objects.

    Args:
        scene: Scene, which may give the pose of the base.
        backend: Open device.
        X_WH: Pose at which to place the handle. Defaults to the start of the scene's
            hand.

    Raises:
        SceneError: There is no such preset, or the hand's path is not valid.
        DeviceError: The backend gives no usable reading.
    """
    site = find_device_site(scene)
    if scene.device.base is not None or backend.is_placed:
        return site.X_WB
    X_WH = X_WH or site.X_WB @ site.X_BH
    R_WB = site.X_WB.rotation()
    p_BH = wait_for_reading(backend).X_BH[4:]
    return RigidTransform(R_WB, X_WH.translation() - R_WB @ p_BH)


def make_device_port(
    backend: DeviceBackend,
    X_WB: RigidTransform | None = None,
    *,
    period_s: float,
    max_force_N: float,
    max_torque_Nm: float,
) -> tuple[HapticDevice, RigidTransform]:
    """Returns a device port for a backend, and the present pose X_WH of its handle.

    The port is for the argument `device` of `AddHapticLoop` or `AddHapticRendering`.
    The function waits for the first reading.

    Args:
        backend: Open device, which the caller must close.
        X_WB: Pose of its base in the world. Defaults to the identity.
        period_s: The tick, s, which must be that of the loop or rendering.
        max_force_N: Largest force shown, N.
        max_torque_Nm: Largest torque shown, N·m.

    Raises:
        DeviceError: The backend gives no usable reading.
        ValueError: The period or a limit is out of range, or the backend's reading is
            not a pose and velocity.

    Warns:
        SceneWarning: The device says that it shows less than a limit.
    """
    X_WB = X_WB or RigidTransform()
    reading = wait_for_reading(backend)
    _warn_of_less("max_force_N", max_force_N, reading.max_force_N, "N")
    _warn_of_less("max_torque_Nm", max_torque_Nm, reading.max_torque_Nm, "N·m")
    # Ends the servo of an earlier loop with this device.
    backend.end_contact_servo()
    io = DeviceIo(backend, X_WB, period_s, reading)
    io.set_name("device_io")
    device = HapticDevice(
        io, period_s=period_s, max_force_N=max_force_N, max_torque_Nm=max_torque_Nm
    )
    return device, X_WB @ vector_to_pose(reading.X_BH)


def _warn_of_less(key: str, asked: float, shown: float, unit: str) -> None:
    """Warns if a device shows less than a limit, which the loop would not notice."""
    if shown < (1.0 - _ROUNDING) * asked:
        # So many digits that the number, once it is set, does not differ.
        warn_caller(
            f"the device says that it shows at most {shown:.7g} {unit}, less than the"
            f" {asked:g} {unit} of {key}: set device.{key} (make_device_port: {key}) to"
            f" {shown:.7g}, so that passivity control and figures count what is shown"
        )
