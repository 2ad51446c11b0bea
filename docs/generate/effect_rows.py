"""The rows of docs/effects.md for each effect, but for its cost.

Defaults are read off the dataclasses, so that the page cannot lag behind them.
"""

from __future__ import annotations

from dataclasses import dataclass

from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    DeviceParameters,
    FrictionParameters,
    GravityParameters,
    PassivityParameters,
    ShadingParameters,
)


@dataclass(frozen=True)
class EffectRow:
    """A row of the table.

    Attributes:
        name: Name for people.
        key: Key of the scene.
        core: Key of `CORE_CALLS` that it costs; None if it has no call of its own.
        formula: Formula of its part of the wrench.
        source: Source of the formula.
        default: Default values.
        stability: Effect on the stability of the loop.
    """

    name: str
    key: str
    core: str | None
    formula: str
    source: str
    default: str
    stability: str


def make_rows() -> list[EffectRow]:
    """Returns all rows: first the laws that always hold, then a scene's effects."""
    contact, device = ContactParameters(), load_device_preset(DeviceParameters().preset)
    shading, friction, braking = (
        ShadingParameters(),
        FrictionParameters(),
        BrakingParameters(),
    )
    gravity, passivity = GravityParameters(), PassivityParameters()
    return [
        EffectRow(
            "near-contact elastic force",
            "`contact.stiffness_N_per_m`",
            "force",
            "f = k · compression · n; compression is t − d of a contact alone",
            "paper, Eq. 6–10",
            f"k = {contact.stiffness_N_per_m:g} N/m,"
            f" t = {1e3 * contact.tolerance_m:g} mm",
            "The tool's implicit step is stable at any k; the device feels the coupling"
            " at most.",
        ),
        EffectRow(
            "sharing of stiffness",
            "`contact.clustering: shared`",
            "clustering",
            "k w = C λ where λ > 0, C_ij = (1 − ρ) c(nᵢ, nⱼ) + δᵢⱼ ρ/mᵢ, c from 1 where"
            " normals are alike to 0 at right angles",
            "`core/law/shared_stiffness.h`; `octree`: paper, 4.2, Eq. 1–5",
            f"{contact.clustering}",
            "Continuous; makes no energy while normals and shares stay. `octree` jumps"
            " where a contact crosses a cell.",
        ),
        EffectRow(
            "damping on approach",
            "`contact.damping_Ns_per_m`",
            None,
            "f = k_v · share · v n, v > 0 the speed of approach; f never pulls",
            "paper, Eq. 6",
            f"k_v = {contact.damping_Ns_per_m:g} N·s/m",
            "Dissipates only; implicit in the tool's step.",
        ),
        EffectRow(
            "limits of force and torque",
            "`device.max_force_N`, `device.max_torque_Nm`",
            None,
            "F · min(1, F_max/‖F‖), and so for the torque; zero if not finite",
            "the device's preset",
            f"{device.max_force_N:g} N, {device.max_torque_Nm:g} N·m",
            "Only ever lowers the loop's gain; direction is kept. The coupling presses"
            " the tool with no more.",
        ),
        EffectRow(
            "force shading",
            "`effects.shading`",
            "shading",
            "n along r_B m_B − r_A m_A + d n, m interpolated vertex normals, r radii of"
            " curvature; turned by 45° at most",
            "paper, 4.4.1; Morgenbesser and Srinivasan 1996",
            f"crease angle {shading.crease_angle_deg:g}°",
            "Not the gradient of an energy: a closed path may gain or lose some."
            " Name `effects.passivity` beside it where a hand holds lightly.",
        ),
        EffectRow(
            "stick–slip friction",
            "`effects.friction`",
            "friction",
            "f = −(r μ N/z_b) z, drawn along beyond the cone: r μ N at break-away,"
            " μ N in sliding",
            "Hayward and Armstrong 2000; paper, 4.4.2",
            f"μ = {friction.coefficient:g}, z_b = {1e3 * friction.break_away_m:g} mm,"
            " r = 1.2",
            "A function of displacement, without creep; no change of the normal force"
            " makes energy. Stiff while it sticks, implicit in the tool's step.",
        ),
        EffectRow(
            "pre-contact braking",
            "`effects.braking`",
            "braking",
            "f = b s w v n for 0 < d < D, w = 4 (d/D)(1 − d/D)",
            "McNeely, Puterbaugh and Troy 1999",
            f"b = {braking.damping_Ns_per_m:g} N·s/m,"
            f" D = {1e3 * braking.distance_m:g} mm",
            "Dissipates only: a mass m loses 2 b D / (3 m) of its speed. Contacts are"
            " looked for up to D.",
        ),
        EffectRow(
            "gravity on the tool",
            "`effects.gravity`",
            "gravity",
            "f = m g at the center of mass",
            "Newton",
            f"g = {gravity.acceleration_m_per_s2} m/s²",
            "None: a constant force.",
        ),
        EffectRow(
            "passivity control",
            "`effects.passivity`",
            "passivity",
            "F − α V, α so that it dissipates in one tick what E = Σ F·Δx lacks",
            "Hannaford and Ryu 2002; Ryu, Kim and Hannaford 2004",
            f"α ≤ {passivity.max_damping_Ns_per_m:g} N·s/m,"
            f" {passivity.max_rotational_damping_Nms_per_rad:g} N·m·s/rad;"
            " reserve from springs and limits",
            "Keeps the port passive, up to its largest damping; no delay, no power.",
        ),
    ]
