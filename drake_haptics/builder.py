"""Wires the haptic loop: one call for a scene, one for a diagram of one's own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_haptics._core import Decomposition, RigidToolDynamics
from drake_haptics.scene import Contact, Coupling, Scene
from drake_haptics.systems.contact_clustering import ContactClustering
from drake_haptics.systems.contact_query import ContactObject, ContactQuery
from drake_haptics.systems.haptic_device import HapticDevice
from drake_haptics.systems.haptic_tool import HapticTool
from drake_haptics.systems.penalty_force import PenaltyForce
from drake_haptics.systems.virtual_coupling import VirtualCoupling


@dataclass(frozen=True)
class HapticLoop:
    """The systems of one haptic loop, wired.

    Attributes:
        device: The device port.
        virtual_coupling: Between the device's handle and the tool.
        haptic_tool: The tool's body.
        contact_query: Finds the contacts.
        contact_clustering: Makes few of many.
        penalty_force: Answers them.
    """

    device: HapticDevice
    virtual_coupling: VirtualCoupling
    haptic_tool: HapticTool
    contact_query: ContactQuery
    contact_clustering: ContactClustering
    penalty_force: PenaltyForce


@dataclass(frozen=True)
class HapticDiagram:
    """A scene as a diagram, ready for a Simulator.

    Attributes:
        diagram: Owns all systems.
        scene: What it was built from.
        period_s: The tick, s.
        loop: The systems of the loop.
        tool: The tool's convex pieces (`drake_haptics.decomposition.Decomposition`).
        environment: The same for each object of the scene, in its order.
    """

    diagram: Diagram
    scene: Scene
    period_s: float
    loop: HapticLoop
    tool: object
    environment: tuple[object, ...]


def AddHapticLoop(
    builder: DiagramBuilder,
    *,
    device: HapticDevice,
    tool: Decomposition,
    tool_dynamics: RigidToolDynamics,
    objects: Sequence[ContactObject],
    contact: Contact,
    coupling: Coupling,
    X_HT: RigidTransform,
    X_WT: RigidTransform,
    period_s: float,
) -> HapticLoop:
    """Adds the systems of a haptic loop around a device and connects them.

    The ports `X_WO_<name>` and `V_WO_<name>` of objects that move are left to the
    caller.

    Args:
        builder: Gets the systems, the device among them.
        device: Not yet in the builder.
        tool: Pieces of the tool, in its frame T.
        tool_dynamics: Mass and inertia of the tool.
        objects: What the tool meets.
        contact: Tolerance, cluster size and gains.
        coupling: Gains between handle and tool.
        X_HT: Pose of the tool in the handle at rest.
        X_WT: Where the tool starts.
        period_s: The tick, s.

    Returns:
        The systems.

    Raises:
        ValueError: A gain, size or pose is out of range.
    """
    raise NotImplementedError


def BuildHapticDiagram(
    scene: Scene,
    *,
    meshcat: Meshcat | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> HapticDiagram:
    """Builds the diagram of a scene: loads, cuts, wires.

    Args:
        scene: What to build.
        meshcat: Draws the scene there, by a `HapticVisualizer` that is otherwise
            not in the diagram.
        progress: Called during the decomposition with the name of the object and
            the share done in [0, 1].

    Returns:
        The diagram and its parts. All systems have snake_case names.

    Raises:
        SceneError: A value is impossible or the hand's path cannot be reached.
        drake_haptics.mesh.MeshError: A mesh cannot be treated.
    """
    raise NotImplementedError
