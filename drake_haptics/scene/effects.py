"""Effects and materials of a scene: each is there only if the scene names it."""

from dataclasses import dataclass, field


@dataclass(slots=True)
class Material:
    """What an object is made of; what is not given is the scene's.

    Attributes:
        stiffness_N_per_m: Instead of `contact.stiffness_N_per_m`, N/m.
        damping_Ns_per_m: Instead of `contact.damping_Ns_per_m`, N·s/m.
        friction_coefficient: Instead of `effects.friction.coefficient`; the scene
            must name that effect.
        shading: Whether the object is shaded; the scene must name that effect.
    """

    stiffness_N_per_m: float | None = None
    damping_Ns_per_m: float | None = None
    friction_coefficient: float | None = None
    shading: bool | None = None


@dataclass(slots=True)
class Shading:
    """Force shading: facets feel smooth, edges stay sharp.

    Attributes:
        crease_angle_deg: Faces that meet at a larger angle than this form a sharp
            edge, degrees, from 0 to 180.
    """

    crease_angle_deg: float = 30.0


@dataclass(slots=True)
class Friction:
    """Stick-slip friction.

    Attributes:
        coefficient: Friction per normal force, of all objects whose material has
            none of its own.
        break_away_m: How far a contact that sticks gives way before it slips, m.
    """

    coefficient: float = 0.3
    break_away_m: float = 1e-4


@dataclass(slots=True)
class Braking:
    """Viscous braking before contact.

    Attributes:
        damping_Ns_per_m: Force per speed of approach at the surface, N·s/m.
        distance_m: Where braking begins, m. Contacts are looked for that far, if it
            is more than `contact.tolerance_m`.
    """

    damping_Ns_per_m: float = 2.0
    distance_m: float = 4e-3


@dataclass(slots=True)
class Gravity:
    """The tool's weight.

    Attributes:
        acceleration_m_per_s2: In the world, m/s².
    """

    acceleration_m_per_s2: list[float] = field(
        default_factory=lambda: [0.0, 0.0, -9.81]
    )


@dataclass(slots=True)
class Passivity:
    """Energy-based passivity control between the coupling and the device.

    Attributes:
        max_damping_Ns_per_m: Largest damping that is added, N·s/m.
        max_rotational_damping_Nms_per_rad: The same about an axis, N·m·s/rad.
        reserve_J: Largest energy that is taken for the world's own, J; where not
            given, that of the scene's springs at the device's limits and of the tool.
    """

    max_damping_Ns_per_m: float = 20.0
    max_rotational_damping_Nms_per_rad: float = 0.02
    reserve_J: float | None = None


@dataclass(slots=True)
class Effects:
    """The effects of a scene. One that is None is not in the diagram.

    In a file, an effect with its defaults is written `gravity: {}`.

    Attributes:
        shading: Smooths forces over facets.
        friction: Stick-slip friction.
        braking: Viscous braking before contact.
        gravity: The tool's weight.
        passivity: Takes energy that the loop has made.
    """

    shading: Shading | None = None
    friction: Friction | None = None
    braking: Braking | None = None
    gravity: Gravity | None = None
    passivity: Passivity | None = None
