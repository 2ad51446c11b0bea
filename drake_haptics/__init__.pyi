"""The public names of the package, each with the module that defines it."""

from ._core import Contact as Contact
from ._core import ContactSet as ContactSet
from ._core import ContactStatus as ContactStatus
from ._core import ContactTracker as ContactTracker
from ._core import ContactTrajectory as ContactTrajectory
from ._core import ConvexPair as ConvexPair
from ._core import ConvexPolytope as ConvexPolytope
from ._core import Feature as Feature
from ._core import FeatureKind as FeatureKind
from ._core import PairTrajectory as PairTrajectory
from ._core import SceneTracker as SceneTracker
from .authoring.scene_from_meshes import make_scene_for_meshes as make_scene_for_meshes
from .bounds.coupling import HeldHandle as HeldHandle
from .bounds.sampled_spring import calc_passive_stiffness as calc_passive_stiffness
from .bounds.sampled_spring import calc_stable_stiffness as calc_stable_stiffness
from .common.errors import HapticsError as HapticsError
from .common.errors import MeshError as MeshError
from .common.errors import SceneError as SceneError
from .common.files import get_include as get_include
from .common.real_time import RealTimePacer as RealTimePacer
from .device.backend import DeviceBackend as DeviceBackend
from .device.backend import DeviceCommand as DeviceCommand
from .device.backend import DeviceError as DeviceError
from .device.backend import DeviceReading as DeviceReading
from .device.haply.haply_device import HaplyDevice as HaplyDevice
from .device.lcm.lcm_device import LcmDevice as LcmDevice
from .device.meshcat_device import MeshcatDevice as MeshcatDevice
from .device.udp_device import UdpDevice as UdpDevice
from .evaluation.benchmark.outside_library import OutsideContact as OutsideContact
from .evaluation.benchmark.outside_library import OutsideLibrary as OutsideLibrary
from .geometry.decomposition.decompose import Decomposition as Decomposition
from .geometry.decomposition.decompose import decompose as decompose
from .geometry.mesh.mesh import Mesh as Mesh
from .geometry.mesh.mesh import load_mesh as load_mesh
from .loop.add_haptic_loop import AddHapticLoop as AddHapticLoop
from .loop.builder import BuildHapticDiagram as BuildHapticDiagram
from .loop.builder import HapticDiagram as HapticDiagram
from .loop.device_placement import make_device_port as make_device_port
from .loop.device_placement import wait_for_reading as wait_for_reading
from .loop.drivers import AddLcmDriver as AddLcmDriver
from .loop.haptic_loop import ConnectMovingObject as ConnectMovingObject
from .loop.haptic_loop import HapticLoop as HapticLoop
from .loop.open_device import open_device as open_device
from .loop.outputs import AddTickLog as AddTickLog
from .loop.outputs import make_log_header as make_log_header
from .rendering.add_haptic_rendering import (
    AddAppliedSpatialForce as AddAppliedSpatialForce,
)
from .rendering.add_haptic_rendering import AddHapticRendering as AddHapticRendering
from .rendering.config import ApplyHapticRenderingConfig as ApplyHapticRenderingConfig
from .rendering.config import HapticRenderingConfig as HapticRenderingConfig
from .rendering.config import (
    load_haptic_rendering_config as load_haptic_rendering_config,
)
from .rendering.haptic_rendering import HapticRendering as HapticRendering
from .scene.device_preset import DevicePreset as DevicePreset
from .scene.device_preset import list_device_presets as list_device_presets
from .scene.device_preset import load_device_preset as load_device_preset
from .scene.library import find_mesh as find_mesh
from .scene.library import find_scene as find_scene
from .scene.library import list_meshes as list_meshes
from .scene.library import list_scenes as list_scenes
from .scene.scene_file import load_scene as load_scene
from .scene.schema import BrakingParameters as BrakingParameters
from .scene.schema import ContactParameters as ContactParameters
from .scene.schema import CouplingParameters as CouplingParameters
from .scene.schema import DeviceImperfections as DeviceImperfections
from .scene.schema import DeviceParameters as DeviceParameters
from .scene.schema import Effects as Effects
from .scene.schema import EnvironmentObject as EnvironmentObject
from .scene.schema import FrictionParameters as FrictionParameters
from .scene.schema import GravityParameters as GravityParameters
from .scene.schema import HandParameters as HandParameters
from .scene.schema import HandPathParameters as HandPathParameters
from .scene.schema import Material as Material
from .scene.schema import PassivityParameters as PassivityParameters
from .scene.schema import Pose as Pose
from .scene.schema import Scene as Scene
from .scene.schema import ShadingParameters as ShadingParameters
from .scene.schema import Tool as Tool
from .scene.schema import Waypoint as Waypoint
from .simulation.energy import EnergyLedger as EnergyLedger
from .simulation.live_values import live_keys as live_keys
from .simulation.live_values import write_live_values as write_live_values
from .simulation.profiling import CallbackTimer as CallbackTimer
from .simulation.profiling import explain_tick as explain_tick
from .simulation.replay_log import replay as replay
from .simulation.run import RunError as RunError
from .simulation.run import make_simulator as make_simulator
from .simulation.run import run as run
from .simulation.statistics import RunStatistics as RunStatistics
from .simulation.transfer_state import transfer_context as transfer_context
from .tick_log.tick_log import read_tick_log as read_tick_log
from .tick_log.tick_recorder import TickRecorder as TickRecorder
from .visualization.meshcat import configure_camera as configure_camera
from .visualization.meshcat import start_meshcat as start_meshcat
from .web.mouse_device import MouseDevice as MouseDevice

__version__: str
