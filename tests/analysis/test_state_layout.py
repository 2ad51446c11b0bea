"""What each number of a diagram's state is."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (
    PrismaticJoint,
    QuaternionFloatingJoint,
    SpatialInertia,
)
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LinearSystem
from wall_loop import make_mass, make_wall

from drake_haptics.analysis.diagram_systems import calc_path, find_state_layout
from drake_haptics.analysis.sampled_map import get_state, set_state
from drake_haptics.common.subsystems import walk_leaves


def make_plant(time_step, *names):
    plant = MultibodyPlant(time_step)
    slider = plant.AddRigidBody("slider", SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    plant.AddJoint(
        PrismaticJoint("x", plant.world_frame(), slider.body_frame(), [1, 0, 0])
    )
    for name in names:
        plant.AddRigidBody(name, SpatialInertia.SolidSphereWithMass(0.1, 0.02))
    plant.Finalize()
    return plant


def make_nested():
    """Discrete systems before continuous ones, one level down."""
    inner = DiagramBuilder()
    inner.AddNamedSystem("wall", make_wall(900.0))
    inner.AddNamedSystem("bodies", make_plant(0.0, "tool", "cup"))
    arm = inner.Build()
    arm.set_name("arm")
    builder = DiagramBuilder()
    builder.AddSystem(arm)
    builder.AddNamedSystem("mass", make_mass())
    builder.AddNamedSystem("sampled", make_plant(1e-3, "pen"))
    return builder.Build()


def test_names_are_in_the_order_of_the_state():
    diagram = make_nested()
    layout = find_state_layout(diagram)
    context = diagram.CreateDefaultContext()
    assert len(layout.names) == len(get_state(context)) == len(set(layout.names))
    # Each place of the state is that of the system that its name names.
    for i, name in enumerate(layout.names):
        x = np.zeros(len(layout.names))
        x[i] = 1.0
        set_state(context, x)
        holders = [
            calc_path(diagram, leaf)
            for leaf in walk_leaves(diagram)
            if get_state(leaf.GetMyContextFromRoot(context)).any()
        ]
        assert holders == [name.rpartition("/")[0]]
    assert layout.names[0] == "arm/bodies/x_x"
    assert layout.names.index("mass/xc[1]") < layout.names.index("arm/wall/xd[0]")


def test_quaternions_are_where_a_new_context_has_ones():
    diagram = make_nested()
    layout = find_state_layout(diagram)
    x = get_state(diagram.CreateDefaultContext())
    assert len(set(layout.quaternions)) == 3
    for places in layout.quaternions:
        np.testing.assert_array_equal(x[list(places)], [1.0, 0.0, 0.0, 0.0])
        assert [layout.names[i][-3:] for i in places] == ["_qw", "_qx", "_qy", "_qz"]


def test_a_joint_of_the_users_own_has_a_quaternion_too():
    plant = MultibodyPlant(0.0)
    inertia = SpatialInertia.SolidSphereWithMass(1.0, 0.1)
    first, second = (plant.AddRigidBody(name, inertia) for name in ("a", "b"))
    joint = QuaternionFloatingJoint("any", first.body_frame(), second.body_frame())
    plant.AddJoint(joint)
    plant.Finalize()
    assert len(find_state_layout(plant).quaternions) == 2


def test_a_system_alone_has_no_path():
    assert find_state_layout(make_mass()).names == ("xc[0]", "xc[1]")
    assert find_state_layout(make_plant(0.0)).names == ("x_x", "x_v")


def test_a_system_without_state_has_no_names():
    gain = LinearSystem(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), [[2.0]])
    assert find_state_layout(gain).names == ()
