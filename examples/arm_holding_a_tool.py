"""A robot arm lowers a pen into a ring and leans it on the inside, in your own plant.

    python examples/arm_holding_a_tool.py [--meshcat]

Drake's point contact takes the convex hull of a mesh: the ring would have no hole. Here
`AddHapticRendering` gives pen and ring their true shapes. The diagram is linearized
where the arm comes to rest, free and against the ring, to tell what contact changes.
"""

import argparse

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlantConfig
from pydrake.systems.analysis import Simulator
from pydrake.systems.controllers import JointStiffnessController
from pydrake.systems.framework import DiagramBuilder
from pydrake.visualization import AddDefaultVisualization

from drake_haptics import AddHapticRendering, ContactParameters, find_mesh
from drake_haptics.analysis import find_equilibrium, find_modes, linearize_sampled

parser = argparse.ArgumentParser(description="An arm leans a pen on a ring.")
parser.add_argument("--meshcat", action="store_true", help="show it in the browser")
is_shown = parser.parse_args().meshcat
# A ring that is fixed, and an arm whose two links turn about z; it moves a pen along z.
MODEL = f"""
<mujoco model="arm_and_ring">
  <asset>
    <mesh name="pen" file="{find_mesh("pen")}"/>
    <mesh name="torus" file="{find_mesh("torus")}"/>
  </asset>
  <worldbody>
    <geom type="mesh" mesh="torus"/>
    <body name="upper_arm" pos="-0.2 0 0.2">
      <joint name="shoulder" axis="0 0 1"/>
      <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0" mass="1"/>
      <body name="forearm" pos="0.2 0 0">
        <joint name="elbow" axis="0 0 1"/>
        <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0" mass="0.5"/>
        <body name="pen" pos="0.2 0 -0.17">
          <joint name="lift" type="slide" axis="0 0 1"/>
          <geom type="mesh" mesh="pen" mass="0.05"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="shoulder"/> <motor joint="elbow"/> <motor joint="lift"/>
  </actuator>
</mujoco>"""

# Build. Drake linearizes a discrete plant only if its output ports are not sampled.
builder = DiagramBuilder()
config = MultibodyPlantConfig(time_step=1e-3, use_sampled_output_ports=False)
plant, scene_graph = AddMultibodyPlant(config, builder)
Parser(plant).AddModelsFromString(MODEL, "xml")
plant.Finalize()
rendering = AddHapticRendering(
    builder, plant, scene_graph, "pen", contact=ContactParameters(stiffness_N_per_m=5e3)
)
controller = builder.AddSystem(
    JointStiffnessController(plant, kp=[20.0, 10.0, 200.0], kd=[2.0, 1.0, 5.0])
)
builder.Connect(plant.get_state_output_port(), controller.get_input_port(0))
builder.Connect(controller.get_output_port(), plant.get_actuation_input_port())
builder.ExportInput(controller.get_input_port(1), "goal")
if is_shown:
    AddDefaultVisualization(builder, meshcat := Meshcat())
diagram = builder.Build()

# Simulate, from above the ring on.
simulator = Simulator(diagram)
root = simulator.get_mutable_context()
above = np.array([np.pi / 3, -2 * np.pi / 3, 0.0])
plant.SetPositions(plant.GetMyMutableContextFromRoot(root), above)
if is_shown:
    simulator.set_target_realtime_rate(1.0)
    input(f"Open {meshcat.web_url()} and press Enter here.")
for name, change in [
    ("Down through the hole", [0.0, 0.0, -0.06]),
    ("Shoulder turned against the ring", [0.1, 0.0, -0.06]),
]:
    goal = np.concatenate([above + change, np.zeros(3)])
    diagram.GetInputPort("goal").FixValue(root, goal)
    simulator.AdvanceTo(root.get_time() + 1.0)

    # Print where it comes to rest, and how it would come back to it.
    rest = find_equilibrium(diagram, root).context
    context = rendering.GetMyContextFromRoot(rest)
    x, y, z = 1e3 * rendering.GetOutputPort("X_WT").Eval(context)[4:]
    force_N = np.linalg.norm(rendering.GetOutputPort("F_To_W").Eval(context)[3:])
    print(
        f"{name}: tip at ({x:.2f}, {y:.2f}, {z:.2f}) mm, pushed with {force_N:.2f} N."
    )
    print("Its motions, the slowest first:")
    for mode in find_modes(linearize_sampled(diagram, rest)):
        print(f"  {mode.describe()}")
