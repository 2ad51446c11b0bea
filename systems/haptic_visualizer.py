"""Draws the haptic loop in Meshcat."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Meshcat, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, InputPort, LeafSystem

from drake_haptics._core import Decomposition
from drake_haptics.arrow_pool import ArrowPool
from drake_haptics.pose_vector import vector_to_pose
from drake_haptics.systems.contact_query import ContactObject

# An exact binary fraction, so that frames fall on the same instants for ever.
_PERIOD_S = 1 / 32
# Drawing takes at most this share of clock time; the rest is the loop's.
_LARGEST_SHARE = 0.05
_MAX_CONTACTS = 64
_MAX_CLUSTERS = 16

_TOOL = Rgba(0.98, 0.72, 0.25)
# Seen through, because much of what happens is inside.
_ENVIRONMENT = Rgba(0.70, 0.77, 0.86, 0.45)
_HANDLE = Rgba(0.20, 0.40, 0.90, 0.25)
_COUPLING = Rgba(0.15, 0.35, 0.95)
_NEAR = Rgba(0.05, 0.65, 0.20)
_PENETRATING = Rgba(0.90, 0.10, 0.08)


class HapticVisualizer(LeafSystem):
    """Tool, objects, handle, contacts and forces in Meshcat, live or recorded.

    * The tool, and as its ghost where the handle wants it: X_WH X_HT.
    * The coupling: a line from the handle to the place in the tool that it holds,
      and an arrow of the force on the handle.
    * Each contact: a small arrow from its point along the normal, which points from
      the object into the tool; green near, red penetrating.
    * Each cluster: a larger arrow, as long as its force is large.

    .. pydrake_system::

        name: HapticVisualizer
        input_ports:
        - X_WH
        - X_WTool
        - contacts
        - clusters
        - contact_wrench
        - F_display
        - X_WO_<name of each object that moves>

    Poses are [qw qx qy qz x y z], m; `F_display` is [τ; f], N·m and N; `contacts`,
    `clusters` and `contact_wrench` are the outputs of `ContactQuery`,
    `ContactClustering` and `PenaltyForce`.

    It draws 32 times per simulated second while a browser is connected. Drawing takes at
    most one twentieth of clock time: where a frame is slow to draw, the next ones are
    left out. A recording is complete, whatever that takes.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        tool: Decomposition,
        objects: Sequence[ContactObject],
        X_HT: RigidTransform,
    ):
        """Constructs the system and sends the geometry.

        Args:
            meshcat: Where to draw, under "/haptics".
            tool: The tool, in its frame T.
            objects: Those of the `ContactQuery`.
            X_HT: Pose of the tool in the handle at rest.
        """
        super().__init__()
        self._meshcat = meshcat
        self._X_HT = X_HT
        self._X_TH = X_HT.inverse()
        self._recording = False
        self._first_frame = False
        self._not_before_s = 0.0
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._X_WTool = self.DeclareVectorInputPort("X_WTool", 7)
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._contact_wrench = self.DeclareAbstractInputPort(
            "contact_wrench", Value[object]()
        )
        self._F_display = self.DeclareVectorInputPort("F_display", 6)
        self._X_WO = {
            item.name: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for item in objects
            if item.X_WO is None
        }
        self.DeclarePeriodicPublishEvent(_PERIOD_S, 0.0, self._publish)
        self._send_geometry(tool, objects)

    def get_handle_pose_input_port(self) -> InputPort:
        """Returns the input `X_WH`."""
        return self._X_WH

    def get_tool_pose_input_port(self) -> InputPort:
        """Returns the input `X_WTool`."""
        return self._X_WTool

    def get_contacts_input_port(self) -> InputPort:
        """Returns the input `contacts`."""
        return self._contacts

    def get_clusters_input_port(self) -> InputPort:
        """Returns the input `clusters`."""
        return self._clusters

    def get_contact_wrench_input_port(self) -> InputPort:
        """Returns the input `contact_wrench`."""
        return self._contact_wrench

    def get_display_wrench_input_port(self) -> InputPort:
        """Returns the input `F_display`."""
        return self._F_display

    def get_object_pose_input_port(self, name: str) -> InputPort:
        """Returns the input `X_WO_<name>` of an object that moves."""
        return self._X_WO[name]

    def StartRecording(self) -> None:
        """Records every frame from now on into Meshcat's animation."""
        self._meshcat.StartRecording(frames_per_second=1 / _PERIOD_S)
        self._recording = True
        self._first_frame = True

    def StopRecording(self) -> None:
        """Stops recording; what was recorded stays."""
        self._meshcat.StopRecording()
        self._recording = False

    def PublishRecording(self) -> None:
        """Sends the animation to the browser and into `Meshcat.StaticHtml`."""
        self._meshcat.PublishRecording()

    def _send_geometry(
        self, tool: Decomposition, objects: Sequence[ContactObject]
    ) -> None:
        """Sends all that will ever be seen; later only poses and properties change."""
        size = float(np.linalg.norm(np.ptp(tool.vertices, axis=0)))
        # Arrows have a size that suits the tool's: that of 1 N.
        self._arrow_m = 0.11 * size
        self._send_mesh("tool", tool, _TOOL)
        self._send_mesh("handle", tool, _HANDLE)
        for item in objects:
            self._send_mesh(f"objects/{item.name}", item.decomposition, _ENVIRONMENT)
            if item.X_WO is not None:
                self._meshcat.SetTransform(f"{_ROOT}/objects/{item.name}", item.X_WO)
        self._meshcat.SetObject(f"{_ROOT}/grip", Sphere(0.025 * size), _HANDLE)
        self._coupling = ArrowPool(
            self._meshcat, f"{_ROOT}/coupling", 1, [_COUPLING], headless=True
        )
        self._display = ArrowPool(self._meshcat, f"{_ROOT}/force", 1, [_COUPLING])
        colors = [_NEAR, _PENETRATING]
        self._contact_arrows = ArrowPool(
            self._meshcat, f"{_ROOT}/contacts", _MAX_CONTACTS, colors
        )
        self._cluster_arrows = ArrowPool(
            self._meshcat, f"{_ROOT}/clusters", _MAX_CLUSTERS, colors
        )
