"""Makes a scene's contact softer, and prints largest force and penetration.

    python examples/softer_wall.py

Runs the peg in the torus with three contact stiffnesses. Coupling and contact are two
springs in a row: while the contact is the stiffer one, the hand hardly notices how
stiff it is; softer than the coupling, it lets the peg deep into the torus.
"""

from drake_haptics import BuildHapticDiagram, find_scene, load_scene, run

print("stiffness N/m   largest force N   penetration mm")
for stiffness_N_per_m in (2e4, 2e3, 5e2):
    scene = load_scene(find_scene("torus_peg"))
    scene.contact.stiffness_N_per_m = stiffness_N_per_m
    result = run(BuildHapticDiagram(scene), duration_s=2.0)
    print(
        f"{stiffness_N_per_m:13.0f} {result.max_force_N:17.2f}"
        f" {1e3 * result.max_penetration_m:16.3f}"
    )
