"""A tool that falls on a table much wider than itself gains no energy."""

import numpy as np
import pytest
from mesh_samples import real_mesh
from plant_scenes import G, over_a_slab
from pydrake.geometry import Mesh
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics import ContactParameters, load_mesh

MASS_KG = 0.3


# N·s/m. Sampling at 1 kHz makes K T / 2 of them, 1.5.
@pytest.mark.parametrize("damping", [2.0, 20.0])
@pytest.mark.parametrize("name", ["cup_500.obj", "hammer_1692.obj", "torus_2000.obj"])
def test_a_tool_that_falls_on_a_table_gains_no_energy(name, damping):
    """Pressed at the table's far rims, it left with the energy of a kilojoule, once."""
    path = real_mesh(name)
    R_WT = RollPitchYaw(0.3, 0.2, 0.0).ToRotationMatrix()
    lowest = (load_mesh(path).vertices @ R_WT.matrix().T)[:, 2].min()
    scene = over_a_slab(Mesh(str(path)), mass=MASS_KG)
    contact = ContactParameters(stiffness_N_per_m=3e3, damping_Ns_per_m=damping)
    scene.render(contact=contact)
    scene.start(tool=RigidTransform(R_WT, [0, 0, 0.003 - lowest]))
    energy_J = []
    for time in np.linspace(0.0, 1.0, 51):
        scene.simulator.AdvanceTo(time)
        held_J = MASS_KG * G * scene.pose("tool").translation()[2]
        energy_J.append(scene.plant.CalcKineticEnergy(scene.context) + held_J)
    assert np.min(np.diff(energy_J)) < -1e-3  # it has met the table
    assert np.max(energy_J) < energy_J[0] + 1e-4
