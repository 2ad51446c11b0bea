"""Reads device presets: limits, workspace and model of a device, in YAML files."""

from copy import deepcopy
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
from pydrake.common.yaml import yaml_load_typed

from drake_haptics.common.errors import SceneError
from drake_haptics.models import FOLDER
from drake_haptics.scene.validation import (
    require,
    require_all_positive,
    require_each,
    require_length,
    require_none_negative,
)
from drake_haptics.scene.yaml_loading import check_keys, load_yaml, make_hint

_DEVICES = FOLDER / "devices"
_SUFFIXES = (".yaml", ".yml")
NUM_JOINTS = 6


def _make_identity() -> list[list[float]]:
    return np.eye(NUM_JOINTS).tolist()


@dataclass
class Motors:
    """Properties of a device's motors, six of each, in the order of the joints.

    All angles and torques are after the gear. A property that is None is unknown.

    Attributes:
        joint_per_motor: S (6, 6) in q = S q_motor, with q the joint angles of the
            model, so that τ_motor = Sᵀ τ.
        encoder_step_rad: Angle per count of the encoder, rad.
        coulomb_friction_Nm: Dry friction torque, N·m.
        peak_torque_Nm: Peak torque, N·m.
        continuous_torque_Nm: Torque that the motors can sustain, N·m.
    """

    joint_per_motor: list[list[float]] = field(default_factory=_make_identity)
    encoder_step_rad: list[float] | None = None
    coulomb_friction_Nm: list[float] | None = None
    peak_torque_Nm: list[float] | None = None
    continuous_torque_Nm: list[float] | None = None


@dataclass
class DevicePreset:
    """The properties of a device.

    Attributes:
        description: One sentence that describes the device.
        source: Source of the figures.
        model: SDF file of the arm, relative to the preset's file; empty if there is no
            model. Its root link is `base`, from which six revolute joints lead to
            `handle_link`.
        handle_link: Link of the arm that the hand holds.
        workspace_center_m: Middle of the workspace in the frame of the base, m.
        workspace_radius_m: Radius of the workspace, m.
        actuated_axes: Number of the handle's six axes that have motors: 6, or 3 where
            it turns freely.
        max_force_N: Largest force it shows, N.
        max_torque_Nm: Largest torque it shows, N·m; 0 where it turns freely.
        max_stiffness_N_per_m: Largest stiffness that the device is rated for, N/m. This
            and the ratings that follow may be unknown.
        max_damping_Ns_per_m: Largest damping, N·s/m.
        max_rotational_stiffness_Nm_per_rad: Largest rotational stiffness, N·m/rad.
        max_rotational_damping_Nms_per_rad: Largest rotational damping, N·m·s/rad.
        motors: Figures of the motors, the defaults of a scene's `device.twin`.
    """

    description: str = ""
    source: str = ""
    model: str = ""
    handle_link: str = "handle"
    workspace_center_m: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    workspace_radius_m: float = 0.0
    actuated_axes: int = 6
    max_force_N: float = 0.0
    max_torque_Nm: float = 0.0
    max_stiffness_N_per_m: float | None = None
    max_damping_Ns_per_m: float | None = None
    max_rotational_stiffness_Nm_per_rad: float | None = None
    max_rotational_damping_Nms_per_rad: float | None = None
    motors: Motors = field(default_factory=Motors)

    def __repr__(self) -> str:
        return (
            f"DevicePreset({self.description!r}, {self.max_force_N:g} N,"
            f" {self.max_torque_Nm:g} N·m{'' if self.has_model else ', no model'})"
        )

    @property
    def has_model(self) -> bool:
        """Whether the device can be simulated."""
        return bool(self.model)

    @property
    def model_path(self) -> Path:
        """File of the arm's model.

        Raises:
            SceneError: The preset has no model; the message says what to do.
        """
        if not self.has_model:
            raise SceneError(
                f"device.preset: there is no model of the arm of '{self.description}',"
                " so that it cannot be simulated: use a real one, with"
                " `drake-haptics run SCENE --device ADDRESS`, or name a preset file of"
                " your own that gives a model (docs/device-twin.md)"
            )
        return Path(self.model)


def list_device_presets() -> dict[str, Path]:
    """Returns the file of every shipped preset by name, in order of name."""
    return {path.stem: path for path in sorted(_DEVICES.glob("*.yaml"))}


def is_preset_file(preset: str) -> bool:
    """Returns whether a scene's `device.preset` is a file, not a name."""
    return preset.endswith(_SUFFIXES)


def load_device_preset(name_or_path: str | Path) -> DevicePreset:
    """Reads a shipped preset, or a file of your own.

    Args:
        name_or_path: Name of a preset in models/devices, or a file (`*.yaml`, `*.yml`).

    Returns:
        The preset, whose `model` no longer depends on its folder.

    Raises:
        SceneError: No preset has that name, and the message lists the shipped ones; or
            the file cannot be read, or has an unknown key or an invalid value, and the
            message names the file and the key.
    """
    name = str(name_or_path)
    if is_preset_file(name):
        return _read_once(Path(name))
    presets = list_device_presets()
    if name not in presets:
        raise SceneError(
            f"device.preset: '{name}' is not one of those that are shipped, nor"
            f" a preset file (.yaml); {make_hint(name, presets)}"
        )
    return _read_once(presets[name])


def _read_once(path: Path) -> DevicePreset:
    """Returns a copy of a preset; reads its file only if it has changed."""
    try:
        stat = path.stat()
    except OSError:
        return _read(path, None)  # Says what is wrong.
    return deepcopy(_read(path, (stat.st_mtime_ns, stat.st_size)))


# A build reads the preset in several places, and YAML takes 10 ms to read.
@lru_cache(maxsize=16)
def _read(path: Path, version: object) -> DevicePreset:
    """Reads and checks a preset file."""
    data = load_yaml(path)
    try:
        check_keys(DevicePreset, data)
        preset: DevicePreset = yaml_load_typed(schema=DevicePreset, filename=str(path))
        _check_values(preset)
        if preset.has_model:
            preset.model = str((path.parent / preset.model).resolve())
            require(
                Path(preset.model).is_file(), "model", f"does not exist: {preset.model}"
            )
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from error
    return preset


def _check_values(preset: DevicePreset) -> None:
    """Raises SceneError for values that describe no device."""
    require_length(preset, "", "workspace_center_m", 3)
    require_all_positive(preset, "", ["workspace_radius_m", "max_force_N"])
    limits = ["max_torque_Nm", "max_stiffness_N_per_m", "max_damping_Ns_per_m"]
    limits.append("max_rotational_stiffness_Nm_per_rad")
    limits.append("max_rotational_damping_Nms_per_rad")
    require_none_negative(preset, "", limits)
    require(
        preset.actuated_axes in (3, 6),
        "actuated_axes",
        f"must be 3 or 6, is {preset.actuated_axes}",
    )
    require(
        preset.actuated_axes == 6 or preset.max_torque_Nm == 0.0,
        "max_torque_Nm",
        f"must be 0 on 3 actuated axes, is {preset.max_torque_Nm}",
    )
    motors = preset.motors
    for key in ("encoder_step_rad", "peak_torque_Nm", "continuous_torque_Nm"):
        require_each(motors, "motors", key, NUM_JOINTS, positive=True)
    require_each(motors, "motors", "coulomb_friction_Nm", NUM_JOINTS, positive=False)
    _check_transmission(motors.joint_per_motor)


def _check_transmission(rows: list[list[float]]) -> None:
    """Raises SceneError unless motor and joint angles determine each other."""
    where = "motors.joint_per_motor"
    require(
        len(rows) == NUM_JOINTS and all(len(row) == NUM_JOINTS for row in rows),
        where,
        f"needs {NUM_JOINTS} rows of {NUM_JOINTS} numbers",
    )
    require(
        bool(np.linalg.matrix_rank(np.array(rows)) == NUM_JOINTS),
        where,
        "must be invertible",
    )
