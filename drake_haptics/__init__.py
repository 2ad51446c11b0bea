"""Six-degree-of-freedom haptic rendering of arbitrary meshes, as Drake systems.

What most programs need is here by its own name; the rest is in the modules. The
geometry (`load_mesh`, `decompose`, `ConvexPair`, `ContactTracker`, `SceneTracker`)
works without Drake, which is imported only when something that needs it is asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str

    from drake_haptics._core import (
        Contact,
        ContactSet,
        ContactStatus,
        ContactTracker,
        ContactTrajectory,
        ConvexPair,
        ConvexPolytope,
        Feature,
        FeatureKind,
        PairTrajectory,
        SceneTracker,
    )
    from drake_haptics.authoring.scene_from_meshes import make_scene_for_meshes
    from drake_haptics.common.errors import MeshError, SceneError, UserError
    from drake_haptics.common.files import get_include
    from drake_haptics.common.real_time import TickClock
    from drake_haptics.device.backend import (
        DeviceBackend,
        DeviceCommand,
        DeviceError,
        DeviceReading,
    )
    from drake_haptics.geometry.decomposition.decompose import Decomposition, decompose
    from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
    from drake_haptics.loop.add_haptic_loop import AddHapticLoop
    from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
    from drake_haptics.loop.device_placement import make_device_port
    from drake_haptics.loop.haptic_loop import ConnectMovingObject, HapticLoop
    from drake_haptics.loop.open_device import open_device
    from drake_haptics.loop.outputs import make_log_header
    from drake_haptics.rendering.add_haptic_rendering import (
        AddAppliedSpatialForce,
        AddHapticRendering,
    )
    from drake_haptics.rendering.haptic_rendering import HapticRendering
    from drake_haptics.scene.library import (
        find_mesh,
        find_scene,
        list_meshes,
        list_scenes,
    )
    from drake_haptics.scene.scene_file import load_scene
    from drake_haptics.scene.schema import Scene
    from drake_haptics.simulation.energy import EnergyLedger
    from drake_haptics.simulation.live_values import live_keys, write_live_values
    from drake_haptics.simulation.profiling import CallbackTimer, explain_tick
    from drake_haptics.simulation.replay_log import replay
    from drake_haptics.simulation.run import RunError, make_simulator, run
    from drake_haptics.simulation.transfer_state import carry_on
    from drake_haptics.tick_log.tick_log import read_tick_log
    from drake_haptics.tick_log.tick_recorder import TickRecorder

__all__ = [
    "AddAppliedSpatialForce",
    "AddHapticLoop",
    "AddHapticRendering",
    "BuildHapticDiagram",
    "CallbackTimer",
    "ConnectMovingObject",
    "Contact",
    "ContactSet",
    "ContactStatus",
    "ContactTracker",
    "ContactTrajectory",
    "ConvexPair",
    "ConvexPolytope",
    "Decomposition",
    "DeviceBackend",
    "DeviceCommand",
    "DeviceError",
    "DeviceReading",
    "EnergyLedger",
    "Feature",
    "FeatureKind",
    "HapticDiagram",
    "HapticLoop",
    "HapticRendering",
    "Mesh",
    "MeshError",
    "PairTrajectory",
    "RunError",
    "Scene",
    "SceneError",
    "SceneTracker",
    "TickClock",
    "TickRecorder",
    "UserError",
    "carry_on",
    "decompose",
    "explain_tick",
    "find_mesh",
    "find_scene",
    "get_include",
    "list_meshes",
    "list_scenes",
    "live_keys",
    "load_mesh",
    "load_scene",
    "make_device_port",
    "make_log_header",
    "make_scene_for_meshes",
    "make_simulator",
    "open_device",
    "read_tick_log",
    "replay",
    "run",
    "write_live_values",
]

_MODULE_OF = {
    "AddAppliedSpatialForce": "rendering.add_haptic_rendering",
    "AddHapticLoop": "loop.add_haptic_loop",
    "AddHapticRendering": "rendering.add_haptic_rendering",
    "BuildHapticDiagram": "loop.builder",
    "CallbackTimer": "simulation.profiling",
    "ConnectMovingObject": "loop.haptic_loop",
    "Contact": "_core",
    "ContactSet": "_core",
    "ContactStatus": "_core",
    "ContactTracker": "_core",
    "ContactTrajectory": "_core",
    "ConvexPair": "_core",
    "ConvexPolytope": "_core",
    "Decomposition": "geometry.decomposition.decompose",
    "DeviceBackend": "device.backend",
    "DeviceCommand": "device.backend",
    "DeviceError": "device.backend",
    "DeviceReading": "device.backend",
    "EnergyLedger": "simulation.energy",
    "Feature": "_core",
    "FeatureKind": "_core",
    "HapticDiagram": "loop.builder",
    "HapticLoop": "loop.haptic_loop",
    "HapticRendering": "rendering.haptic_rendering",
    "Mesh": "geometry.mesh.mesh",
    "MeshError": "common.errors",
    "PairTrajectory": "_core",
    "RunError": "simulation.run",
    "Scene": "scene.schema",
    "SceneError": "common.errors",
    "SceneTracker": "_core",
    "TickClock": "common.real_time",
    "TickRecorder": "tick_log.tick_recorder",
    "UserError": "common.errors",
    "carry_on": "simulation.transfer_state",
    "decompose": "geometry.decomposition.decompose",
    "explain_tick": "simulation.profiling",
    "find_mesh": "scene.library",
    "find_scene": "scene.library",
    "get_include": "common.files",
    "list_meshes": "scene.library",
    "list_scenes": "scene.library",
    "live_keys": "simulation.live_values",
    "load_mesh": "geometry.mesh.mesh",
    "load_scene": "scene.scene_file",
    "make_device_port": "loop.device_placement",
    "make_log_header": "loop.outputs",
    "make_scene_for_meshes": "authoring.scene_from_meshes",
    "make_simulator": "simulation.run",
    "open_device": "loop.open_device",
    "read_tick_log": "tick_log.tick_log",
    "replay": "simulation.replay_log",
    "run": "simulation.run",
    "write_live_values": "simulation.live_values",
}


def __getattr__(name: str) -> object:
    """Imports a public name from its module when it is first asked for."""
    if name == "__version__":
        return import_module("importlib.metadata").version(__name__)
    if name not in _MODULE_OF:
        raise AttributeError(_unknown(name))
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    """Lists the public names, for completion."""
    return sorted([*__all__, "__version__"])


def _unknown(name: str) -> str:
    from difflib import get_close_matches
    from importlib.util import find_spec

    said = f"module {__name__!r} has no attribute {name!r}"
    if not name.startswith("_") and find_spec(f"{__name__}.{name}") is not None:
        return f"{said} yet; it is a module: import {__name__}.{name}"
    near = get_close_matches(name, __all__, n=1)
    return f"{said}; did you mean {near[0]!r}?" if near else said
