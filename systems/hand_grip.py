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
        gains: Spring and damper between the handle and where the hand wants it.
    """

    mass_kg: float
    inertia_kgm2: float
    gains: CouplingGains


# Pen and pinch grasps lie in .05-.3 kg, 1-20 N·s/m, 50-1000 N/m and, in rotation,
# 1e-4-1e-3 kg·m², .002-.05 N·m·s/rad, .1-3 N·m/rad (Hasser and Cutkosky 2002; Israr,
# Choi and Tan 2006). The rotations are chosen in these ranges for damping like that
# of the translations. A light grip is the worst case for stability.
HAND_GRIPS: dict[str, HandGrip | None] = {
    "none": None,
    "light": HandGrip(0.05, 1e-4, CouplingGains(50.0, 1.0, 0.3, 0.005)),
    "nominal": HandGrip(0.2, 3e-4, CouplingGains(300.0, 5.0, 1.0, 0.02)),
    "firm": HandGrip(0.3, 1e-3, CouplingGains(1000.0, 15.0, 3.0, 0.05)),
}
