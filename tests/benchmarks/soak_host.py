"""The host of a soak, as a program that can be paused and killed.

    python tests/benchmarks/soak_host.py SCENE ADDRESS

Runs the scene on the device until Ctrl-C, and then prints its figures as JSON.
Whenever the device is at fault it takes it up again by the documented step,
`DeviceBackend.recover`, half a second later.
"""

import json
import signal
import sys
import time
from contextlib import suppress

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.open_device import open_device
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.simulation.device_monitor import DeviceWatch
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics

# Some people are slower to see that the force is gone.
PATIENCE_S = 0.5


class Person:
    """Wants a device back some time after it went to fault."""

    def __init__(self):
        self._since_s = None

    def should_recover(self):
        """Asked in every tick of a fault, until yes."""
        now_s = time.monotonic()
        if self._since_s is None:
            self._since_s = now_s
        if now_s < self._since_s + PATIENCE_S:
            return False
        self._since_s = None
        return True


def main():
    """Runs the scene."""
    # A shell's background job is born deaf to Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    scene = load_scene(find_scene(sys.argv[1]))
    with open_device(sys.argv[2], scene, None) as backend:
        haptic = BuildHapticDiagram(scene, device=backend)
        watch = DeviceWatch(backend, Person().should_recover)
        pace = RealTimePacer(haptic.period_s)
        statistics = RunStatistics(haptic.period_s, pace=pace)
        with suppress(KeyboardInterrupt):
            run(haptic, pace=pace, on_tick=watch.end_tick, statistics=statistics)
        figures = {**statistics.to_dict(), "device": watch.to_dict()}
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
