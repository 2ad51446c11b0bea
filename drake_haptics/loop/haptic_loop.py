"""The systems of a haptic loop, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pydrake.systems.framework import DiagramBuilder, OutputPort, System

from drake_haptics.common.errors import SceneError
from drake_haptics.loop.contact import ContactSystems
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.tool.haptic_tool import HapticTool
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    from drake_haptics.systems.contact.contact_clustering import ContactClustering
    from drake_haptics.systems.contact.contact_extrapolator import ContactExtrapolator
    from drake_haptics.systems.contact.contact_query import ContactQuery
    from drake_haptics.systems.contact.force_shading import ForceShading
    from drake_haptics.systems.contact.load_shedding import LoadShedding
    from drake_haptics.systems.contact.penalty_force import PenaltyForce
    from drake_haptics.systems.contact.pose_sampler import PoseSampler
    from drake_haptics.systems.contact.pre_contact_braking import PreContactBraking
    from drake_haptics.systems.contact.stick_slip_friction import StickSlipFriction
    from drake_haptics.systems.tool.constraint_tool_step import ConstraintToolStep
    from drake_haptics.systems.tool.passivity_control import PassivityControl
    from drake_haptics.systems.tool.tool_gravity import ToolGravity


@dataclass(frozen=True)
class BaseSystems:
    """The systems that every loop has, including those of contact.

    Attributes:
        device: The device port.
        virtual_coupling: Spring and damper between the device's handle and the tool;
            under `contact.law: constraint` the same system as `haptic_tool`.
        haptic_tool: System of the tool's body.
        load_shedding: System that drops work from slow ticks; None without a budget.
        penalty: The systems that find contacts and calculate their forces; None under
            `contact.law: constraint`, where `haptic_tool` does.
    """

    device: HapticDevice
    virtual_coupling: VirtualCoupling | ConstraintToolStep
    haptic_tool: HapticTool | ConstraintToolStep
    load_shedding: LoadShedding | None
    penalty: ContactSystems | None

    @property
    def contact_query(self) -> ContactQuery:
        """The system that finds contacts, only under `contact.law: penalty`."""
        return self.require_penalty().contact_query

    @property
    def contact_clustering(self) -> ContactClustering:
        """The system of clusters, only under `contact.law: penalty`."""
        return self.require_penalty().contact_clustering

    @property
    def penalty_force(self) -> PenaltyForce:
        """The system of the force, only under `contact.law: penalty`."""
        return self.require_penalty().penalty_force

    @property
    def pose_sampler(self) -> PoseSampler | None:
        """System that samples the poses for the query; None if not needed."""
        return None if self.penalty is None else self.penalty.pose_sampler

    @property
    def contact_extrapolator(self) -> ContactExtrapolator | None:
        """System that extrapolates contacts between queries; None if not needed."""
        return None if self.penalty is None else self.penalty.contact_extrapolator

    @property
    def found_contacts(self) -> OutputPort:
        """The contacts at the present poses."""
        if self.penalty is None:
            return self.haptic_tool.GetOutputPort("contacts")
        return self.penalty.found_contacts

    @property
    def clusters(self) -> OutputPort:
        """The clusters that push, or the contacts of the constraint law."""
        if self.penalty is None:
            return self.haptic_tool.GetOutputPort("contacts")
        return self.penalty.contact_clustering.GetOutputPort("clusters")

    @property
    def contact_wrench(self) -> OutputPort:
        """The wrench of each of `clusters`."""
        return self._answer.GetOutputPort("contact_wrench")

    @property
    def F_To_W(self) -> OutputPort:
        """The wrench (6) [τ; f] of contact on the tool at its origin, N·m and N."""
        return self._answer.GetOutputPort("F_To_W")

    @property
    def coupling_model(self) -> OutputPort:
        """The wrench model (78) of the coupling on the tool."""
        name = "coupling" if self.penalty is None else "wrench_model"
        return self.virtual_coupling.GetOutputPort(name)

    @property
    def contact_model(self) -> OutputPort:
        """The wrench model (78) of contact on the tool."""
        return self._answer.GetOutputPort("wrench_model")

    @property
    def _answer(self) -> System:
        """The system that calculates the forces of contacts."""
        if self.penalty is None:
            return self.haptic_tool
        return self.penalty.penalty_force

    def require_penalty(self) -> ContactSystems:
        """Returns the systems of the penalty law.

        Raises:
            SceneError: The loop is under the constraint law.
        """
        if self.penalty is None:
            raise SceneError(
                "contact.law is 'constraint', whose tool step finds and answers"
                " contacts itself: there are no contact_query, contact_clustering and"
                " penalty_force to ask; take penalty"
            )
        return self.penalty


@dataclass(frozen=True)
class EffectSystems:
    """The system of each effect; None if the scene does not name it.

    Attributes:
        shading: System that smooths the contacts' normals.
        friction: System of stick-slip friction; under `contact.law: constraint` the
            same as `haptic_tool`.
        braking: System that brakes before contact.
        gravity: System of the tool's weight.
        passivity: System that keeps the device's wrench passive.
    """

    shading: ForceShading | None = None
    friction: StickSlipFriction | ConstraintToolStep | None = None
    braking: PreContactBraking | None = None
    gravity: ToolGravity | None = None
    passivity: PassivityControl | None = None


@dataclass(frozen=True)
class HapticLoop(BaseSystems):
    """The connected systems of one haptic loop.

    Attributes:
        effects: Systems of the effects.
        wrench_sources: The wrench model that feeds each input of `haptic_tool`, by
            the name of the input.
    """

    effects: EffectSystems
    wrench_sources: Mapping[str, OutputPort]

    def __repr__(self) -> str:
        device = self.device.get_name() or type(self.device).__name__
        return f"HapticLoop({device!r} feels {', '.join(self.wrench_sources)})"

    @property
    def contacts(self) -> OutputPort:
        """The contacts that are clustered, shaded with that effect."""
        if self.effects.shading is not None:
            return self.effects.shading.GetOutputPort("contacts")
        return self.found_contacts

    @property
    def commanded_wrench(self) -> OutputPort:
        """The wrench (6) [τ; f] on the handle that is commanded to the device."""
        if self.effects.passivity is not None:
            return self.effects.passivity.GetOutputPort("F_Ho_W_commanded")
        return self.virtual_coupling.GetOutputPort("F_Ho_W_commanded")

    @property
    def outputs(self) -> dict[str, OutputPort]:
        """Output ports of the loop, by name.

        `BuildHapticDiagram` exports each by this name.

        * `X_WT` (7) and `V_WT` (6) are those of `HapticTool`: pose
          [qw qx qy qz x y z], m, and spatial velocity [ω; v], rad/s and m/s, of the
          tool in the world.
        * `X_WH` (7), `V_WH` (6), `F_Ho_W_rendered` (6) and `status` are those of
          `HapticDevice`: handle, rendered wrench, and status of the limits.
        * `F_Ho_W_commanded` (6) is the wrench [τ; f] on the handle at its origin in the
          world that is commanded to the device, N·m and N.
        * `contacts` is a `drake_haptics.ContactSet`, shaded with that effect;
          `clusters` is a `drake_haptics._core.ClusterSet`.
        * `contact_wrench` and `F_To_W` (6) are those of `PenaltyForce`, of contact
          alone.
        * Under `contact.law: constraint` they are those of `ConstraintToolStep`, and
          `clusters` are its `contacts`.
        * `friction_force` (with friction) is that of `StickSlipFriction` or
          `ConstraintToolStep`, `energy_J` (with passivity control) that of
          `PassivityControl`.
        """
        device, tool = self.device, self.haptic_tool
        outputs = {
            "X_WT": tool.GetOutputPort("X_WT"),
            "V_WT": tool.GetOutputPort("V_WT"),
            "X_WH": device.GetOutputPort("X_WH"),
            "V_WH": device.GetOutputPort("V_WH"),
            "F_Ho_W_commanded": self.commanded_wrench,
            "F_Ho_W_rendered": device.GetOutputPort("F_Ho_W_rendered"),
            "status": device.GetOutputPort("status"),
            "contacts": self.contacts,
            "clusters": self.clusters,
            "contact_wrench": self.contact_wrench,
            "F_To_W": self.F_To_W,
        }
        if self.effects.friction is not None:
            port = self.effects.friction.GetOutputPort("friction_force")
            outputs["friction_force"] = port
        if self.effects.passivity is not None:
            outputs["energy_J"] = self.effects.passivity.GetOutputPort("energy_J")
        return outputs


def ConnectMovingObject(
    builder: DiagramBuilder,
    loop: HapticLoop,
    name: str,
    X_WO: OutputPort,
    V_WO: OutputPort,
) -> None:
    """Connects the motion of an object to every system of a loop that needs it.

    Args:
        builder: Builder of the diagram with the loop.
        loop: Return value of `AddHapticLoop`.
        name: Name of an object whose `X_WO` is None.
        X_WO: Pose (7) [qw qx qy qz x y z] of the object in the world, m.
        V_WO: Spatial velocity (6) [ω; v] of the object in the world, rad/s and m/s.

    Raises:
        ValueError: There is no such object, it does not move, or it is connected
            already.
    """
    parts: list[System | None] = [loop.haptic_tool, *vars(loop.effects).values()]
    if loop.penalty is not None:
        parts += vars(loop.penalty).values()
    sources = {f"X_WO_{name}": X_WO, f"V_WO_{name}": V_WO}
    # Under the constraint law one system is several of these parts.
    inputs = [
        port
        for system in dict.fromkeys(parts)
        if system is not None
        for port in map(system.get_input_port, range(system.num_input_ports()))
        if port.get_name() in sources
    ]
    if not inputs:
        raise ValueError(f"name: no object that moves is called {name!r}")
    # A sampler feeds the query. Drake may end the process for a second connection.
    free = [port for port in inputs if not builder.IsConnectedOrExported(port)]
    if not free:
        raise ValueError(f"name: the motion of {name!r} is connected already")
    for port in free:
        builder.Connect(sources[port.get_name()], port)
