"""Configures haptic rendering of a plant by one struct, which can be read from YAML."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydrake.common.yaml import yaml_load_typed
from pydrake.geometry import Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.common.errors import SceneError
from drake_haptics.common.one_line import one_line
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.rendering.add_haptic_rendering import AddHapticRendering
from drake_haptics.rendering.haptic_rendering import HapticRendering
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    Material,
    Pose,
)
from drake_haptics.scene.validation import require
from drake_haptics.scene.yaml_loading import check_keys, load_yaml
from drake_haptics.systems.device.haptic_device import HapticDevice

# Drake reads the types of the fields at run time, so annotations must not be strings.
_ROLES = {"proximity": Role.kProximity, "illustration": Role.kIllustration}


@dataclass
class HapticRenderingConfig:
    """Arguments of `AddHapticRendering` that can be stored in a file.

    Attributes:
        tool_body: Name of the body that is the tool, or `model::name`.
        environment: Names of the bodies that the tool meets. Defaults to all that have
            shapes and can meet it.
        role: Role of the shapes that are used, `proximity` or `illustration`.
        chord_error_m: Largest distance between round shapes and the polytopes that
            approximate them, m.
        contact: The law of contact and its parameters.
        materials: Materials of bodies of the environment, by the names of their ports.
        effects: Effects besides contact.
        coupling: Gains between a handle and the tool. Defaults to no handle.
        X_HT: Pose of the tool in the handle at rest.
        period_s: Tick of effects with a memory, and of the device, s. Defaults to the
            plant's time step, or 1 ms for a continuous plant, whose integrator takes no
            longer steps.
        name: Name of the system in the builder.
    """

    tool_body: str = ""
    environment: list[str] | None = None
    role: str = "proximity"
    chord_error_m: float = 1e-4
    contact: ContactParameters = field(default_factory=ContactParameters)
    materials: dict[str, Material] = field(default_factory=dict)
    effects: Effects = field(default_factory=Effects)
    coupling: CouplingParameters | None = None
    X_HT: Pose = field(default_factory=Pose)
    period_s: float | None = None
    name: str = "haptic_rendering"

    __repr__ = one_line


def load_haptic_rendering_config(path: str | Path) -> HapticRenderingConfig:
    """Reads a configuration from a YAML file.

    Args:
        path: The file, whose keys are the attributes of `HapticRenderingConfig`.

    Returns:
        The configuration, with the default of each key that the file leaves out.

    Raises:
        SceneError: The file cannot be read, or has an unknown key or an invalid value.
            The message names the file and the key.
    """
    path = Path(path)
    data = load_yaml(path)
    try:
        check_keys(HapticRenderingConfig, data)
        config: HapticRenderingConfig = yaml_load_typed(
            schema=HapticRenderingConfig, filename=str(path)
        )
        require(bool(config.tool_body), "tool_body", "must name a body of the plant")
        require(config.role in _ROLES, "role", f"must be one of {', '.join(_ROLES)}")
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from error
    return config


def ApplyHapticRenderingConfig(
    config: HapticRenderingConfig,
    builder: DiagramBuilder,
    plant: MultibodyPlant,
    scene_graph: SceneGraph,
    *,
    device: HapticDevice | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> HapticRendering:
    """Calls `AddHapticRendering` with the arguments in a configuration.

    Args:
        config: Configuration, made in code or read by `load_haptic_rendering_config`.
        builder: Builder of the diagram with the plant, not yet built.
        plant: Finalized plant, continuous or discrete.
        scene_graph: Scene graph of the plant.
        device: Device of the handle, not yet in a builder, as from `make_device_port`.
        progress: Function that is called while meshes are decomposed, with the name of
            the body and the share done, from 0 to 1.

    Returns:
        The system. Its ports are named; see `HapticRendering`.

    Warns:
        SceneWarning: One of the reasons that `AddHapticRendering` lists.

    Raises:
        ValueError: A value is invalid, as in `AddHapticRendering`; the message names
            the key.
        TypeError: A value has the wrong type; the message names the key.
    """
    require_kinds(config=(config, HapticRenderingConfig))
    require_kinds(X_HT=(config.X_HT, Pose))
    require(config.role in _ROLES, "role", f"must be one of {', '.join(_ROLES)}")
    arguments: dict[str, Any] = vars(config) | {
        "role": _ROLES[config.role],
        "X_HT": config.X_HT.to_rigid_transform(),
    }
    return AddHapticRendering(
        builder, plant, scene_graph, **arguments, device=device, progress=progress
    )
