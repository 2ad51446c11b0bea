"""Builds the diagram of a haptic rendering part by part."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from pydrake.math import RigidTransform
from pydrake.systems.framework import (
    BasicVector,
    Context,
    DiagramBuilder,
    OutputPort,
    System,
)
from pydrake.systems.primitives import Demultiplexer, ZeroOrderHold

from drake_haptics import _core
from drake_haptics._core import AutoDiffVector
from drake_haptics.loop.contact import (
    add_contact_systems,
    can_chain,
    find_contact_gains,
)
from drake_haptics.loop.effects import EffectSite, add_effects, find_springs
from drake_haptics.rendering.bodies import RenderedBody, find_in_state
from drake_haptics.rendering.proxy import make_proxy_step
from drake_haptics.scene.contact_law import is_constraint
from drake_haptics.scene.schema import ContactParameters, Effects, Material
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.friction_reaction import FrictionReaction
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.plant.applied_wrenches import AppliedWrenches
from drake_haptics.systems.plant.body_motions import BodyMotions
from drake_haptics.systems.plant.body_of_proxy import BodyOfProxy
from drake_haptics.systems.tool.constraint_tool_step import ConstraintToolStep
from drake_haptics.systems.tool.virtual_coupling import VirtualCoupling

# Effects that push the tool by a wrench model.
_FORCES = ("friction", "braking")


class _FiniteInput(DifferentiableSystem):
    """Passes a vector on, and raises FloatingPointError if it is not finite."""

    def __init__(self, size: int):
        super().__init__()
        self._eval = self.DeclareVectorInputPort("input", size).Eval
        self.DeclareVectorOutputPort("output", size, self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        value = self._eval(context)
        # A sum of floats takes the least time.
        if not math.isfinite(sum(value.tolist())):
            raise FloatingPointError(
                f"{self.GetSystemPathname()} must be finite, is {value.tolist()}:"
                " correct what is connected to this input"
            )
        output.set_value(value)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the vector with its derivatives."""
        return at["input"]


class RenderingWiring:
    """A `HapticRendering` under construction.

    Attributes:
        builder: Builder of its diagram.
        outputs: Output ports that the rendering will export, by name.
        proxy_gains: Gains of the spring between the tool and its proxy; None under the
            penalty law.
    """

    def __init__(
        self,
        tool: RenderedBody,
        objects: Sequence[RenderedBody],
        largest_step_s: float | None,
    ):
        """Adds the system that reads the motion of tool and objects.

        Args:
            tool: The body that is moved.
            objects: Objects that the tool meets.
            largest_step_s: Longest step of a continuous plant's integrator, s; None
                for a discrete plant.
        """
        self.builder = DiagramBuilder()
        self._tool = tool
        self._moving = {item.name: item.index for item in objects if item.X_WB is None}
        self._rendered = tuple(objects)
        self._proxy: ConstraintToolStep | None = None
        self._objects = [
            ContactObject(item.name, item.pieces, item.X_WB) for item in objects
        ]
        # Wrenches (6) on the tool, and (6 each) on the objects that move.
        self._on_tool: dict[str, OutputPort] = {}
        self._on_objects: dict[str, OutputPort] = {}
        self._warn_of_depth: Callable[[Context, float, float], None] | None = None
        self.proxy_gains: _core.CouplingGains | None = None
        self._contact_stiffness: Sequence[float] = []
        self._springs: list[tuple[float, float]] = []
        motions = self.builder.AddNamedSystem(
            "body_motions", BodyMotions(tool.index, self._moving, largest_step_s)
        )
        for port in map(motions.get_input_port, range(motions.num_input_ports())):
            self.builder.ExportInput(port, port.get_name())
        self.outputs = _name_outputs(motions)
        moving = {f"O_{item.name}": item for item in objects if item.X_WB is None}
        # Sources that are not exported, or are faster than those that are.
        self._inner = self._split_state({"T": tool, **moving})

    @property
    def sources(self) -> dict[str, OutputPort]:
        """Output ports, by the names of the inputs that need them."""
        return {
            **self.outputs,
            **self._inner,
            **{f"F_To_W_{name}": port for name, port in self._on_tool.items()},
            **{f"F_O_W_{name}": port for name, port in self._on_objects.items()},
        }

    def _split_state(self, bodies: Mapping[str, RenderedBody]) -> dict[str, OutputPort]:
        """Returns the motions of free bodies, split from the plant's state by Drake.

        To find one pose, Python would read those of all bodies at every tick. In a
        plant's state the quaternion of a free body may have any length.

        Args:
            bodies: Bodies, by the letters of their frames.

        Returns:
            Output ports, by the names of the inputs that need them.
        """
        found: list[tuple[int, int, str]] = []
        for frame, item in bodies.items():
            if (starts := find_in_state(item.body)) is not None:
                q, v = starts
                found += [(q, 7, f"X_W{frame}"), (v, 6, f"V_W{frame}")]
        if not found:
            return {}
        size = self._tool.body.GetParentPlant().num_multibody_states()
        parts: list[tuple[int, str]] = []
        end = 0
        for start, length, name in [*sorted(found), (size, 0, "")]:
            parts += [(start - end, ""), (length, name)]
            end = start + length
        parts = [part for part in parts if part[0]]
        system = self.builder.AddNamedSystem(
            "state_parts", Demultiplexer([length for length, _ in parts])
        )
        self.builder.ExportInput(system.get_input_port(), "state")
        return {
            name: system.get_output_port(i) for i, (_, name) in enumerate(parts) if name
        }

    def add_contact(
        self,
        contact: ContactParameters,
        effects: Effects,
        materials: Sequence[Material],
        period_s: float,
    ) -> None:
        """Adds the systems that find contacts and calculate their forces."""
        if is_constraint(contact):
            self._add_proxy(contact, materials, period_s)
            return
        found = add_contact_systems(
            self.builder,
            self._tool.pieces,
            self._objects,
            contact,
            effects,
            materials,
            period_s,
            enable_chain=can_chain(self._objects, contact),
            warns_deep=True,
        )
        force, query = found.penalty_force, found.contact_query
        if query.HasOutputPort("contact_chain"):
            self._inner["contact_chain"] = query.GetOutputPort("contact_chain")
            self._warn_of_depth = found.contact_clustering.warn_of_depth
        gains = find_contact_gains(contact, materials)
        self._contact_stiffness = gains.stiffness_N_per_m.tolist()
        self._on_tool["contact"] = force.GetOutputPort("F_To_W")
        self.outputs |= {
            "contacts": found.found_contacts,
            "clusters": found.contact_clustering.GetOutputPort("clusters"),
            "contact_wrench": force.GetOutputPort("contact_wrench"),
            "F_To_W": self._on_tool["contact"],
        }
        if self._moving:
            self._on_objects["contact"] = force.GetOutputPort("F_O_W")
            self.outputs["F_O_W"] = self._on_objects["contact"]

    def _add_proxy(
        self, contact: ContactParameters, materials: Sequence[Material], period_s: float
    ) -> None:
        """Adds the proxy that contact stops, and the spring from the body to it."""
        step_s = self._tool.body.GetParentPlant().time_step()
        body = self.builder.AddNamedSystem(
            "body_of_proxy", BodyOfProxy(step_s or period_s)
        )
        proxy = make_proxy_step(
            self._tool, self._rendered, contact, materials, step_s or period_s, "handle"
        )
        self.builder.AddNamedSystem("constraint_tool_step", proxy)
        self._proxy = proxy
        self.proxy_gains = proxy.get_gains(proxy.CreateDefaultContext())
        self._contact_stiffness = [self.proxy_gains.stiffness_N_per_m]
        for source, port in {
            body.GetOutputPort("X_WT_next"): proxy.GetInputPort("X_WH"),
            self.sources["V_WT"]: proxy.GetInputPort("V_WH"),
            proxy.GetOutputPort("X_WT"): body.GetInputPort("X_WP"),
            proxy.GetOutputPort("F_To_W"): body.GetInputPort("F_Po_W"),
        }.items():
            self.builder.Connect(source, port)
        self.outputs |= {
            "X_WP": proxy.GetOutputPort("X_WT"),
            "V_WP": proxy.GetOutputPort("V_WT"),
            "contacts": proxy.GetOutputPort("contacts"),
            "contact_wrench": proxy.GetOutputPort("contact_wrench"),
            "F_To_W": proxy.GetOutputPort("F_To_W"),
        }

        def hold(wrench: OutputPort) -> OutputPort:
            # A discrete plant holds its inputs itself.
            if step_s:
                return wrench
            held = self.builder.AddNamedSystem(
                f"{wrench.get_name()}_hold", ZeroOrderHold(period_s, wrench.size())
            )
            self.builder.Connect(wrench, held.get_input_port())
            return held.get_output_port()

        self._on_tool["proxy"] = hold(body.GetOutputPort("F_To_W"))
        if self._moving:
            self.outputs["F_O_W"] = hold(proxy.GetOutputPort("F_O_W"))
            self._on_objects["contact"] = self.outputs["F_O_W"]

    def add_coupling(
        self,
        gains: _core.CouplingGains,
        X_HT: RigidTransform,
        device: HapticDevice | None,
    ) -> None:
        """Adds the coupling to a handle, which a device or inputs give.

        The coupling holds the body that contact stops: the tool under the penalty law,
        otherwise its proxy. The damper always acts on the tool, because a proxy has no
        mass to damp.
        """
        coupling = self.builder.AddNamedSystem(
            "virtual_coupling", VirtualCoupling(gains, X_HT)
        )
        if self._proxy is None:
            self._push_tool("coupling", coupling.GetOutputPort("wrench_model"))
            joined = coupling.GetOutputPort("motions_and_gains")
            self._inner["coupled_motions"] = joined
            if "contact_chain" in self._inner:
                self._inner["motions_and_gains"] = joined
        else:
            pull, proxy = coupling.GetOutputPort("wrench_model"), self._proxy
            body = self.builder.GetSubsystemByName("body_of_proxy")
            for source, port in [
                (pull, proxy.GetInputPort("handle")),
                (pull, body.GetInputPort("handle")),
                (proxy.GetOutputPort("X_WT"), coupling.GetInputPort("X_WT")),
            ]:
                self.builder.Connect(source, port)
        wrench = coupling.GetOutputPort("F_Ho_W_commanded")
        self._inner["F_Ho_W_desired"] = self.outputs["F_Ho_W_commanded"] = wrench
        if device is None:
            for port in (coupling.GetInputPort("X_WH"), coupling.GetInputPort("V_WH")):
                # Errors name this system.
                named = self.builder.AddNamedSystem(
                    port.get_name(), _FiniteInput(port.size())
                )
                self.builder.Connect(named.get_output_port(), port)
                self.builder.ExportInput(named.get_input_port(), port.get_name())
            return
        self.builder.AddNamedSystem("device", device)
        self.outputs |= _name_outputs(device)
        self._springs = find_springs(device, gains, self._contact_stiffness)

    def add_effects(
        self, effects: Effects, materials: Sequence[Material], period_s: float
    ) -> None:
        """Adds the effects that are not None, after contact and coupling."""
        added = add_effects(
            EffectSite(
                effects=effects,
                builder=self.builder,
                sources=self.sources,
                tool=self._tool.pieces,
                tool_mass_kg=self._tool.body.default_mass(),
                p_TTcm=self._tool.body.default_com().tolist(),
                objects=self._objects,
                materials=materials,
                period_s=period_s,
                springs=self._springs,
            )
        )
        for name in _FORCES:
            if (system := getattr(added, name)) is not None:
                self._push_tool(name, system.GetOutputPort("wrench_model"))
        if added.braking is not None and self._moving:
            wrenches = added.braking.GetOutputPort("F_O_W")
            self._on_objects["braking"] = wrenches
        if added.shading is not None:
            self.outputs["contacts"] = added.shading.GetOutputPort("contacts")
        if added.friction is not None:
            friction_force = added.friction.GetOutputPort("friction_force")
            self.outputs["friction_force"] = friction_force
            if self._moving:
                reaction = self.builder.AddNamedSystem(
                    "friction_reaction", FrictionReaction(self._objects)
                )
                wrenches = reaction.GetOutputPort("F_O_W")
                self._on_objects["friction"] = wrenches
        if added.passivity is not None:
            # The wrench of the coupling no longer goes to the device as it is.
            self._inner.pop("coupled_motions", None)
            self.outputs |= _name_outputs(added.passivity)

    def add_applied_wrenches(self) -> None:
        """Adds the last system, which turns all wrenches into forces on bodies."""
        applied = self.builder.AddNamedSystem(
            "applied_wrenches",
            AppliedWrenches(
                self._tool.index,
                list(self._on_tool),
                list(self._moving.values()),
                list(self._on_objects),
                "motions_and_gains" in self._inner,
                self._warn_of_depth,
            ),
        )
        self.outputs["applied_spatial_force"] = applied.get_output_port()

    def _push_tool(self, name: str, wrench_model: OutputPort) -> None:
        """Adds the wrench (6) of a wrench model (78) to those on the tool."""
        system = self.builder.AddNamedSystem(
            f"{wrench_model.get_system().get_name()}_wrench", Demultiplexer([6, 72])
        )
        self.builder.Connect(wrench_model, system.get_input_port())
        self._on_tool[name] = system.get_output_port(0)


def _name_outputs(system: System) -> dict[str, OutputPort]:
    """Returns the outputs of a system by their names."""
    ports = map(system.get_output_port, range(system.num_output_ports()))
    return {port.get_name(): port for port in ports}
