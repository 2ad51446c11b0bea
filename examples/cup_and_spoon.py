"""A spoon in a cup, in the browser: the whole loop from a scene file.

    python examples/cup_and_spoon.py [SECONDS]

Without SECONDS it runs until Ctrl-C.
"""

import sys

from drake_haptics.builder import BuildHapticDiagram
from drake_haptics.scene import load_scene
from drake_haptics.scene_library import find_scene
from drake_haptics.simulation import run
from drake_haptics.stage import open_meshcat, set_stage
from drake_haptics.tick_clock import TickClock

meshcat = open_meshcat()
haptic = BuildHapticDiagram(load_scene(find_scene("cup_spoon")), meshcat=meshcat)
set_stage(meshcat, haptic)
print(f"Open {meshcat.web_url()}; Ctrl-C ends.")
duration_s = float(sys.argv[1]) if len(sys.argv) > 1 else None
figures = run(haptic, duration_s, pace=TickClock(haptic.period_s)).to_dict()
print(f"Largest force {figures['max_force_N']:.2f} N, on the device's display.")
