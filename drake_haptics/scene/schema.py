"""Defines a scene: what is held, what it meets, who holds it, and with which gains.

A scene is a YAML file read into the dataclasses below. Every field has its unit
in its name or its docstring, every default works, and an unknown key is an error.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw


@dataclass(slots=True)
class Material:
    """The material of an object; values that are not given are the scene's.

    Attributes:
        stiffness_N_per_m: Instead of `contact.stiffness_N_per_m`, N/m; of
            `contact.law: penalty` alone.
        damping_Ns_per_m: Instead of `contact.damping_Ns_per_m`, N·s/m; of
            `contact.law: penalty` alone.
        friction_coefficient: Instead of `effects.friction.coefficient`; the scene
            must name that effect.
        shading: Whether the object is shaded; the scene must name that effect.
        skin_m: Instead of `contact.skin_m`, m.
    """

    stiffness_N_per_m: float | None = None
    damping_Ns_per_m: float | None = None
    friction_coefficient: float | None = None
    shading: bool | None = None
    skin_m: float | None = None


@dataclass(slots=True)
class ShadingParameters:
    """Force shading: facets feel smooth, edges stay sharp.

    Attributes:
        crease_angle_deg: Faces that meet at a larger angle than this form a sharp
            edge, degrees, from 0 to 180.
    """

    crease_angle_deg: float = 30.0


@dataclass(slots=True)
class FrictionParameters:
    """Stick-slip friction.

    Attributes:
        coefficient: Friction per normal force, of all objects whose material has
            none of its own.
        break_away_m: How far a contact that sticks gives way before it slips, m.
    """

    coefficient: float = 0.3
    break_away_m: float = 1e-4


@dataclass(slots=True)
class BrakingParameters:
    """Viscous braking before contact.

    Attributes:
        damping_Ns_per_m: Force per speed of approach at the surface, N·s/m.
        distance_m: Where braking begins, m. Contacts are looked for that far, if it
            is more than `contact.tolerance_m`.
    """

    damping_Ns_per_m: float = 2.0
    distance_m: float = 4e-3


@dataclass(slots=True)
class GravityParameters:
    """The tool's weight.

    Attributes:
        acceleration_m_per_s2: In the world, m/s².
    """

    acceleration_m_per_s2: list[float] = field(
        default_factory=lambda: [0.0, 0.0, -9.81]
    )


@dataclass(slots=True)
class PassivityParameters:
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

    shading: ShadingParameters | None = None
    friction: FrictionParameters | None = None
    braking: BrakingParameters | None = None
    gravity: GravityParameters | None = None
    passivity: PassivityParameters | None = None


@dataclass(slots=True)
class EncoderParameters:
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
class JointFrictionParameters:
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
class ForceDelayParameters:
    """A delay of whole ticks on the way to the motors, on top of the hold.

    Attributes:
        samples: Ticks, at least 1.
    """

    samples: int = 1


@dataclass(slots=True)
class SaturationParameters:
    """Motors of limited torque.

    Attributes:
        peak_torque_Nm: Of each motor after its gear, six numbers, N·m; the preset's
            where not given.
    """

    peak_torque_Nm: list[float] | None = None


@dataclass(slots=True)
class DeviceImperfections:
    """Imperfections of the simulated device. A part that is None is not simulated.

    In a file, a part with the preset's figures is written `encoder: {}`.

    Attributes:
        encoder: Counted angles and a speed estimated from them.
        friction: Dry and viscous friction.
        delay: The wrench arrives later.
        saturation: No motor gives more than its peak torque.
    """

    encoder: EncoderParameters | None = None
    friction: JointFrictionParameters | None = None
    delay: ForceDelayParameters | None = None
    saturation: SaturationParameters | None = None


@dataclass(slots=True)
class Pose:
    """A pose X_AB of a frame B in a frame A.

    Attributes:
        position_m: x, y, z of B's origin in A, m.
        rpy_deg: roll, pitch, yaw of B in A, degrees, in Drake's (space-fixed
            x-y-z) order.
    """

    position_m: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    rpy_deg: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])

    def to_rigid_transform(self) -> RigidTransform:
        """Returns X_AB."""
        return RigidTransform(RollPitchYaw(np.deg2rad(self.rpy_deg)), self.position_m)


@dataclass(slots=True)
class Tool:
    """The tool in the hand: a mesh with a mass.

    Its inertia is that of the mesh filled with one density.

    Attributes:
        mesh: Path of a mesh, or of a model (SDF, URDF, MJCF) whose collision shapes
            are taken, as a whole rigid; relative to the scene file, absolute, or
            `package://...` of this package or of Drake.
        scale: Meters per unit of the mesh file.
        center: Whether the mesh is moved so that the middle of its box is at the
            origin of its frame, where the coupling pulls. For a file that has its
            origin somewhere else.
        max_triangles: The mesh is first reduced to at most so many triangles; all
            of them where not given. See
            `drake_haptics.geometry.mesh.decimation.decimate`.
        chord_error_m: Of a model with round shapes: largest distance of the polytopes
            that stand for them, m; 1e-4 where not given.
        decomposition: How the mesh is cut into convex pieces: a method of
            `drake_haptics.geometry.decomposition.decompose.decompose`.
        decomposition_error_m: For `merged`, and only there: how far a piece may depart
            from the mesh, m.
        mass_kg: Mass, kg.
        grasp: X_HT, the pose of the tool's frame in the handle's.
    """

    mesh: str = ""
    scale: float = 1.0
    center: bool = False
    max_triangles: int | None = None
    chord_error_m: float | None = None
    decomposition: str = "surface"
    decomposition_error_m: float | None = None
    mass_kg: float = 0.1
    grasp: Pose = field(default_factory=Pose)


@dataclass(slots=True)
class EnvironmentObject:
    """An object that stands still in the world.

    Attributes:
        name: Unique among the scene's objects.
        mesh: As for the tool.
        scale: Meters per unit of the mesh file.
        center: As for the tool; `pose` then places the middle.
        max_triangles: As for the tool.
        chord_error_m: As for the tool.
        decomposition: As for the tool.
        decomposition_error_m: As for the tool.
        pose: X_WO, the pose of the object's frame in the world.
        material: What it is made of.
    """

    name: str = ""
    mesh: str = ""
    scale: float = 1.0
    center: bool = False
    max_triangles: int | None = None
    chord_error_m: float | None = None
    decomposition: str = "surface"
    decomposition_error_m: float | None = None
    pose: Pose = field(default_factory=Pose)
    material: Material = field(default_factory=Material)


@dataclass(slots=True)
class ContactParameters:
    """Parameters of the contact query and of the contact force.

    There are two laws. `constraint` reads `skin_m` alone; all other keys are those of
    `penalty`. A scene can have both, and `law` chooses.

    Attributes:
        law: `penalty`, springs and dampers that push surfaces apart, or `constraint`,
            by which the tool's step keeps all surfaces `skin_m` apart.
        skin_m: For `constraint`: distance that the tool keeps from each object, m (the
            δ of a row). What is to fit needs more play on each side than this. Defaults
            to 3e-4, and to less where on the hand's path there is less play.
        tolerance_m: Pieces nearer than this push each other apart, m (the paper's t).
        stiffness_N_per_m: Force per meter below the tolerance, N/m (k of Eq. 6).
        damping_Ns_per_m: Force per speed of approach, N·s/m (k_v of Eq. 6).
        clustering: How few contacts are made of many: `shared`, which is
            continuous, or `octree`, the paper's.
        cluster_size_m: For `octree`, and only there: contacts nearer than this
            count as one, m (the paper's δ).
        depth: Of two pieces in overlap: `tracked`, the way out that is nearest to
            the last one, which does not pop through a thin plate, or `global`, the
            least of all, which costs more.
        max_walk_steps: Bound on the steps of the search for a way out from feature
            to feature (the paper's maximum number of iterations), at least 1. Where
            it ends a search, the depth may be too large, never too small.
        query_rate_hz: Contacts are looked for so often, Hz, and carried along with
            the bodies in between; `device.rate_hz` divided by a whole number. Where
            not given, at every tick.
    """

    law: str = "penalty"
    skin_m: float | None = None
    tolerance_m: float = 2e-3
    stiffness_N_per_m: float = 2e4
    damping_Ns_per_m: float = 5.0
    clustering: str = "shared"
    cluster_size_m: float | None = None
    depth: str = "tracked"
    max_walk_steps: int = 1024
    query_rate_hz: float | None = None


@dataclass(slots=True)
class CouplingParameters:
    """The spring and damper between the handle and the tool.

    The device feels at most this stiffness, whatever the contact's. The defaults
    are stable on the shipped device, with and without a hand.

    Attributes:
        stiffness_N_per_m: Force per meter between handle and tool, N/m.
        damping_Ns_per_m: Force per speed of one against the other, N·s/m.
        rotational_stiffness_Nm_per_rad: Torque per angle between them, N·m/rad.
        rotational_damping_Nms_per_rad: Torque per speed of rotation of one against
            the other, N·m·s/rad.
    """

    stiffness_N_per_m: float = 800.0
    damping_Ns_per_m: float = 2.0
    rotational_stiffness_Nm_per_rad: float = 1.0
    rotational_damping_Nms_per_rad: float = 0.004


@dataclass(slots=True)
class DeviceParameters:
    """The device that is held.

    Attributes:
        preset: Name of a file in models/devices (see `drake-haptics devices`), or a
            file of your own (`*.yaml`), relative to the scene file.
        base: X_WB, the pose of the device's base in the world. Where not given,
            the middle of its workspace is put at the middle of the hand's path, and
            a device that is not simulated begins where the path does.
        rate_hz: Ticks per second of the haptic loop, Hz.
        servo_rate_hz: How often contact is solved and the tool stepped between ticks,
            Hz; `rate_hz` times a whole number. More than once a tick only for
            `contact.law: constraint`, and for a simulated device or one behind
            `udp://`, whose servo does it on a thread. Where not given, at every tick.
        tick_budget_us: What the work of a tick may take, µs. Where ticks take longer,
            drawing stops, then contacts are looked for less far, then fewer push
            (docs/troubleshooting.md). Nothing is dropped where not given.
        max_force_N: Largest force shown, N; the preset's where not given. With no more
            is the tool pressed; at 0 nothing is shown, and it is pressed without limit.
        max_torque_Nm: Largest torque shown, N·m; the preset's where not given. With no
            more is the tool turned; at 0 with no more than the force has at 5 cm.
        twin: What a simulated device has of a real one's faults.
    """

    preset: str = "phantom_premium_1_5_6dof"
    base: Pose | None = None
    rate_hz: float = 1000.0
    servo_rate_hz: float | None = None
    tick_budget_us: float | None = None
    max_force_N: float | None = None
    max_torque_Nm: float | None = None
    twin: DeviceImperfections = field(default_factory=DeviceImperfections)

    @property
    def wrench_period_s(self) -> float:
        """How often the wrench is computed that the device shows, s."""
        return 1.0 / (self.servo_rate_hz or self.rate_hz)


@dataclass(slots=True)
class Waypoint:
    """A pose of the tool at a time, which the hand aims at.

    Attributes:
        time_s: Time from the start of the path, s.
        position_m: Position of the tool's origin in the world, m.
        rpy_deg: Roll, pitch, yaw of the tool's frame in the world, degrees.
    """

    time_s: float = 0.0
    position_m: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    rpy_deg: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])


@dataclass(slots=True)
class HandPathParameters:
    """The path that the hand aims at; its spring decides how firmly.

    Attributes:
        periodic: Whether the path starts again at its last waypoint, which must
            then be at the first one's pose. Else the hand rests at the last.
        waypoints: In order of time, the first at 0 s; neighbors turned by less
            than 120°.
    """

    periodic: bool = False
    waypoints: list[Waypoint] = field(default_factory=list)


@dataclass(slots=True)
class HandParameters:
    """The simulated hand on a simulated device.

    Attributes:
        grip: Name of a grip: none, light, nominal or firm. Their masses, stiffnesses
            and dampings are those of `drake_haptics.systems.HAND_GRIPS`:
            springs of 50, 300 and 1000 N/m.
        path: Where the hand wants the tool to go.
    """

    grip: str = "nominal"
    path: HandPathParameters = field(default_factory=HandPathParameters)


@dataclass(slots=True)
class Scene:
    """A whole scene.

    Attributes:
        description: One sentence for people.
        tool: What is in the hand.
        environment: What it meets; at least one object.
        contact: How contact is found and answered.
        coupling: Between the handle and the tool.
        device: What is held.
        hand: Who holds it.
        effects: What is felt besides contact.
    """

    description: str = ""
    tool: Tool = field(default_factory=Tool)
    environment: list[EnvironmentObject] = field(default_factory=list)
    contact: ContactParameters = field(default_factory=ContactParameters)
    coupling: CouplingParameters = field(default_factory=CouplingParameters)
    device: DeviceParameters = field(default_factory=DeviceParameters)
    hand: HandParameters = field(default_factory=HandParameters)
    effects: Effects = field(default_factory=Effects)

    def __repr__(self) -> str:
        objects = ", ".join(Path(one.mesh).name for one in self.environment) or "none"
        return (
            f"Scene({self.description!r}, tool {Path(self.tool.mesh).name or 'none'}, "
            f"environment {objects}, contact {self.contact.stiffness_N_per_m:g} N/m, "
            f"coupling {self.coupling.stiffness_N_per_m:g} N/m)"
        )
