"""Device presets: limits, workspace and model of the devices in models/devices."""

from dataclasses import dataclass, field
from pathlib import Path

from pydrake.common.yaml import yaml_load_file, yaml_load_typed

import drake_haptics
from drake_haptics.scene_check import SceneError, check_keys

_DEVICES = Path(drake_haptics.__file__).parent / "models" / "devices"


@dataclass
class DevicePreset:
    """What is known of a device.

    Attributes:
        description: For people.
        model: SDF of its arm, in the folder of the preset. Its root link is `base`.
        handle_link: The link that is held.
        workspace_center_m: Middle of the workspace in the frame of the base, m.
        workspace_radius_m: Radius of the workspace, m.
        max_force_N: Largest force it shows, N.
        max_torque_Nm: Largest torque it shows, N·m; 0 where it turns freely.
        max_stiffness_N_per_m: Largest stiffness it is rated for, N/m. This and what
            follows may be unknown.
        max_damping_Ns_per_m: Largest damping, N·s/m.
        max_rotational_stiffness_Nm_per_rad: N·m/rad.
        max_rotational_damping_Nms_per_rad: N·m·s/rad.
    """

    description: str = ""
    model: str = ""
    handle_link: str = "handle"
    workspace_center_m: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    workspace_radius_m: float = 0.0
    max_force_N: float = 0.0
    max_torque_Nm: float = 0.0
    max_stiffness_N_per_m: float | None = None
    max_damping_Ns_per_m: float | None = None
    max_rotational_stiffness_Nm_per_rad: float | None = None
    max_rotational_damping_Nms_per_rad: float | None = None

    @property
    def model_path(self) -> Path:
        """File of the arm's model."""
        return _DEVICES / self.model


def load_device_preset(name: str) -> DevicePreset:
    """Reads a preset of models/devices.

    Raises:
        SceneError: There is none of that name; the message lists those there are.
    """
    path = _DEVICES / f"{name}.yaml"
    names = sorted(item.stem for item in _DEVICES.glob("*.yaml"))
    if name not in names:
        raise SceneError(f"device.preset: '{name}' is none of {', '.join(names)}")
    check_keys(DevicePreset, yaml_load_file(str(path)))
    return yaml_load_typed(schema=DevicePreset, filename=str(path))
