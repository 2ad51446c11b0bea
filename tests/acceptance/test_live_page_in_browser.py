"""A page that is open while the loop draws shows things at their size."""

import time

import numpy as np
import pytest
from headless_browser import HeadlessBrowser
from pydrake.geometry import Rgba
from pydrake.math import RigidTransform
from visualizer_rig import MAX_TORQUE_NM, X_WH, make_context, make_mesh, make_visualizer

from drake_haptics.systems.output.meshcat_shapes import ArrowPool, MovingParts
from drake_haptics.visualization.meshcat import start_meshcat

LENGTH_M = 0.02
# Length of the column of the world matrix along the arrow: its scale on the page.
SCALE = """(() => {
  const arrow = viewer.scene_tree.find(['arrows', '0', 'arrow', '0']).object;
  viewer.scene_tree.object.updateMatrixWorld(true);
  const m = arrow.matrixWorld.elements;
  return Math.hypot(m[8], m[9], m[10]);
})()"""


@pytest.mark.parametrize("early", [True, False])
def test_arrows_keep_their_size_however_they_move(chromium, early):
    """Whether the page was open from the start or came to a loop that runs."""
    meshcat = start_meshcat()
    pool = ArrowPool(MovingParts(meshcat), "/arrows", 1, [Rgba(1, 0, 0)])

    def draw(x):
        vector = np.array([[0, 0, LENGTH_M]])
        list(pool.draw([0], np.array([[x, 0, 0]]), vector, [0], 0.0))

    with HeadlessBrowser(chromium) as browser:
        if early:
            browser.open(meshcat.web_url())
            browser.wait_for("typeof viewer != 'undefined'")
        for x in (0.1, 0.2, 0.3):
            draw(x)
        if not early:
            browser.open(meshcat.web_url())
            browser.wait_for("typeof viewer != 'undefined'")
        draw(0.4)
        draw(0.5)
        # What comes last on the wire is there when all is.
        meshcat.SetTransform("/end", RigidTransform([1.0, 0, 0]))
        browser.wait_for("viewer.scene_tree.find(['end']).object.position.x == 1")
        assert browser.evaluate(
            "viewer.scene_tree.find(['arrows', '0']).object.position.x"
        ) == pytest.approx(0.5, abs=1e-6)
        assert browser.evaluate(SCALE) == pytest.approx(LENGTH_M, rel=1e-6)
        assert browser.errors == []


# The arrow of the torque as the page has it: whether it is seen, and its world matrix,
# whose third column goes from its begin to its end and whose last one is its begin.
TORQUE = """(() => {
  const arrow = viewer.scene_tree.find(['haptics', 'torque', '0', 'arrow', '0']).object;
  viewer.scene_tree.object.updateMatrixWorld(true);
  let seen = true;
  for (let part = arrow; part; part = part.parent) seen = seen && part.visible;
  return [seen, arrow.matrixWorld.elements];
})()"""


def draw_until(browser, visualizer, tau_W, expression):
    """Draws a torque until the page is so: a frame is left out after a slow one."""
    deadline = time.monotonic() + 120.0
    while not browser.evaluate(expression):
        assert time.monotonic() < deadline, browser.evaluate(TORQUE)
        visualizer.ForcedPublish(make_context(visualizer, tau_H_W=tau_W))


def test_the_torques_arrow_is_along_its_axis_and_as_long_as_its_share(chromium):
    meshcat = start_meshcat()
    visualizer = make_visualizer(meshcat)
    size_m = np.linalg.norm(np.ptp(make_mesh().vertices, axis=0))
    # three.js's world has y up: its axes are Drake's x, z, -y.
    R_TW = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    with HeadlessBrowser(chromium) as browser:
        browser.open(meshcat.web_url())
        browser.wait_for("typeof viewer != 'undefined'")
        for share, axis_W in [(0.5, [0.6, 0, -0.8]), (1.0, [0, -1.0, 0])]:
            tau_W = share * MAX_TORQUE_NM * np.array(axis_W)
            along_T = R_TW @ axis_W * share * size_m / 3
            is_so = (
                f"(([seen, m]) => seen && Math.hypot(m[8] - {along_T[0]},"
                f" m[9] - {along_T[1]}, m[10] - {along_T[2]}) < 1e-6)({TORQUE})"
            )
            draw_until(browser, visualizer, tau_W, is_so)
            begin_T = browser.evaluate(TORQUE)[1][12:15]
            np.testing.assert_allclose(begin_T, R_TW @ X_WH.translation(), atol=1e-9)
        # Nothing is drawn of none.
        draw_until(browser, visualizer, (0, 0, 0), f"!{TORQUE}[0]")
        assert browser.errors == []
