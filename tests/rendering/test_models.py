"""Haptic rendering in models that people have: directives, SDF, URDF, MJCF, arms."""

import numpy as np
import pytest
import trimesh
from plant_scenes import PLANTS, G, PlantScene
from pydrake.geometry import Meshcat
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.tree import JacobianWrtVariable
from pydrake.visualization import AddDefaultVisualization

from drake_haptics.scene.schema import ContactParameters

K = 2e3
CONTACT = ContactParameters(stiffness_N_per_m=K, damping_Ns_per_m=5.0)
DRAKE = "package://drake/examples"
TABLE = (
    f"{DRAKE}/kuka_iiwa_arm/models/table/"
    "extra_heavy_duty_table_surface_only_collision.sdf"
)
CYLINDER = f"{DRAKE}/kuka_iiwa_arm/models/objects/simple_cylinder.urdf"
BLOCK = f"{DRAKE}/kuka_iiwa_arm/models/objects/block_for_pick_and_place.urdf"
ARM = f"""
directives:
- add_model: {{name: gripper, file: {DRAKE}/planar_gripper/planar_gripper.sdf}}
- add_weld: {{parent: world, child: gripper::finger1_base}}
- add_weld: {{parent: world, child: gripper::finger2_base}}
- add_weld: {{parent: world, child: gripper::finger3_base}}
- add_model: {{name: pen, file: "file://PEN"}}
- add_weld:
    parent: gripper::finger1_tip_link
    child: pen::pen
    X_PC: {{translation: [0, 0, -0.03]}}
- add_model: {{name: table, file: {TABLE}}}
- add_weld:
    parent: world
    child: table::link
    X_PC: {{translation: [0, 0, HEIGHT]}}
"""
PEN = """
<sdf version="1.7"><model name="pen"><link name="pen">
  <inertial><mass>0.02</mass><inertia>
    <ixx>4e-6</ixx><iyy>4e-6</iyy><izz>4e-6</izz></inertia></inertial>
  <collision name="tip"><geometry><mesh><uri>pen.obj</uri></mesh></geometry></collision>
</link></model></sdf>
"""
# The top of the table above its frame.
TABLE_TOP = 0.736 + 0.057 / 2


def render(scene, tool, **options):
    return scene.render(tool, **{"contact": CONTACT, **options})


def weld(scene, body, X_WB):
    frame = scene.plant.GetBodyByName(body).body_frame()
    scene.plant.WeldFrames(scene.plant.world_frame(), frame, X_WB)


@pytest.fixture(params=PLANTS)
def scene(request):
    return PlantScene(PLANTS[request.param])


@pytest.mark.parametrize(
    ("model", "tool", "mass", "half_height"),
    # The block stands on small balls at its corners.
    [(CYLINDER, "cylinder_base", 0.088, 0.065), (BLOCK, "base_link", 0.1, 0.1)],
)
def test_an_object_that_drake_ships_stands_on_a_table(
    scene, model, tool, mass, half_height
):
    parser = Parser(scene.plant)
    parser.AddModels(url=TABLE)
    parser.AddModels(url=model)
    weld(scene, "link", RigidTransform())
    rendering = render(scene.finalize(), tool)
    rest = TABLE_TOP + half_height + CONTACT.tolerance_m - mass * G / K
    scene.start(**{tool: RigidTransform([0.02, 0.01, rest + 1e-4])})
    scene.simulator.AdvanceTo(1.0)
    assert scene.pose(tool).translation()[2] == pytest.approx(rest, abs=2e-5)
    F = scene.read(rendering, "F_To_W")
    np.testing.assert_allclose(F[3:], [0, 0, mass * G], atol=1e-2)


def add_arm(scene, folder, height):
    """Adds a finger of Drake's planar gripper with a pen on its tip, over a table.

    Args:
        scene: Gets the models.
        folder: For the pen's files.
        height: Of the table's top, m.
    """
    pen = trimesh.creation.cone(0.004, 0.03, sections=12)
    pen.apply_transform(np.diag([1.0, -1.0, -1.0, 1.0]))
    pen.export(folder / "pen.obj")
    (folder / "pen.sdf").write_text(PEN)
    text = ARM.replace("PEN", str(folder / "pen.sdf"))
    text = text.replace("HEIGHT", str(height - TABLE_TOP))
    (folder / "arm.dmd.yaml").write_text(text)
    Parser(scene.plant).AddModels(str(folder / "arm.dmd.yaml"))
    return scene.finalize()


def start_arm(scene):
    """Starts with the finger bent."""
    scene.start()
    plant = scene.plant
    for joint, angle in [("finger1_BaseJoint", 0.3), ("finger1_MidJoint", 0.5)]:
        plant.GetJointByName(joint).set_angle(scene.context, angle)
    return scene


@pytest.mark.filterwarnings("ignore:Drake's own contact")
def test_an_arm_feels_its_tool_on_a_table_by_its_jacobian(scene, tmp_path):
    # A first one only says where the pen is.
    probe = start_arm(add_arm(PlantScene(), tmp_path, -1.0))
    lowest = (probe.pose("pen") @ np.array([0, 0, -0.03]))[2]
    add_arm(scene, tmp_path, lowest - 0.5e-3)
    rendering = render(scene, "pen", environment=["table::link"])
    start_arm(scene)
    plant, context, pen = scene.plant, scene.context, scene.plant.GetBodyByName("pen")
    F = scene.read(rendering, "F_To_W")
    assert F[5] == pytest.approx(1.5e-3 * K, rel=0.01)
    world = plant.world_frame()
    J = plant.CalcJacobianSpatialVelocity(
        context, JacobianWrtVariable.kV, pen.body_frame(), np.zeros(3), world, world
    )
    M = plant.CalcMassMatrix(context)
    torque = plant.CalcGravityGeneralizedForces(context) + J.T @ F
    if plant.time_step():
        # Drake damps joints implicitly.
        joints = [plant.get_joint(i) for i in plant.GetJointIndices()]
        for joint in joints:
            for k in range(joint.num_velocities()):
                i = joint.velocity_start() + k
                M[i, i] += plant.time_step() * joint.default_damping_vector()[k]
        scene.simulator.AdvanceTo(plant.time_step())
        vdot = plant.GetVelocities(context) / plant.time_step()
    else:
        vdot = scene.read(plant, "generalized_acceleration")
    finger = [
        plant.GetJointByName(name).velocity_start()
        for name in ("finger1_BaseJoint", "finger1_MidJoint")
    ]
    np.testing.assert_allclose((M @ vdot)[finger], torque[finger], rtol=1e-9)
    assert np.abs((J.T @ F)[finger]).min() > 1e-2


def test_what_is_in_the_way_of_a_welded_arm_is_not_its_own_neighbor(tmp_path):
    """Without a list, an arm's tool meets the table and the links it can reach."""
    scene = add_arm(PlantScene(), tmp_path, -1.0)
    rendering = render(scene, "pen")
    assert {item.name for item in rendering.objects} == {
        "link",
        "finger2_link2",
        "finger2_tip_link",
        "finger3_link2",
        "finger3_tip_link",
    }


MJCF = """
<mujoco model="peg">
  <worldbody>
    <geom name="floor" type="box" size="0.5 0.5 0.05" pos="0 0 -0.05"/>
    <body name="peg" pos="0 0 0.1">
      <freejoint/>
      <geom type="capsule" size="0.01 0.02" mass="0.1"/>
    </body>
  </worldbody>
</mujoco>
"""


def test_an_mjcf_capsule_rests_on_a_box_of_the_world(scene):
    Parser(scene.plant).AddModelsFromString(MJCF, ".xml")
    render(scene.finalize(), "peg", environment=["world"], chord_error_m=1e-5)
    rest = 0.03 + CONTACT.tolerance_m - 0.1 * G / K
    scene.start(peg=RigidTransform([0, 0, rest]))
    scene.simulator.AdvanceTo(0.05)
    assert scene.pose("peg").translation()[2] == pytest.approx(rest, abs=3e-5)


@pytest.mark.parametrize("first", ["rendering", "visualization"])
def test_it_goes_with_drakes_visualization_in_any_order(first):
    scene = PlantScene()
    parser = Parser(scene.plant)
    parser.AddModels(url=TABLE)
    parser.AddModels(url=CYLINDER)
    weld(scene, "link", RigidTransform())
    scene.finalize()
    meshcat = Meshcat()
    if first == "visualization":
        AddDefaultVisualization(scene.builder, meshcat)
    render(scene, "cylinder_base")
    if first == "rendering":
        AddDefaultVisualization(scene.builder, meshcat)
    rest = TABLE_TOP + 0.065 + CONTACT.tolerance_m - 0.088 * G / K
    scene.start(cylinder_base=RigidTransform([0, 0, rest]))
    scene.simulator.AdvanceTo(0.1)
    z = scene.pose("cylinder_base").translation()[2]
    assert z == pytest.approx(rest, abs=1e-5)
    assert meshcat.HasPath("/drake/illustration/simple_cylinder/cylinder_base")
