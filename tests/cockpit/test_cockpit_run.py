"""A run with a page of its own: it is seen, and its end is told, whatever that is."""

import json

import pytest
import websocket
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate

from drake_haptics.cockpit.cockpit_run import CockpitRun
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.device.backend import GateState
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.simulation.run import RunError
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.web.link import open_page_port

BOUND_S = 120.0
ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return over_a_plate(tmp_path_factory.mktemp("scene"), [ABOVE])


def read_all(page):
    """Returns all that a page is told, by name, until the end."""
    told = {}
    while text := page.recv():
        [(name, body)] = json.loads(text).items()
        told.setdefault(name, []).append(body)
    return told


@pytest.mark.parametrize("fails", [False, True])
def test_it_is_seen_until_its_end_which_is_told(scene, meshcat, fails):
    shown = CockpitRun(scene, meshcat, open_page_port(), name="plate", device="mouse:")
    page = websocket.create_connection(shown.url.replace("http", "ws"), timeout=BOUND_S)
    mouse = shown.backend
    haptic = BuildHapticDiagram(scene, device=mouse)
    pace = RealTimePacer(haptic.period_s)
    statistics = RunStatistics(haptic.period_s, pace)
    ran = []

    def end_tick(context):
        if fails and context.get_time() > 0.2:
            raise FloatingPointError("the tool is lost")

    def run():
        shown.run(
            haptic,
            0.3,
            pace=pace,
            statistics=statistics,
            energy=False,
            on_begin=ran.append,
            on_tick=end_tick,
        )

    if fails:
        with pytest.raises(RunError):
            run()
        # Nobody need see to it: no force stays on.
        assert mouse.gate is GateState.IDLE
    else:
        run()
        shown.close()
    told = read_all(page)
    shown.close()
    assert ran == [haptic]
    assert told["hello"][0]["scene"] == "plate"
    assert told["state"][0]["handle"] == "mouse"
    assert [frame["drives"] for frame in told["frame"]][-1] is True
    [over] = told["over"]
    assert over["why"].startswith("The run stopped" if fails else "The run has ended.")
    assert ("the tool is lost" in over["why"]) == fails


def test_a_device_that_is_not_available_leaves_nothing_open(scene, meshcat):
    listener = open_page_port()
    port = listener.getsockname()[1]
    with pytest.raises(HapticsError, match="give udp"):
        CockpitRun(scene, meshcat, listener, name="plate", device="tin:can")
    open_page_port(port).close()
