"""Each gain of a haptic rendering is held against its plant's explicit step."""

from dataclasses import replace

import pytest
from plant_scenes import PLANTS, PlantScene
from pydrake.geometry import Role, Sphere
from pydrake.multibody.tree import SpatialInertia

from drake_haptics.rendering.bodies import make_rendered_bodies
from drake_haptics.rendering.checks import check_rendering_stiffness
from drake_haptics.scene.schema import ContactParameters, CouplingParameters, Material

MASS, STEP = 0.1, 1e-3
LIMIT = 4 * MASS / STEP**2
SOFT = ContactParameters(stiffness_N_per_m=1e3, damping_Ns_per_m=0.0)
PLAIN = [Material(), Material()]


def make_case(config=PLANTS["sampled"]):
    """Returns a plant, a ball, and a slab and a ball that it meets.

    The balls are too heavy to turn, so that their mass is what a contact feels.
    """
    scene = PlantScene(config)
    for name in ("tool", "cart"):
        inertia = SpatialInertia.SolidSphereWithMass(MASS, 1e3)
        scene.touchable(scene.plant.AddRigidBody(name, inertia), Sphere(0.02))
    slab = scene.add_slab()
    plant = scene.finalize().plant
    tool, objects = make_rendered_bodies(
        plant,
        scene.scene_graph.model_inspector(),
        plant.GetBodyByName("tool"),
        [slab, plant.GetBodyByName("cart")],
        role=Role.kProximity,
        chord_error_m=1e-3,
        progress=None,
    )
    return plant, tool, objects


def test_soft_gains_are_silent():
    assert (
        check_rendering_stiffness(*make_case(), SOFT, PLAIN, CouplingParameters()) == []
    )


@pytest.mark.parametrize(
    ("stiffness", "found"),
    [(0.49 * LIMIT, []), (0.51 * LIMIT, ["cart"]), (1.01 * LIMIT, ["slab", "cart"])],
)
def test_bodies_that_both_give_way_hold_less(stiffness, found):
    """The apparent mass of two equal ones is half of one."""
    contact = replace(SOFT, stiffness_N_per_m=stiffness)
    sentences = check_rendering_stiffness(*make_case(), contact, PLAIN, None)
    assert len(sentences) == len(found)
    for sentence, name in zip(sentences, found, strict=True):
        assert sentence.startswith(f"contact of 'tool' with '{name}': stiffness")


def test_a_material_is_judged_by_its_own_gains():
    case, stiff = make_case(), Material(stiffness_N_per_m=1.01 * LIMIT)
    (sentence,) = check_rendering_stiffness(*case, SOFT, [stiff, Material()], None)
    assert "'slab'" in sentence
    # (4 m - 2 B h) / h² at its own damping.
    damped = Material(stiffness_N_per_m=0.6 * LIMIT, damping_Ns_per_m=100.0)
    (sentence,) = check_rendering_stiffness(*case, SOFT, [damped, Material()], None)
    assert f"{0.5 * LIMIT:.3g} N/m" in sentence


def test_a_coupling_is_judged_in_translation_and_in_rotation():
    case = make_case()
    inertia = 0.4 * MASS * 1e6
    for coupling, unit in [
        (CouplingParameters(stiffness_N_per_m=1.01 * LIMIT), "N/m"),
        (CouplingParameters(damping_Ns_per_m=201.0), "N/m"),
        (
            CouplingParameters(
                rotational_stiffness_Nm_per_rad=1.01 * 4 * inertia / STEP**2
            ),
            "N·m/rad",
        ),
    ]:
        (sentence,) = check_rendering_stiffness(*case, SOFT, PLAIN, coupling)
        assert sentence.startswith("coupling of 'tool'")
        assert f" {unit} with damping" in sentence


def test_a_continuous_plant_has_no_limit():
    case = make_case(PLANTS["continuous"])
    stiff = replace(SOFT, stiffness_N_per_m=100 * LIMIT)
    assert check_rendering_stiffness(*case, stiff, PLAIN, CouplingParameters()) == []
