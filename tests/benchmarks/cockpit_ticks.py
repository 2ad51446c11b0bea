"""Measures whether the cockpit delays ticks: to be run on a quiet machine.

python tests/benchmarks/cockpit_ticks.py [SCENE]

Needs Chromium; a minute. The same scene runs at the pace of a clock, in turns

* without a page;
* with the page open in a browser;
* with a slider of it being dragged, so that a value is written some 60 times a second.

Chromium draws without a graphics processor here, on the cores that the loop runs on:
it takes more from the loop than the browser of somebody who looks at it.
"""

from __future__ import annotations

import sys
from collections import Counter
from contextlib import closing
from pathlib import Path
from typing import Any

from pydrake.systems.framework import Context

from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.systems.output.haptic_visualizer import HapticVisualizer
from drake_haptics.visualization.meshcat import configure_camera, start_meshcat
from drake_haptics.web.link import open_page_port

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
from headless_browser import HeadlessBrowser, find_browser

KINDS = ("without a page", "with the page", "slider dragged")
_TURNS = 2
_WARM_UP_S, _MEASURED_S = 2.0, 6.0
# Counts pictures of the page; moves the first slider up and down.
_COUNT = """
  window.drawn = 0;
  const count = () => { drawn += 1; requestAnimationFrame(count); };
  count();
"""
_DRAG = """
  window.dragged = 0;
  setInterval(() => {
    const slider = document.querySelector("#coupling input[type=range]");
    if (!slider) return;
    dragged += 1;
    slider.value = 500 + 100 * Math.sin(0.02 * dragged);
    slider.dispatchEvent(new Event("input"));
  }, 16);
"""


class Book:
    """What was measured of a kind of run, in all turns."""

    def __init__(self, period_s: float):
        self.pace = RealTimePacer(period_s)
        self.statistics = RunStatistics(period_s, self.pace)
        self.counts: Counter[str] = Counter()


def run_without(scene: Scene, book: Book) -> None:
    """Runs a scene that nobody sees."""
    haptic = BuildHapticDiagram(scene)
    run(haptic, _WARM_UP_S, pace=RealTimePacer(haptic.period_s))
    book.pace.pause()
    run(haptic, _MEASURED_S, pace=book.pace, statistics=book.statistics)


def run_with_page(scene: Scene, book: Book, executable: str, drags: bool) -> None:
    """Runs a scene with its page in a browser."""
    meshcat = start_meshcat()
    haptic = BuildHapticDiagram(scene, meshcat=meshcat)
    configure_camera(meshcat, haptic)
    shown = CockpitRun(scene, meshcat, open_page_port(), name="measured")
    with closing(shown), HeadlessBrowser(executable) as browser:
        browser.open(shown.url)
        browser.evaluate(_COUNT)
        if drags:
            browser.evaluate(_DRAG)
        options: dict[str, Any] = {
            "energy": False,
            "on_begin": lambda haptic: None,
            "on_tick": lambda context: None,
        }
        warm = RealTimePacer(haptic.period_s)
        unread = RunStatistics(haptic.period_s, warm)
        shown.run(haptic, _WARM_UP_S, pace=warm, statistics=unread, **options)
        before = count(browser)
        book.pace.pause()
        shown.run(
            haptic, _MEASURED_S, pace=book.pace, statistics=book.statistics, **options
        )
        book.counts.update(count(browser))
        book.counts.subtract(before)
        if browser.errors:
            raise RuntimeError(f"the page complains: {browser.errors}")


_frames_drawn = 0


def count_frames() -> None:
    """Counts the frames of the scene that the loop draws, from now on."""
    begin = HapticVisualizer._begin

    def counted(self: HapticVisualizer, context: Context) -> bool:
        global _frames_drawn
        draws = begin(self, context)
        _frames_drawn += draws
        return draws

    HapticVisualizer._begin = counted


def count(browser: HeadlessBrowser) -> Counter[str]:
    """Returns what was drawn and dragged so far."""
    page = browser.evaluate("[drawn, window.dragged ?? 0]")
    return Counter(scene=_frames_drawn, page=page[0], values=page[1])


def main() -> None:
    """Prints a row for each kind."""
    executable = find_browser()
    if executable is None:
        sys.exit("chromium is not installed")
    scene = load_scene(find_scene(sys.argv[1] if len(sys.argv) > 1 else "cup_spoon"))
    books = {kind: Book(1.0 / scene.device.rate_hz) for kind in KINDS}
    count_frames()
    for _ in range(_TURNS):
        run_without(scene, books[KINDS[0]])
        run_with_page(scene, books[KINDS[1]], executable, False)
        run_with_page(scene, books[KINDS[2]], executable, True)
    print(
        "| µs | tick, median | p99 | p99.9 | late, median | p99 | p99.9 | ticks skipped"
        " | pictures of the scene per s | of the page per s | values set per s |\n"
        f"| --- |{' --: |' * 10}"
    )
    for kind, book in books.items():
        figures: Any = book.statistics.to_dict()
        tick, late = figures["tick_us"], figures["lateness_us"]
        times = [
            *(tick["median"], tick["p99"], tick["p99_9"]),
            *(late["p50"], late["p99"], late["p99_9"], late["skipped"]),
        ]
        rates = [
            book.counts[name] / (_TURNS * _MEASURED_S)
            for name in ("scene", "page", "values")
        ]
        cells = [f"{value:.0f}" for value in (*times, *rates)]
        print(f"| {kind} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
