"""The loop of a scene, added to a builder by hand."""

from pydrake.math import RigidTransform
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.loop.add_haptic_loop import AddHapticLoop
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.haptic_loop import HapticLoop
from drake_haptics.systems.contact.contact_query import ContactObject


def add_loop_by_hand(
    builder: DiagramBuilder, haptic: HapticDiagram, **options
) -> HapticLoop:
    """Adds the loop of a scene that is built, held at its origin, with a device.

    Args:
        builder: Builder of the diagram.
        haptic: The scene's diagram, of which the parts are taken.
        options: Arguments of `AddHapticLoop`, in place of those of the scene.
    """
    scene = haptic.scene
    arguments = {
        "tool": haptic.tool.core,
        "tool_dynamics": haptic.loop.haptic_tool.dynamics,
        "objects": [
            ContactObject(item.name, part.core, item.pose.to_rigid_transform())
            for item, part in zip(scene.environment, haptic.environment, strict=True)
        ],
        "contact": scene.contact,
        "coupling": scene.coupling,
        "X_HT": RigidTransform(),
        "X_WT": RigidTransform(),
        "period_s": 1e-3,
    }
    return AddHapticLoop(builder, **(arguments | options))
