"""The systems of the haptic loop, each by its own name.

They are in sub-packages by what they do, and are imported when they are first asked
for: what a scene does not name is not even loaded.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_haptics.systems.arm.arm_twin import ArmTwin
    from drake_haptics.systems.arm.force_delay import ForceDelay
    from drake_haptics.systems.arm.hand_impedance import (
        HAND_GRIPS,
        HandGrip,
        HandImpedance,
    )
    from drake_haptics.systems.arm.hand_path import HandPath
    from drake_haptics.systems.arm.joint_encoder import JointEncoder
    from drake_haptics.systems.arm.joint_friction import JointFriction
    from drake_haptics.systems.arm.motor_torque import MotorTorque
    from drake_haptics.systems.arm.simulated_arm import SimulatedArm
    from drake_haptics.systems.contact.contact_advance import ContactAdvance
    from drake_haptics.systems.contact.contact_clustering import (
        ClusteringRule,
        ContactClustering,
    )
    from drake_haptics.systems.contact.contact_query import ContactObject, ContactQuery
    from drake_haptics.systems.contact.force_shading import ForceShading
    from drake_haptics.systems.contact.friction_reaction import FrictionReaction
    from drake_haptics.systems.contact.load_shedding import (
        LoadShedding,
        TickEnd,
        TickMeter,
    )
    from drake_haptics.systems.contact.penalty_force import ContactGains, PenaltyForce
    from drake_haptics.systems.contact.pose_sample import PoseSample
    from drake_haptics.systems.contact.pre_contact_braking import PreContactBraking
    from drake_haptics.systems.contact.stick_slip_friction import StickSlipFriction
    from drake_haptics.systems.device.device_io import DeviceIo
    from drake_haptics.systems.device.display_force_hold import DisplayForceHold
    from drake_haptics.systems.device.haptic_device import HapticDevice
    from drake_haptics.systems.device.replayed_handle import ReplayedHandle
    from drake_haptics.systems.framework.differentiable_system import (
        DifferentiableSystem,
    )
    from drake_haptics.systems.lcm.haptic_command_receiver import HapticCommandReceiver
    from drake_haptics.systems.lcm.haptic_command_sender import HapticCommandSender
    from drake_haptics.systems.lcm.haptic_status_receiver import HapticStatusReceiver
    from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender
    from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer
    from drake_haptics.systems.output.tick_log_sink import TickLogSink
    from drake_haptics.systems.plant.applied_wrenches import AppliedWrenches
    from drake_haptics.systems.plant.body_motions import BodyMotions
    from drake_haptics.systems.tool.handle_model import HandleModel
    from drake_haptics.systems.tool.haptic_tool import HapticTool
    from drake_haptics.systems.tool.passivity_control import PassivityControl
    from drake_haptics.systems.tool.tool_gravity import ToolGravity
    from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

__all__ = [
    "HAND_GRIPS",
    "AppliedWrenches",
    "ArmTwin",
    "BodyMotions",
    "ClusteringRule",
    "ContactAdvance",
    "ContactClustering",
    "ContactGains",
    "ContactObject",
    "ContactQuery",
    "DeviceIo",
    "DifferentiableSystem",
    "DisplayForceHold",
    "ForceDelay",
    "ForceShading",
    "FrictionReaction",
    "HandGrip",
    "HandImpedance",
    "HandPath",
    "HandleModel",
    "HapticCommandReceiver",
    "HapticCommandSender",
    "HapticDevice",
    "HapticStatusReceiver",
    "HapticStatusSender",
    "HapticTool",
    "HapticVisualizer",
    "JointEncoder",
    "JointFriction",
    "LoadShedding",
    "MotorTorque",
    "PassivityControl",
    "PenaltyForce",
    "PoseSample",
    "PreContactBraking",
    "ReplayedHandle",
    "SimulatedArm",
    "StickSlipFriction",
    "TickEnd",
    "TickLogSink",
    "TickMeter",
    "ToolGravity",
    "VirtualCoupling",
]

_MODULE_OF = {
    "AppliedWrenches": "plant.applied_wrenches",
    "ArmTwin": "arm.arm_twin",
    "BodyMotions": "plant.body_motions",
    "ClusteringRule": "contact.contact_clustering",
    "ContactAdvance": "contact.contact_advance",
    "ContactClustering": "contact.contact_clustering",
    "ContactGains": "contact.penalty_force",
    "ContactObject": "contact.contact_query",
    "ContactQuery": "contact.contact_query",
    "DeviceIo": "device.device_io",
    "DifferentiableSystem": "framework.differentiable_system",
    "DisplayForceHold": "device.display_force_hold",
    "ForceDelay": "arm.force_delay",
    "ForceShading": "contact.force_shading",
    "FrictionReaction": "contact.friction_reaction",
    "HAND_GRIPS": "arm.hand_grip",
    "HandGrip": "arm.hand_grip",
    "HandImpedance": "arm.hand_impedance",
    "HandPath": "arm.hand_path",
    "HandleModel": "tool.handle_model",
    "HapticCommandReceiver": "lcm.haptic_command_receiver",
    "HapticCommandSender": "lcm.haptic_command_sender",
    "HapticDevice": "device.haptic_device",
    "HapticStatusReceiver": "lcm.haptic_status_receiver",
    "HapticStatusSender": "lcm.haptic_status_sender",
    "HapticTool": "tool.haptic_tool",
    "HapticVisualizer": "output.haptic_visualizer",
    "JointEncoder": "arm.joint_encoder",
    "JointFriction": "arm.joint_friction",
    "LoadShedding": "contact.load_shedding",
    "MotorTorque": "arm.motor_torque",
    "PassivityControl": "tool.passivity_control",
    "PenaltyForce": "contact.penalty_force",
    "PoseSample": "contact.pose_sample",
    "PreContactBraking": "contact.pre_contact_braking",
    "ReplayedHandle": "device.replayed_handle",
    "SimulatedArm": "arm.simulated_arm",
    "StickSlipFriction": "contact.stick_slip_friction",
    "TickEnd": "contact.load_shedding",
    "TickLogSink": "output.tick_log_sink",
    "TickMeter": "contact.load_shedding",
    "ToolGravity": "tool.tool_gravity",
    "VirtualCoupling": "tool.virtual_coupling",
}


def __getattr__(name: str) -> object:
    """Imports a name from its module when it is first asked for."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    """Lists the names, for completion."""
    return list(__all__)
