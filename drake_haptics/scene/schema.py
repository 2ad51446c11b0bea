"""Defines a scene: the device, the tool, the objects, the hand, and all gains.

A scene is a YAML file read into the dataclasses below. Every field has its unit
in its name or its docstring, every default works, and an unknown key is an error.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.common.one_line import one_line


@dataclass(slots=True)
class Material:
    """Contact properties of an object, which default to those of the scene.

    Attributes:
        stiffness_N_per_m: Stiffness of contact with the object, N/m, in place of
            `contact.stiffness_N_per_m`; only under `contact.law: penalty`.
        damping_Ns_per_m: Damping of contact with the object, N·s/m, in place of
            `contact.damping_Ns_per_m`; only under `contact.law: penalty`.
        friction_coefficient: Friction coefficient of the object, in place of
            `effects.friction.coefficient`; the scene must name that effect.
        shading: Whether the object is shaded; the scene must name `effects.shading`.
        skin_m: Distance that the tool keeps from the object, m, in place of
            `contact.skin_m`.
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
        coefficient: Ratio of friction to normal force for all objects whose material
            does not give one.
        break_away_m: Displacement of a sticking contact before it slips, m.
    """

    coefficient: float = 0.3
    break_away_m: float = 1e-4


@dataclass(slots=True)
class BrakingParameters:
    """Viscous braking before contact.

    Attributes:
        damping_Ns_per_m: Force per speed of approach at the surface, N·s/m.
        distance_m: Distance at which braking begins, m. Contacts are searched for up to
            this distance if it is more than `contact.tolerance_m`.
    """

    damping_Ns_per_m: float = 2.0
    distance_m: float = 4e-3


@dataclass(slots=True)
class GravityParameters:
    """The tool's weight.

    Attributes:
        acceleration_m_per_s2: Acceleration of gravity in the world, m/s².
    """

    acceleration_m_per_s2: list[float] = field(
        default_factory=lambda: [0.0, 0.0, -9.81]
    )


@dataclass(slots=True)
class PassivityParameters:
    """Energy-based passivity control between the coupling and the device.

    Attributes:
        max_damping_Ns_per_m: Largest damping that is added, N·s/m.
        max_rotational_damping_Nms_per_rad: Largest rotational damping that is added,
            N·m·s/rad.
        reserve_J: Largest energy that the virtual world is allowed to give back, J.
            Defaults to the energy of the scene's springs at the device's limits and of
            the tool.
    """

    max_damping_Ns_per_m: float = 20.0
    max_rotational_damping_Nms_per_rad: float = 0.02
    reserve_J: float | None = None


@dataclass(slots=True)
class Effects:
    """The effects of a scene. An effect that is None is not in the diagram.

    In a file, an effect with its defaults is written `gravity: {}`.

    Attributes:
        shading: Force shading: facets feel smooth, edges stay sharp.
        friction: Stick-slip friction.
        braking: Viscous braking before contact.
        gravity: The tool's weight.
        passivity: Energy-based passivity control between the coupling and the device.
    """

    shading: ShadingParameters | None = None
    friction: FrictionParameters | None = None
    braking: BrakingParameters | None = None
    gravity: GravityParameters | None = None
    passivity: PassivityParameters | None = None


@dataclass(slots=True)
class EncoderParameters:
    """Encoders on the motors: the loop sees counted angles, not true ones.

    Attributes:
        step_rad: Angle of a motor after its gear per count of its encoder, six numbers,
            rad. Defaults to the preset's.
        velocity_window: Number of ticks over which counts are subtracted to estimate
            the speed, from 1 to 1,000. The speed's resolution is the step divided by
            the window, its delay half a window.
    """

    step_rad: list[float] | None = None
    velocity_window: int = 4


@dataclass(slots=True)
class JointFrictionParameters:
    """Dry and viscous friction of the motors, beyond the damping of the model.

    Attributes:
        coulomb_Nm: Dry friction torque of each motor, six numbers, N·m. Defaults to the
            preset's.
        viscous_Nms_per_rad: Viscous friction torque per speed of each motor, six
            numbers, N·m·s/rad. Defaults to none.
    """

    coulomb_Nm: list[float] | None = None
    viscous_Nms_per_rad: list[float] = field(default_factory=lambda: [0.0] * 6)


@dataclass(slots=True)
class ForceDelayParameters:
    """A delay of whole ticks on the way to the motors, on top of the hold.

    Attributes:
        samples: Delay in ticks, from 1 to 1,000.
    """

    samples: int = 1


@dataclass(slots=True)
class SaturationParameters:
    """Motors of limited torque.

    Attributes:
        peak_torque_Nm: Peak torque of each motor after its gear, six numbers, N·m.
            Defaults to the preset's.
    """

    peak_torque_Nm: list[float] | None = None


@dataclass(slots=True)
class DeviceImperfections:
    """Imperfections of the simulated device. A part that is None is not simulated.

    In a file, a part with the preset's figures is written `encoder: {}`.

    Attributes:
        encoder: Counted angles and a speed estimated from them.
        friction: Dry and viscous friction.
        delay: Delay of the wrench on its way to the motors.
        saturation: Limit of each motor to its peak torque.
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
    """A rigid mesh with a mass, moved by the coupling.

    Its inertia is that of the mesh filled with one density.

    Attributes:
        mesh: Path of a mesh, or of a model (SDF, URDF, MJCF) whose collision shapes
            form one rigid tool; relative to the scene file, absolute, or
            `package://...` of this package or of Drake.
        scale: Meters per unit of the mesh file.
        center: Whether the mesh is moved so that the middle of its box is at the origin
            of its frame, where the coupling pulls; meant for files with their origin
            elsewhere.
        max_triangles: Largest number of triangles to which the mesh is first reduced,
            see `drake_haptics.geometry.mesh.decimation.decimate`. Defaults to all
            triangles.
        chord_error_m: Largest distance between a model's round shapes and the polytopes
            that approximate them, m. Defaults to 1e-4.
        decomposition: Method that cuts the mesh into convex pieces, one of those of
            `drake_haptics.geometry.decomposition.decompose.decompose`.
        decomposition_error_m: Largest distance between a piece and the mesh, m; only
            for `merged`.
        mass_kg: Mass of the tool, kg.
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

    __repr__ = one_line


@dataclass(slots=True)
class EnvironmentObject:
    """An object that stands still in the world.

    Attributes:
        name: Name of the object, unique in the scene.
        mesh: Path of a mesh or model, as for the tool.
        scale: Meters per unit of the mesh file.
        center: Whether the mesh is centered, as for the tool; `pose` then places the
            middle.
        max_triangles: Largest number of triangles, as for the tool.
        chord_error_m: Largest distance between round shapes and polytopes, m, as for
            the tool.
        decomposition: Method that cuts the mesh into convex pieces, as for the tool.
        decomposition_error_m: Largest distance between a piece and the mesh, m, as for
            the tool.
        pose: X_WO, the pose of the object's frame in the world.
        material: Material of the object.
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

    __repr__ = one_line


@dataclass(slots=True)
class ContactParameters:
    """Parameters of the contact query and of the contact force.

    There are two laws. `constraint` reads only `skin_m`; all other keys belong to
    `penalty`. A scene may give the keys of both, and `law` chooses.

    Attributes:
        law: Name of the law: `penalty`, by which springs and dampers push surfaces
            apart, or `constraint`, by which the tool's step keeps all surfaces `skin_m`
            apart.
        skin_m: Distance that the tool keeps from each object, m (the δ of a row); for
            `constraint`. A tool that must fit into an object needs more play than this
            on each side. Defaults to 3e-4, or to less where the hand's path leaves less
            play.
        tolerance_m: Distance below which pieces push each other apart, m (the paper's
            t).
        stiffness_N_per_m: Force per meter below the tolerance, N/m (k of Eq. 6).
        damping_Ns_per_m: Force per speed of approach, N·s/m (k_v of Eq. 6).
        clustering: Method that reduces many contacts to few: `shared`, which is
            continuous, or `octree`, the paper's.
        cluster_size_m: Distance below which contacts count as one, m (the paper's δ);
            only for `octree`.
        depth: Penetration depth of two overlapping pieces: `tracked`, along the way out
            nearest to the last one, which does not pop through a thin plate, or
            `global`, the least of all, which takes more time.
        max_walk_steps: Bound on the steps from feature to feature in the search for a
            way out (the paper's maximum number of iterations), at least 1. If it ends a
            search, the depth may be too large, but never too small.
        query_rate_hz: Rate at which contacts are searched for, Hz; in between they move
            with the bodies. It must be `device.rate_hz` divided by a whole number.
            Defaults to every tick.
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

    The device feels at most this stiffness, whatever the contact's. The defaults are
    stable on the shipped device, with and without a hand.

    Attributes:
        stiffness_N_per_m: Force per meter between handle and tool, N/m.
        damping_Ns_per_m: Force per relative speed of handle and tool, N·s/m.
        rotational_stiffness_Nm_per_rad: Torque per angle between handle and tool,
            N·m/rad.
        rotational_damping_Nms_per_rad: Torque per relative angular speed of handle and
            tool, N·m·s/rad.
    """

    stiffness_N_per_m: float = 800.0
    damping_Ns_per_m: float = 2.0
    rotational_stiffness_Nm_per_rad: float = 1.0
    rotational_damping_Nms_per_rad: float = 0.004


@dataclass(slots=True)
class DeviceParameters:
    """The device that the hand holds.

    Attributes:
        preset: Name of a file in models/devices (see `drake-haptics devices`), or a
            file of your own (`*.yaml`), relative to the scene file.
        base: X_WB, the pose of the device's base in the world. Defaults to the pose
            that puts the middle of the workspace at the middle of the hand's path; the
            handle of a device that is not simulated then begins where the path does.
        rate_hz: Ticks per second of the haptic loop, Hz, from 10 to 100,000.
        servo_rate_hz: Rate at which contact is solved and the tool stepped, Hz;
            `rate_hz` times a whole number. It may exceed `rate_hz` only for
            `contact.law: constraint` with a simulated device or one behind `udp://`,
            whose servo runs on a thread. Defaults to every tick.
        tick_budget_us: Time that the work of a tick may take, µs. While ticks take
            longer, drawing stops, then contacts are searched for over shorter
            distances, then fewer push (docs/troubleshooting.md). Defaults to no budget:
            nothing is dropped.
        max_force_N: Largest force shown, N. Defaults to the preset's. The coupling
            presses the tool with at most this force; at 0 no force is shown, and the
            tool is pressed without limit.
        max_torque_Nm: Largest torque shown, N·m. Defaults to the preset's. The coupling
            turns the tool with at most this torque; at 0, with at most the torque of
            the largest force at 5 cm.
        twin: Imperfections of the simulated device.
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
        """Period at which the wrench that the device shows is computed, s."""
        return 1.0 / (self.servo_rate_hz or self.rate_hz)

    __repr__ = one_line


@dataclass(slots=True)
class Waypoint:
    """A pose of the tool that the hand aims at, and its time.

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
    """The path that the hand aims at; the stiffness of the hand decides how closely.

    Attributes:
        periodic: Whether the path starts again at its last waypoint, which must then be
            at the first one's pose. Otherwise the hand rests at the last waypoint.
        waypoints: Waypoints in order of time, the first at 0 s; neighbors are turned by
            less than 120°.
    """

    periodic: bool = False
    waypoints: list[Waypoint] = field(default_factory=list)

    __repr__ = one_line


@dataclass(slots=True)
class HandParameters:
    """The simulated hand on a simulated device.

    Attributes:
        grip: Name of a grip: none, light, nominal or firm. Their masses, stiffnesses
            and dampings are those of `drake_haptics.systems.HAND_GRIPS`:
            springs of 50, 300 and 1000 N/m.
        path: Path along which the hand moves the tool.
    """

    grip: str = "nominal"
    path: HandPathParameters = field(default_factory=HandPathParameters)

    __repr__ = one_line


@dataclass(slots=True)
class Scene:
    """A whole scene.

    Attributes:
        description: One sentence that describes the scene.
        tool: Tool in the hand.
        environment: Objects that the tool meets; at least one.
        contact: Law of contact and its parameters.
        coupling: Gains of the coupling.
        device: The device that the hand holds.
        hand: Hand that holds the device.
        effects: Effects that are felt besides contact.
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
