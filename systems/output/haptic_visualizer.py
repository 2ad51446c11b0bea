"""Draws the haptic loop in Meshcat."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context

from drake_haptics._core import (
    ClusterSet,
    ContactSet,
    ConvexPieces,
    FrictionStep,
    PenaltyWrench,
)
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import DifferentiableSystem
from drake_haptics.systems.output.haptic_picture import HapticPicture

_LONGEST_PERIOD_S = 1 / 30
# A frame is drawn in slices of this duration, one every other tick.
_SLICE_S = 60e-6
_SLICE_TICKS = 2
# Largest share of clock time for drawing.
_LARGEST_SHARE = 0.05
# Least clock time between two frames of a run that is faster than real time.
_SHORTEST_FRAME_S = 1 / 50


class HapticVisualizer(DifferentiableSystem):
    """Tool, objects, handle, contacts and forces in Meshcat, live or recorded.

    * The tool, and its ghost where the handle wants the tool: X_WH X_HT.
    * The coupling: a line from the handle to the place in the tool that it holds.
    * The force on the hand: an arrow with its tip at the handle. The torque on the
      hand: an arrow with two heads that begins there.
    * Each contact: a small arrow along the normal, from the object into the tool,
      its tip at the contact's point; green near, red penetrating.
    * Each cluster: a larger arrow, as long as its force is large. An arrow at the
      device's limit is a third of the tool's size long, and no arrow is longer.
    * The friction of each cluster, if there is any: violet, dark where it sticks, light
      where it slides.

    .. pydrake_system::

        name: HapticVisualizer
        input_ports:
        - X_WH
        - X_WT
        - contacts
        - clusters
        - contact_wrench
        - F_Ho_W_commanded
        - friction_force (with friction)
        - load_shedding (with load shedding)
        - X_WO_<name of each object that moves>

    Poses are [qw qx qy qz x y z], m. `F_Ho_W_commanded` is the wrench [τ; f] on the
    handle at Ho in the world, N·m and N. `contacts`, `clusters` and `contact_wrench`
    are the outputs of `ContactQuery`, `ContactClustering` and `PenaltyForce`;
    `friction_force` is that of `StickSlipFriction`, `load_shedding` that of
    `LoadShedding`.

    It draws about 32 times per simulated second, at ticks of the loop, while a browser
    is connected. So that drawing delays no tick, a frame is drawn in slices over the
    following ticks; a slice ends with the first message after 60 µs. Drawing takes at
    most one twentieth of clock time: after a slow frame the next ones are skipped.
    While the loop sheds load, nothing is drawn. A recording is complete, however long
    that takes. With scalar type AutoDiffXd the system draws nothing.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        tool: ConvexPieces,
        objects: Sequence[ContactObject],
        X_HT: RigidTransform,
        tick_s: float,
        *,
        max_force_N: float,
        max_torque_Nm: float,
        has_friction: bool = False,
        enable_load_shedding: bool = False,
    ):
        """Constructs the system and sends the geometry.

        Args:
            meshcat: Meshcat to draw in, below "/haptics".
            tool: The tool, in its frame T.
            objects: Objects of the `ContactQuery`.
            X_HT: Pose of the tool in the handle at rest.
            tick_s: Period of the loop, s.
            max_force_N: The device's largest force, N.
            max_torque_Nm: The device's largest torque, N·m.
            has_friction: Whether there is friction to draw, which adds a port.
            enable_load_shedding: Whether the loop sheds load, which adds a port.
        """
        super().__init__()
        # A power of two of ticks is exact. A frame that is a round-off away from a tick
        # would cost the integrator another step.
        ticks = 2.0 ** math.floor(math.log2(max(_LONGEST_PERIOD_S / tick_s, 1.0)))
        self._period_s = ticks * tick_s
        self._meshcat = meshcat
        self._picture = HapticPicture(
            meshcat,
            tool,
            objects,
            X_HT,
            max_force_N=max_force_N,
            max_torque_Nm=max_torque_Nm,
            has_friction=has_friction,
        )
        self._recording = False
        self._first_frame = False
        self._recorded_sizes: list[tuple[float, float, float]] = []
        self._not_before_s = 0.0
        # The frame that is being drawn, and the time that it has taken so far.
        self._frame: Iterator[None] | None = None
        self._frame_start_s = 0.0
        self._taken_s = 0.0
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._contact_wrench = self.DeclareAbstractInputPort(
            "contact_wrench", Value[object]()
        )
        self._F_Ho_W_commanded = self.DeclareVectorInputPort("F_Ho_W_commanded", 6)
        self._friction_force = (
            self.DeclareAbstractInputPort("friction_force", Value[object]())
            if has_friction
            else None
        )
        self._load_shedding = (
            self.DeclareVectorInputPort("load_shedding", 3)
            if enable_load_shedding
            else None
        )
        self._X_WO = {
            item.name: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for item in objects
            if item.X_WO is None
        }
        self._slice_period_s = min(_SLICE_TICKS, ticks) * tick_s
        self._slices = round(self._period_s / self._slice_period_s)
        self.DeclarePeriodicPublishEvent(self._slice_period_s, 0.0, self._publish_slice)
        self.DeclareForcedPublishEvent(self._publish)

    def Show(self, view: str, visible: bool) -> None:
        """Shows or hides a view from the next frame on.

        The next frame also sends geometry that has not been sent yet.

        Args:
            view: One of `drake_haptics.systems.output.haptic_picture.PICTURE_VIEWS`.
            visible: Whether to show the view.

        Raises:
            ValueError: There is no such view.
        """
        self._picture.show(view, visible)

    @property
    def recorded_sizes(self) -> np.ndarray:
        """Times, forces and torques of a recording: (n, 3), s, N, N·m.

        There is one row for every two ticks, because frames are fewer and would miss
        peaks.
        """
        return np.array(self._recorded_sizes).reshape(-1, 3)

    def StartRecording(self) -> None:
        """Records every frame from now on into Meshcat's animation."""
        self._meshcat.StartRecording(frames_per_second=1 / self._period_s)
        self._recording = self._picture.parts.records = True
        self._first_frame = True
        self._recorded_sizes = []

    def StopRecording(self) -> None:
        """Stops recording; what was recorded stays."""
        self._meshcat.StopRecording()
        self._recording = self._picture.parts.records = False

    def PublishRecording(self) -> None:
        """Sends the animation to the browser and into `Meshcat.StaticHtml`."""
        self._meshcat.PublishRecording()

    def _publish(self, context: Context) -> None:
        """Draws a whole frame, if a browser is connected and there is time."""
        if self._recording:
            self._record(context)
        elif self._frame is not None or self._begin(context):
            self._go_on(math.inf)

    def _publish_slice(self, context: Context) -> None:
        """Continues a frame, or begins one that is due."""
        if self._recording:
            tau_x, tau_y, tau_z, *f_W = self._F_Ho_W_commanded.Eval(context).tolist()
            sizes = math.hypot(*f_W), math.hypot(tau_x, tau_y, tau_z)
            self._recorded_sizes.append((context.get_time(), *sizes))
            if self._is_due(context.get_time()):
                self._record(context)
        elif not self._must_save(context) and (
            self._frame is not None
            or (self._is_due(context.get_time()) and self._begin(context))
        ):
            self._go_on(_SLICE_S)

    def _must_save(self, context: Context) -> bool:
        """Returns whether the loop has no time for drawing."""
        return (
            self._load_shedding is not None
            and self._load_shedding.Eval(context)[0] > 0.0
        )

    def _is_due(self, time_s: float) -> bool:
        """Returns whether a frame begins with this slice."""
        return round(time_s / self._slice_period_s) % self._slices == 0

    def _record(self, context: Context) -> None:
        """Draws a frame into the recording."""
        self._frame = None
        for _ in self._draw(context):
            pass
        if self._first_frame:
            self._picture.write_visibility(context.get_time())
            self._first_frame = False

    def _begin(self, context: Context) -> bool:
        """Begins a frame, if a browser is connected and there is time."""
        now_s = time.perf_counter()
        if now_s < self._not_before_s or not self._meshcat.GetNumActiveConnections():
            return False
        self._frame = self._draw(context)
        self._frame_start_s = now_s
        self._taken_s = 0.0
        return True

    def _go_on(self, slice_s: float) -> None:
        """Continues a frame for one slice, which the last step may overrun."""
        start_s = now_s = time.perf_counter()
        assert self._frame is not None
        for _ in self._frame:
            now_s = time.perf_counter()
            if now_s - start_s > slice_s:
                self._taken_s += now_s - start_s
                return
        self._frame = None
        taken_s = self._taken_s + time.perf_counter() - start_s
        pause_s = max(taken_s / _LARGEST_SHARE, _SHORTEST_FRAME_S)
        self._not_before_s = self._frame_start_s + pause_s

    def _draw(self, context: Context) -> Iterator[None]:
        """Returns an iterator that draws a frame; all its inputs are read at once."""
        return self._steps(
            context.get_time(),
            vector_to_pose(self._X_WH.Eval(context)),
            vector_to_pose(self._X_WT.Eval(context)),
            {n: vector_to_pose(port.Eval(context)) for n, port in self._X_WO.items()},
            self._F_Ho_W_commanded.Eval(context),
            self._contacts.Eval(context),
            self._clusters.Eval(context),
            self._contact_wrench.Eval(context),
            None
            if self._friction_force is None
            else self._friction_force.Eval(context),
        )

    def _steps(
        self,
        time_s: float,
        X_WH: RigidTransform,
        X_WT: RigidTransform,
        X_WO: dict[str, RigidTransform],
        F_H_W: np.ndarray,
        contacts: ContactSet,
        clusters: ClusterSet,
        wrench: PenaltyWrench,
        friction: FrictionStep | None,
    ) -> Iterator[None]:
        """Sends a frame, one part at each step of the iteration."""
        picture = self._picture
        yield from picture.draw_views()
        yield from picture.place_tool(X_WH, X_WT, time_s)
        for name, X in X_WO.items():
            picture.place_object(name, X, time_s)
            yield
        yield from picture.draw_display_wrench(X_WH.translation(), F_H_W, time_s)
        yield from picture.draw_contacts(contacts, time_s)
        yield from picture.draw_clusters(clusters, wrench.f_cluster_W, time_s)
        if friction is not None:
            yield from picture.draw_friction(clusters, friction, time_s)
        self._meshcat.SetSimulationTime(time_s)
