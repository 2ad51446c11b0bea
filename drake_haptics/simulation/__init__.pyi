"""The public names of the simulation, each with the module that defines it."""

from .device_monitor import DeviceWatch as DeviceWatch
from .device_monitor import SilenceMonitor as SilenceMonitor
from .energy import EnergyLedger as EnergyLedger
from .live_values import LiveKey as LiveKey
from .live_values import LiveValueRamp as LiveValueRamp
from .live_values import is_live_change as is_live_change
from .live_values import live_keys as live_keys
from .live_values import put_live_values as put_live_values
from .live_values import write_live_values as write_live_values
from .profiling import CallbackTimer as CallbackTimer
from .profiling import Part as Part
from .profiling import explain_tick as explain_tick
from .replay_log import load_log_scene as load_log_scene
from .replay_log import replay as replay
from .run import RunError as RunError
from .run import make_simulator as make_simulator
from .run import run as run
from .statistics import RunStatistics as RunStatistics
from .transfer_state import release_diagram as release_diagram
from .transfer_state import transfer_context as transfer_context
