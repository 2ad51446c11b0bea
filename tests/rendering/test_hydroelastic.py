"""Drake's hydroelastic contact between other bodies acts beside haptic contact."""

from __future__ import annotations

import pytest
from plant_scenes import PLANTS, RUBBER, G, PlantScene
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Box,
    ProximityProperties,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import ContactModel
from pydrake.multibody.tree import SpatialInertia

from drake_haptics.scene.schema import ContactParameters

MASS, SIDE_M = 0.1, 0.04
CONTACT = ContactParameters(stiffness_N_per_m=2e3, damping_Ns_per_m=5.0)


@pytest.mark.parametrize("plant", ["sampled", "unsampled"])
def test_a_tool_stands_on_a_body_that_lies_on_hydroelastic_contact(plant):
    """The tool's weight goes through both contacts; no pair meets twice."""
    scene = PlantScene(PLANTS[plant])
    scene.plant.set_contact_model(ContactModel.kHydroelastic)
    soft, hard = ProximityProperties(), ProximityProperties()
    AddContactMaterial(dissipation=5.0, friction=RUBBER, properties=soft)
    AddCompliantHydroelasticProperties(0.5 * SIDE_M, 1e6, soft)
    AddContactMaterial(friction=RUBBER, properties=hard)
    AddRigidHydroelasticProperties(1.0, hard)
    slab = scene.plant.AddRigidBody("slab", SpatialInertia.SolidCubeWithDensity(1, 1))
    scene.plant.WeldFrames(scene.plant.world_frame(), slab.body_frame())
    scene.plant.RegisterCollisionGeometry(
        slab, RigidTransform([0, 0, -0.05]), Box(1.0, 1.0, 0.1), "slab", hard
    )
    cushion = scene.add("cushion", mass=MASS, side=SIDE_M)
    cube = Box(SIDE_M, SIDE_M, SIDE_M)
    scene.plant.RegisterCollisionGeometry(
        cushion, RigidTransform(), cube, "cushion", soft
    )
    # The tool has hydroelastic properties too: haptic contact takes their place.
    tool = scene.add("tool", mass=MASS, side=SIDE_M)
    scene.plant.RegisterCollisionGeometry(tool, RigidTransform(), cube, "tool", hard)
    scene.finalize()
    rendering = scene.render(contact=CONTACT)
    above_m = SIDE_M + CONTACT.tolerance_m - MASS * G / CONTACT.stiffness_N_per_m
    scene.start(
        cushion=RigidTransform([0.0, 0.0, SIDE_M / 2.0]),
        tool=RigidTransform([0.0, 0.0, SIDE_M / 2.0 + above_m]),
    )
    scene.simulator.AdvanceTo(0.5)
    found = scene.read(scene.plant, "contact_results")
    assert found.num_point_pair_contacts() == 0
    assert found.num_hydroelastic_contacts() == 1
    surface = found.hydroelastic_contact_info(0)
    assert abs(surface.F_Ac_W().translational()[2]) == pytest.approx(
        2.0 * MASS * G, rel=1e-3
    )
    assert scene.read(rendering, "F_To_W")[5] == pytest.approx(MASS * G, rel=1e-3)
    apart_m = (scene.pose("tool").translation() - scene.pose("cushion").translation())[
        2
    ]
    assert apart_m == pytest.approx(above_m, abs=1e-6)
