"""What a simulated device has of a real one's faults: each part only if named."""

from dataclasses import dataclass, field


@dataclass(slots=True)
class Encoder:
    """Encoders on the motors: the loop sees counted angles, not the true ones.

    Attributes:
        step_rad: Angle of a joint per count of its motor's encoder, six numbers, rad;
            the preset's where not given.
        velocity_window: Samples over which the speed is the difference of counts, at
            least 1. Its resolution is the step per window, its delay half a window.
    """

    step_rad: list[float] | None = None
    velocity_window: int = 4


@dataclass(slots=True)
class JointFriction:
    """Dry and viscous friction of the motors, beyond the damping of the model.

    Attributes:
        coulomb_Nm: Torque against motion, six numbers, N·m; the preset's where not
            given.
        viscous_Nms_per_rad: Torque per speed, six numbers, N·m·s/rad; none where not
            given.
    """

    coulomb_Nm: list[float] | None = None
    viscous_Nms_per_rad: list[float] = field(default_factory=lambda: [0.0] * 6)


@dataclass(slots=True)
class ForceDelay:
    """A way to the motors that takes whole ticks, on top of the hold.

    Attributes:
        samples: Ticks, at least 1.
    """

    samples: int = 1


@dataclass(slots=True)
class Saturation:
    """Motors of limited torque.

    Attributes:
        peak_torque_Nm: Of each motor after its gear, six numbers, N·m; the preset's
            where not given.
    """

    peak_torque_Nm: list[float] | None = None


@dataclass(slots=True)
class Twin:
    """How faithful the simulated device is. A part that is None is not in the diagram.

    In a file, a part with the preset's figures is written `encoder: {}`.

    Attributes:
        encoder: Counted angles and a speed estimated from them.
        friction: Dry and viscous friction.
        delay: The wrench arrives later.
        saturation: No motor gives more than its peak torque.
    """

    encoder: Encoder | None = None
    friction: JointFriction | None = None
    delay: ForceDelay | None = None
    saturation: Saturation | None = None
