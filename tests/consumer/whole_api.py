"""A program that uses every public name, as the README and the pages do.

It is not run: mypy reads it as a consumer's, and lets no `Any` pass.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import SceneGraph
from pydrake.lcm import DrakeLcm
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import DiagramBuilder, System
from typing_extensions import assert_type

from drake_haptics import (
    AddAppliedSpatialForce,
    AddHapticLoop,
    AddHapticRendering,
    AddLcmDriver,
    AddTickLog,
    ApplyHapticRenderingConfig,
    BrakingParameters,
    BuildHapticDiagram,
    CallbackTimer,
    ConnectMovingObject,
    Contact,
    ContactParameters,
    ContactSet,
    ContactStatus,
    ContactTracker,
    ContactTrajectory,
    ConvexPair,
    ConvexPolytope,
    CouplingParameters,
    Decomposition,
    DeviceBackend,
    DeviceCommand,
    DeviceError,
    DeviceImperfections,
    DeviceParameters,
    DevicePreset,
    DeviceReading,
    Effects,
    EnergyLedger,
    EnvironmentObject,
    Feature,
    FeatureKind,
    FrictionParameters,
    GravityParameters,
    HandParameters,
    HandPathParameters,
    HaplyDevice,
    HapticDiagram,
    HapticLoop,
    HapticRendering,
    HapticRenderingConfig,
    HapticsError,
    HeldHandle,
    LcmDevice,
    Material,
    Mesh,
    MeshcatDevice,
    MeshError,
    MouseDevice,
    OutsideContact,
    OutsideLibrary,
    PairTrajectory,
    PassivityParameters,
    Pose,
    RealTimePacer,
    RunError,
    RunStatistics,
    Scene,
    SceneError,
    SceneTracker,
    ShadingParameters,
    TickRecorder,
    Tool,
    UdpDevice,
    Waypoint,
    __version__,
    calc_passive_stiffness,
    calc_stable_stiffness,
    configure_camera,
    decompose,
    explain_tick,
    find_mesh,
    find_scene,
    get_include,
    list_device_presets,
    list_meshes,
    list_scenes,
    live_keys,
    load_device_preset,
    load_haptic_rendering_config,
    load_mesh,
    load_scene,
    make_device_port,
    make_log_header,
    make_scene_for_meshes,
    make_simulator,
    open_device,
    read_tick_log,
    replay,
    run,
    start_meshcat,
    transfer_context,
    wait_for_reading,
    write_live_values,
)
from drake_haptics.geometry import RigidToolDynamics, center, make_tool_dynamics
from drake_haptics.simulation import LiveKey
from drake_haptics.systems import HapticCommandReceiver, HapticDevice


class Still(DeviceBackend):
    """A user's device."""

    def read(self) -> DeviceReading | None:
        """Returns where it is."""
        zero = np.zeros(6)
        return DeviceReading(1, 0.0, np.zeros(7), zero, zero)

    def write(self, command: DeviceCommand) -> None:
        """Takes no notice."""
        assert_type(command.F_Ho_B, NDArray[np.float64])

    def close(self) -> None:
        """Has nothing to end."""


def use_geometry(path: Path) -> float:
    """Contacts without Drake."""
    assert_type(list_meshes(), dict[str, Path])
    try:
        mesh: Mesh = load_mesh(find_mesh(str(path)), unit="mm")
    except MeshError as error:
        raise SystemExit(str(error)) from error
    cup: Decomposition = decompose(mesh, "merged", error_m=1e-4, progress=print)
    assert_type(cup.pieces, list[ConvexPolytope])
    assert_type(make_tool_dynamics(center(mesh), 0.1), RigidToolDynamics)
    assert_type(cup.report.pieces, int)
    assert_type(mesh.report.extent, tuple[float, float, float])
    pair = ConvexPair(cup.pieces[0], ConvexPolytope([[0.0, 0.0, 0.0]]), "global")
    contact: Contact = pair.query(np.eye(4), [1.0, 0, 0, 0, 0, 0, 0])
    feature: Feature | None = contact.feature_A
    assert feature is not None
    assert_type(feature.kind, FeatureKind)
    assert_type(contact.status, ContactStatus)
    motion: PairTrajectory = pair.query_trajectory(np.eye(4)[None], np.eye(4))
    tracker = ContactTracker(cup, cup, tolerance=1e-3)
    way: ContactTrajectory = tracker.query_trajectory(np.eye(4)[None], np.eye(4))
    scene = SceneTracker(cup, [cup], tolerance=1e-3, depth="global")
    scene.set_object_pose(0, np.eye(4))
    contacts: ContactSet = scene.query(np.eye(4))
    assert_type(contacts.least_distance, float)
    depths = [-one.distance for one in contacts if one.status != ContactStatus.NEAR]
    assert_type(depths, list[float])
    return max(depths) + len(motion) + len(way[0])


def use_a_scene(name: str) -> float:
    """A scene, its run, its log."""
    assert_type(list_scenes(), dict[str, Path])
    scene: Scene = load_scene(find_scene(name))
    scene.contact.stiffness_N_per_m = 4000.0
    scene.coupling = CouplingParameters(stiffness_N_per_m=500.0)
    scene.effects.gravity = GravityParameters([0.0, 0.0, -1.6])
    made = make_scene_for_meshes(find_mesh("pen"), find_mesh("sphere"))
    assert_type(made, Scene)
    try:
        backend = open_device("udp://127.0.0.1:7400", scene)
    except (DeviceError, SceneError) as error:
        raise HapticsError(str(error)) from error
    with backend:
        with CallbackTimer() as timer:
            haptic: HapticDiagram = BuildHapticDiagram(scene, device=backend)
        assert_type([part.why for part in explain_tick(haptic, timer)], list[str])
        loop: HapticLoop = haptic.loop
        root = make_simulator(haptic).get_context()
        write_live_values(haptic, root, scene)
        assert_type(live_keys(scene), tuple[LiveKey, ...])
        assert_type([key.high for key in live_keys(scene)], list[float])
        root = transfer_context(haptic, root, BuildHapticDiagram(scene))
        ledger = EnergyLedger(loop, root)
        assert_type(ledger.to_dict(), dict[str, dict[str, float]])
        with TickRecorder("run.ticks", make_log_header(scene)):
            pass
        try:
            figures = run(haptic, 2.0, pace=RealTimePacer(haptic.period_s))
        except RunError as error:
            print(error)
    log = replay(read_tick_log("run.ticks"))
    assert_type(figures, RunStatistics)
    assert_type(figures.tick_us.median, float)
    assert_type(figures.to_dict()["tick_us"], dict[str, float])
    return figures.max_force_N + log.count_ticks_from_start()


def use_in_a_plant(
    builder: DiagramBuilder, plant: MultibodyPlant, scene_graph: SceneGraph
) -> HapticRendering:
    """A body of a plant that touches others by their true shapes."""
    rendering = AddHapticRendering(
        builder,
        plant,
        scene_graph,
        "die",
        contact=ContactParameters(stiffness_N_per_m=2e3),
        materials={"cup": Material(stiffness_N_per_m=500.0)},
        effects=Effects(
            shading=ShadingParameters(),
            friction=FrictionParameters(),
            braking=BrakingParameters(),
        ),
    )
    AddAppliedSpatialForce(
        builder, plant, rendering.GetOutputPort("applied_spatial_force")
    )
    assert_type(rendering.tool.name, str)
    return rendering


print(__version__.split("."), get_include().upper(), Still().url)
print(AddHapticLoop.__doc__, ConnectMovingObject.__doc__, use_in_a_plant.__doc__)
port, _ = make_device_port(Still(), period_s=1e-3, max_force_N=1.0, max_torque_Nm=0.1)
assert_type(port, HapticDevice)
print(use_geometry(Path("cup.obj")), use_a_scene("cup_spoon"))


def configure_a_plant(
    builder: DiagramBuilder, plant: MultibodyPlant, scene_graph: SceneGraph
) -> HapticRendering:
    """The same by a configuration, from a file or in code."""
    config = load_haptic_rendering_config("rendering.yaml")
    assert_type(config, HapticRenderingConfig)
    config.X_HT = Pose(position_m=[0.0, 0.0, 0.1])
    return ApplyHapticRenderingConfig(config, builder, plant, scene_graph)


def make_a_scene() -> Scene:
    """A scene that is made in code, all of whose parts have types."""
    up = Waypoint(time_s=0.0, position_m=[0.0, 0.0, 0.1])
    return Scene(
        tool=Tool(mesh="pen.obj"),
        environment=[EnvironmentObject(name="cup", mesh="cup.obj")],
        device=DeviceParameters(twin=DeviceImperfections()),
        hand=HandParameters(grip="firm", path=HandPathParameters(waypoints=[up])),
        effects=Effects(passivity=PassivityParameters()),
    )


def use_devices(scene: Scene) -> list[DeviceBackend]:
    """Each device by its class."""
    assert_type(list_device_presets(), dict[str, Path])
    preset: DevicePreset = load_device_preset(scene.device.preset)
    force_N, torque_Nm = preset.max_force_N, preset.max_torque_Nm
    udp = UdpDevice("127.0.0.1", 7400, max_force_N=force_N, max_torque_Nm=torque_Nm)
    assert_type(wait_for_reading(udp), DeviceReading)
    meshcat = start_meshcat()
    mouse = MouseDevice(
        meshcat,
        X_WB=RigidTransform(),
        X_BH=RigidTransform(),
        workspace_radius_m=preset.workspace_radius_m,
        max_force_N=force_N,
        max_torque_Nm=torque_Nm,
    )
    sliders = MeshcatDevice(
        meshcat, X_WB=RigidTransform(), X_BH=RigidTransform(), workspace_radius_m=0.1
    )
    configure_camera(meshcat, BuildHapticDiagram(scene, meshcat=meshcat, device=mouse))
    return [udp, mouse, sliders, HaplyDevice(max_force_N=2.0), LcmDevice.open()]


def drive_and_log(
    builder: DiagramBuilder, arm: System, loop: HapticLoop, recorder: TickRecorder
) -> HapticCommandReceiver:
    """An arm as a device on LCM, and a log of a loop."""
    AddTickLog(builder, loop, recorder, period_s=1e-3)
    return AddLcmDriver(
        builder, arm, DrakeLcm(), period_s=1e-3, max_force_N=8.5, max_torque_Nm=0.2
    )


def calc_stiffness(handle: HeldHandle) -> float:
    """The closed-form bounds, N/m."""
    passive_N_per_m = calc_passive_stiffness(handle.damping_Ns_per_m, 2.0, 1e-3)
    return min(passive_N_per_m, calc_stable_stiffness(1.0, 2.0, 1e-3, delay_s=1e-3))


class Spheres(OutsideLibrary):
    """A library of a user's own, for the benchmark."""

    name = "spheres"
    version = "1"

    def __init__(
        self, A_vertices: NDArray[np.float64], B_vertices: NDArray[np.float64]
    ):
        """Takes both hulls."""

    def query(self, X_WA: NDArray[np.float64]) -> OutsideContact:
        """Returns the contact."""
        return OutsideContact(0.1, np.zeros(3), np.zeros(3), np.zeros(3))
