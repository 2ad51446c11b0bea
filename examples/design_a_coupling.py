"""Designs a coupling: linearizes the loop at a contact, and compares two couplings.

    python examples/design_a_coupling.py

The spoon rests on the cup's wall. The loop of device, hand, coupling, spoon and cup is
linearized there by AutoDiff, once with the scene's coupling and once with one that is
designed for device and rate alone.
"""

from drake_haptics import find_scene, load_scene
from drake_haptics.analysis import (
    analyze_held_scene,
    find_modes,
    hold_scene,
    suggest_coupling,
)

scene = load_scene(find_scene("cup_spoon"))
# The hand goes along its path until the wall is pressed most, and stops there.
held = hold_scene(scene)
print(f"The hand stops at {held.time_s:.3f} s.\n")

design = suggest_coupling(scene.device.preset, scene.device.rate_hz)
print(design.describe(), "\n")

for name, coupling in [("the scene's", scene.coupling), ("designed", design.coupling)]:
    loop = analyze_held_scene(held, coupling)
    slowest = find_modes(loop.linearization)[0]
    print(
        f"{name} coupling, {coupling.stiffness_N_per_m:.0f} N/m and"
        f" {coupling.damping_Ns_per_m:.1f} N·s/m: a disturbance is multiplied by"
        f" {loop.growth:.5f} in each tick; {slowest.describe()}"
    )
