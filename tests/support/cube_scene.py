"""A cube over a slab in a plant, with haptic rendering."""

from plant_scenes import PLANTS, over_a_slab
from pydrake.geometry import Box

from drake_haptics.scene.schema import ContactParameters

HALF, MASS, G = 0.02, 0.1, 9.81
CUBE = Box(2 * HALF, 2 * HALF, 2 * HALF)
CONTACT = ContactParameters(stiffness_N_per_m=1e3, damping_Ns_per_m=3.0)


def make_scene(*, cart=False, config=PLANTS["sampled"], gravity=G, **options):
    names = ("tool", "cart") if cart else ("tool",)
    scene = over_a_slab(CUBE, *names, config=config, gravity=gravity)
    rendering = scene.render(**{"contact": CONTACT, **options})
    return scene, rendering
