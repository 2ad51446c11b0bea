"""The public systems, each with the module that defines it."""

from .arm.arm_twin import ArmTwin as ArmTwin
from .arm.force_delay import ForceDelay as ForceDelay
from .arm.hand_impedance import HAND_GRIPS as HAND_GRIPS
from .arm.hand_impedance import HandGrip as HandGrip
from .arm.hand_impedance import HandImpedance as HandImpedance
from .arm.hand_path import HandPath as HandPath
from .arm.joint_encoder import JointEncoder as JointEncoder
from .arm.joint_friction import JointFriction as JointFriction
from .arm.motor_torque import MotorTorque as MotorTorque
from .arm.simulated_arm import SimulatedArm as SimulatedArm
from .contact.contact_clustering import ClusteringRule as ClusteringRule
from .contact.contact_clustering import ContactClustering as ContactClustering
from .contact.contact_extrapolator import ContactExtrapolator as ContactExtrapolator
from .contact.contact_query import ContactObject as ContactObject
from .contact.contact_query import ContactQuery as ContactQuery
from .contact.force_shading import ForceShading as ForceShading
from .contact.friction_reaction import FrictionReaction as FrictionReaction
from .contact.load_shedding import LoadShedding as LoadShedding
from .contact.load_shedding import TickEnd as TickEnd
from .contact.load_shedding import TickMeter as TickMeter
from .contact.penalty_force import ContactGains as ContactGains
from .contact.penalty_force import PenaltyForce as PenaltyForce
from .contact.pose_sampler import PoseSampler as PoseSampler
from .contact.pre_contact_braking import PreContactBraking as PreContactBraking
from .contact.stick_slip_friction import StickSlipFriction as StickSlipFriction
from .device.device_io import DeviceIo as DeviceIo
from .device.haptic_device import HapticDevice as HapticDevice
from .device.rendered_force_hold import RenderedForceHold as RenderedForceHold
from .device.replayed_handle import ReplayedHandle as ReplayedHandle
from .framework.differentiable_system import (
    DifferentiableSystem as DifferentiableSystem,
)
from .lcm.haptic_command_receiver import HapticCommandReceiver as HapticCommandReceiver
from .lcm.haptic_command_sender import HapticCommandSender as HapticCommandSender
from .lcm.haptic_status_receiver import HapticStatusReceiver as HapticStatusReceiver
from .lcm.haptic_status_sender import HapticStatusSender as HapticStatusSender
from .output.haptic_visualizer import HapticVisualizer as HapticVisualizer
from .output.tick_log_sink import TickLogSink as TickLogSink
from .plant.applied_wrenches import AppliedWrenches as AppliedWrenches
from .plant.body_motions import BodyMotions as BodyMotions
from .plant.body_of_proxy import BodyOfProxy as BodyOfProxy
from .tool.constraint_step import ConstraintWrench as ConstraintWrench
from .tool.constraint_tool_step import ConstraintToolStep as ConstraintToolStep
from .tool.handle_model import HandleModel as HandleModel
from .tool.haptic_tool import HapticTool as HapticTool
from .tool.passivity_control import PassivityControl as PassivityControl
from .tool.tool_gravity import ToolGravity as ToolGravity
from .tool.virtual_coupling import CouplingGains as CouplingGains
from .tool.virtual_coupling import VirtualCoupling as VirtualCoupling
