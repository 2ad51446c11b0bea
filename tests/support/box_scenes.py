"""Small scenes for tests: a cube or a ball above a plate, made on the spot."""

from collections.abc import Mapping
from pathlib import Path

import trimesh

from drake_haptics.scene.schema import (
    ContactParameters,
    EnvironmentObject,
    HandParameters,
    HandPathParameters,
    Scene,
    Tool,
    Waypoint,
)

TOOL_HALF_HEIGHT = 0.01
TOOL_MASS = 0.1
PLATE_TOP = 0.01


def write(folder: Path, name: str, mesh: trimesh.Trimesh) -> str:
    path = folder / f"{name}.obj"
    mesh.export(path)
    return str(path)


def write_scene(
    folder: Path,
    tool: trimesh.Trimesh,
    objects: Mapping[str, trimesh.Trimesh],
    waypoints: list[Waypoint],
    *,
    contact: ContactParameters | None = None,
    mass_kg: float = TOOL_MASS,
) -> Scene:
    """Returns a scene of a tool and objects by name, with its meshes in a folder."""
    return Scene(
        tool=Tool(mesh=write(folder, "tool", tool), mass_kg=mass_kg),
        environment=[
            EnvironmentObject(name=name, mesh=write(folder, name, mesh))
            for name, mesh in objects.items()
        ],
        contact=contact or ContactParameters(),
        hand=HandParameters(path=HandPathParameters(waypoints=waypoints)),
    )


def over_a_plate(
    folder: Path, waypoints, *, tool="cube", periodic=False, grip="nominal"
) -> Scene:
    """Returns a scene of a tool, 2 cm high, over a plate whose top is at z = 1 cm.

    Args:
        folder: Folder for the mesh files.
        waypoints: (time s, x, y, z m) of the tool's middle, z from the plate's top.
        tool: "cube" or "ball".
        periodic: Whether the hand's path is periodic.
        grip: Grip of the hand.
    """
    tools = {
        "cube": trimesh.creation.box([2 * TOOL_HALF_HEIGHT] * 3),
        "ball": trimesh.creation.icosphere(subdivisions=2, radius=TOOL_HALF_HEIGHT),
    }
    plate = trimesh.creation.box([0.2, 0.2, 2 * PLATE_TOP])
    scene = write_scene(
        folder,
        tools[tool],
        {"plate": plate},
        [Waypoint(t, [x, y, z + PLATE_TOP]) for t, x, y, z in waypoints],
    )
    scene.hand.grip = grip
    scene.hand.path.periodic = periodic
    return scene
