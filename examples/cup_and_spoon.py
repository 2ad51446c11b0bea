"""A spoon in a cup, in the browser: the whole loop from a scene file, paced by a clock.

    python examples/cup_and_spoon.py [SECONDS]

Without SECONDS it runs until Ctrl-C. In the end it tells what the hand has felt and
whether the loop has kept to the clock.
"""

import argparse
from contextlib import suppress

from drake_haptics import (
    BuildHapticDiagram,
    RealTimePacer,
    RunStatistics,
    configure_camera,
    find_scene,
    load_scene,
    run,
    start_meshcat,
)

parser = argparse.ArgumentParser(description="A spoon in a cup, in the browser.")
parser.add_argument("seconds", nargs="?", type=float, help="without it, until Ctrl-C")
duration_s = parser.parse_args().seconds
meshcat = start_meshcat()
haptic = BuildHapticDiagram(load_scene(find_scene("cup_spoon")), meshcat=meshcat)
configure_camera(meshcat, haptic)
print(f"Open {meshcat.web_url()}; Ctrl-C ends.")
clock = RealTimePacer(haptic.period_s)
statistics = RunStatistics(haptic.period_s, pace=clock)
with suppress(KeyboardInterrupt):
    run(haptic, duration_s, pace=clock, statistics=statistics)
print(f"Largest force {statistics.max_force_N:.2f} N, on the device's display.")
median_us = statistics.tick_us.median
print(
    f"{statistics.ticks} ticks of {median_us:.0f} µs; {clock.skipped} lost to stalls."
)
