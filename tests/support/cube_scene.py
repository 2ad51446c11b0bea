"""A cube over a slab in a plant, with haptic rendering."""

from plant_scenes import PLANTS, PlantScene
from pydrake.geometry import Box

from drake_haptics import AddHapticRendering
from drake_haptics.scene.schema import ContactParameters

HALF, MASS, G = 0.02, 0.1, 9.81
CUBE = Box(2 * HALF, 2 * HALF, 2 * HALF)
CONTACT = ContactParameters(stiffness_N_per_m=1e3, damping_Ns_per_m=3.0)


def make_scene(*, cart=False, config=PLANTS["sampled"], gravity=G, **options):
    scene = PlantScene(config)
    scene.add("tool", CUBE, mass=MASS)
    if cart:
        scene.add("cart", CUBE)
    scene.add_slab()
    scene.finalize(gravity)
    rendering = AddHapticRendering(
        scene.builder,
        scene.plant,
        scene.scene_graph,
        "tool",
        **{"contact": CONTACT, **options},
    )
    return scene, rendering
