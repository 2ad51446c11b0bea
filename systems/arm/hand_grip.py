"""How firmly a simulated hand holds: named grips."""

from __future__ import annotations

from dataclasses import dataclass

from drake_haptics._core import CouplingGains


@dataclass(frozen=True)
class HandGrip:
    """Mass, damping and stiffness of a hand around a handle.

    Attributes:
        mass_kg: Mass that moves with the handle, kg.
        inertia_kgm2: Rotational inertia about each axis, kg·m².
        stiffness_N_per_m: Of the spring to where the hand wants the handle, N/m.
        damping_Ns_per_m: N·s/m.
        rotational_stiffness_Nm_per_rad: N·m/rad.
        rotational_damping_Nms_per_rad: N·m·s/rad.
    """

    mass_kg: float
    inertia_kgm2: float
    stiffness_N_per_m: float
    damping_Ns_per_m: float
    rotational_stiffness_Nm_per_rad: float
    rotational_damping_Nms_per_rad: float

    def make_gains(self) -> CouplingGains:
        """Returns the spring and the damper for the core."""
        return CouplingGains(
            self.stiffness_N_per_m,
            self.damping_Ns_per_m,
            self.rotational_stiffness_Nm_per_rad,
            self.rotational_damping_Nms_per_rad,
        )


# Pen and pinch grasps lie in .05-.3 kg, 1-20 N·s/m, 50-1000 N/m and, in rotation,
# 1e-4-1e-3 kg·m², .002-.05 N·m·s/rad, .1-3 N·m/rad (Hasser and Cutkosky 2002; Israr,
# Choi and Tan 2006). The rotations are chosen in these ranges for damping like that
# of the translations. A light grip is the worst case for stability.
NOMINAL_GRIP = HandGrip(0.2, 3e-4, 300.0, 5.0, 1.0, 0.02)
HAND_GRIPS: dict[str, HandGrip | None] = {
    "none": None,
    "light": HandGrip(0.05, 1e-4, 50.0, 1.0, 0.3, 0.005),
    "nominal": NOMINAL_GRIP,
    "firm": HandGrip(0.3, 1e-3, 1000.0, 15.0, 3.0, 0.05),
}
# Who holds a real device may hold it no more firmly than this.
LOOSEST_GRIP = "light"
