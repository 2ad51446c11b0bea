"""Contact of a body of a plant with others, as a diagram between the plant's ports."""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram

from drake_haptics._core import CouplingGains
from drake_haptics.loop.add_haptic_loop import check_device_period, make_coupling_gains
from drake_haptics.loop.contact import connect_by_name
from drake_haptics.rendering.bodies import RenderedBody
from drake_haptics.rendering.wiring import RenderingWiring
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    Material,
)
from drake_haptics.scene.validation import calc_skin_speed
from drake_haptics.systems.device.haptic_device import HapticDevice


class HapticRendering(Diagram):
    """Contact of one body of a plant with others, as forces on all of them.

    .. pydrake_system::

        name: HapticRendering
        input_ports:
        - body_poses
        - body_spatial_velocities
        - state (with bodies that are free)
        - X_WH (with a coupling, without a device)
        - V_WH (with a coupling, without a device)
        output_ports:
        - X_WT
        - V_WT
        - X_WO_<name of each body that moves>
        - V_WO_<name of each body that moves>
        - X_WP (under the constraint law)
        - V_WP (under the constraint law)
        - contacts
        - clusters (under the penalty law)
        - contact_wrench
        - F_To_W
        - F_O_W (with bodies that move)
        - F_Ho_W_commanded (with a coupling)
        - X_WH (with a device)
        - V_WH (with a device)
        - F_Ho_W_rendered (with a device)
        - status (with a device)
        - reading (with a device that is not simulated)
        - friction_force (with friction)
        - energy_J (with passivity control)
        - applied_spatial_force

    * `body_poses`, `body_spatial_velocities`, `state` and `applied_spatial_force`
      connect to the plant's ports of these names. Contact, coupling and effects read
      the motion of a free body from the `state`, which takes less time per tick.
    * `X_WT` and `X_WO_<name>` (7) are poses [qw qx qy qz x y z] of the bodies'
      frames in the world, m; `V_WT` and `V_WO_<name>` (6) their spatial velocities
      [ω; v] at the frame's origin in the world, rad/s and m/s.
    * `X_WP` (7) and `V_WP` (6) are the pose and the velocity of the proxy.
    * `contacts` is a `drake_haptics.ContactSet`, shaded with that effect; `clusters` is
      a `drake_haptics._core.ClusterSet`.
    * `F_To_W` (6) is the wrench [τ; f] of contact on the tool at its origin in the
      world, N·m and N, without coupling and effects; `F_O_W` (6 for each body that
      moves) are those on the bodies. `contact_wrench` is that of `PenaltyForce`. Under
      the constraint law all of them are the proxy's, as in `ConstraintToolStep`.
    * `F_Ho_W_commanded` (6) is the wrench [τ; f] to show on the handle at its origin in
      the world, N·m and N; `X_WH`, `V_WH`, `F_Ho_W_rendered`, `status` and `reading`
      are those of `HapticDevice`, `friction_force` that of `StickSlipFriction`,
      `energy_J` that of `PassivityControl`.

    Under the constraint law contact stops a light proxy in the body's place, and a
    handle holds the proxy. The body penetrates by its load divided by the stiffness of
    `proxy_gains`. `Simulator.Initialize` puts the proxy where the body is. In a
    continuous plant the wrenches on the proxy are held for a tick. Everything else is a
    function of the plant's present state, without a sample of delay.

    Under the penalty law, a step of a tool that is faster than `skin_speed_m_per_s` may
    carry it from beyond the tolerance into a shape. Contact is still found, but as deep
    as that step has taken the tool. Each contact that is deeper than ten
    tolerances causes one `drake_haptics.scene.validation.SceneWarning`.
    """

    def __init__(
        self,
        tool: RenderedBody,
        objects: Sequence[RenderedBody],
        *,
        contact: ContactParameters,
        materials: Sequence[Material],
        effects: Effects,
        coupling: CouplingParameters | None,
        device: HapticDevice | None,
        X_HT: RigidTransform,
        period_s: float,
    ):
        """Constructs the diagram; see `AddHapticRendering`.

        Args:
            tool: The body that is moved.
            objects: Objects that the tool meets.
            contact: The law of contact and its parameters.
            materials: Material of each object.
            effects: Effects besides contact.
            coupling: Gains between a handle and the tool; None for no handle.
            device: Device of the handle, not yet in a builder; None if inputs give the
                handle.
            X_HT: Pose of the tool in the handle at rest.
            period_s: Tick of effects with a memory, and longest step of a continuous
                plant's integrator, s.

        Raises:
            ValueError: A gain or size is out of range, an effect or the device lacks
                something that it needs, or the device's period is not `period_s`.
        """
        super().__init__()
        _check_effects(effects, coupling, device)
        if device is not None:
            check_device_period(device, period_s)
        self._tool = tool
        self._objects = tuple(objects)
        step_s = tool.body.GetParentPlant().time_step()
        self._skin_speed_m_per_s = calc_skin_speed(contact, step_s or period_s)
        wiring = RenderingWiring(tool, objects, None if step_s else period_s)
        wiring.add_contact(contact, effects, materials, period_s)
        self._proxy_gains = wiring.proxy_gains
        if coupling is not None:
            wiring.add_coupling(make_coupling_gains(coupling, device), X_HT, device)
        wiring.add_effects(effects, materials, period_s)
        wiring.add_applied_wrenches()
        for system in wiring.builder.GetSystems():
            connect_by_name(wiring.builder, system, wiring.sources)
        for name, port in wiring.outputs.items():
            wiring.builder.ExportOutput(port, name)
        wiring.builder.BuildInto(self)

    def __repr__(self) -> str:
        objects = ", ".join(one.name for one in self._objects)
        how = ""
        if self._proxy_gains is not None:
            stiffness = self._proxy_gains.stiffness_N_per_m
            how = f", drawn to a proxy with {stiffness:.3g} N/m"
        return f"HapticRendering({self._tool.name!r} against {objects}{how})"

    @property
    def tool(self) -> RenderedBody:
        """The body that is moved."""
        return self._tool

    @property
    def objects(self) -> tuple[RenderedBody, ...]:
        """Objects that the tool meets, in the order of `ContactSet.object_index`."""
        return self._objects

    @property
    def proxy_gains(self) -> CouplingGains | None:
        """Gains of the spring from the body to its proxy; None under the penalty law.

        They are as stiff as the plant's step allows with a margin, given the inertia of
        the body in the plant's default positions and that of the lightest object:
        `drake_haptics.rendering.proxy.calc_proxy_gains`.
        """
        return self._proxy_gains

    @property
    def skin_speed_m_per_s(self) -> float:
        """Speed at which one step of the plant crosses the contact tolerance, m/s.

        A query by `contact.query_rate_hz` that is slower than the step counts as the
        step. For a plant without a time step the step is `period_s`, the longest of its
        integrator.
        """
        return self._skin_speed_m_per_s


def _check_effects(
    effects: Effects, coupling: CouplingParameters | None, device: HapticDevice | None
) -> None:
    """Refuses effects that would do nothing or act wrongly."""
    if device is not None and coupling is None:
        raise ValueError(
            "device: needs a coupling to the tool; give coupling=CouplingParameters()"
        )
    if effects.gravity is not None:
        raise ValueError(
            "effects.gravity: the plant's own gravity acts on the tool already; change"
            " it with plant.mutable_gravity_field()"
        )
    if effects.passivity is not None and device is None:
        raise ValueError(
            "effects.passivity needs a device: give device=, or put a PassivityControl"
            " before your own"
        )
