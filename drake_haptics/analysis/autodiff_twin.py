"""The AutoDiffXd twin of a system, and its context."""

from __future__ import annotations

from pydrake.autodiffutils import AutoDiffXd
from pydrake.systems.framework import Context, Context_, System, System_

from drake_haptics.analysis.diagram_systems import walk_systems


class AutoDiffTwin:
    """A system converted to AutoDiffXd once, following contexts of the original.

    Attributes:
        system: The twin.
        context: Its root context.
    """

    system: System_[AutoDiffXd]
    context: Context_[AutoDiffXd]

    def __init__(self, original: System):
        """Converts a system.

        Raises:
            RuntimeError: A system inside has no AutoDiffXd twin.
        """
        self._original = original
        self.system = original.ToScalarType[AutoDiffXd]()
        self.context = self.system.CreateDefaultContext()

    def follow(self, context: Context) -> None:
        """Takes time, state, parameters and fixed inputs from an original's context.

        Systems with a method `prepare_conversion(context)` first write into the
        parameters of their part of it what they remember elsewhere.

        Args:
            context: A root context of the original that may be changed so.
        """
        for part in walk_systems(self._original):
            if hasattr(part, "prepare_conversion"):
                part.prepare_conversion(part.GetMyMutableContextFromRoot(context))
        self.context.SetTimeStateAndParametersFrom(context)
        self.system.FixInputPortsFrom(self._original, context, self.context)
