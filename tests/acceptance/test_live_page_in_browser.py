"""A page that is open while the loop draws shows things at their size."""

import numpy as np
import pytest
from headless_browser import HeadlessBrowser, find_browser
from pydrake.geometry import Rgba

from drake_haptics.systems.output.arrow_pool import ArrowPool
from drake_haptics.visualization.meshcat import open_meshcat

LENGTH_M = 0.02
# Length of the column of the world matrix along the arrow: its scale on the page.
SCALE = """(() => {
  const arrow = viewer.scene_tree.find(['arrows', '0', 'arrow', '0']).object;
  viewer.scene_tree.object.updateMatrixWorld(true);
  const m = arrow.matrixWorld.elements;
  return Math.hypot(m[8], m[9], m[10]);
})()"""


@pytest.mark.parametrize("early", [True, False])
def test_arrows_keep_their_size_however_they_move(early):
    """Whether the page was open from the start or came to a loop that runs."""
    executable = find_browser()
    if executable is None:
        pytest.skip("no Chromium on the PATH")
    meshcat = open_meshcat()
    pool = ArrowPool(meshcat, "/arrows", 1, [Rgba(1, 0, 0)])

    def draw(x):
        vector = np.array([[0, 0, LENGTH_M]])
        list(pool.draw([0], np.array([[x, 0, 0]]), vector, [0], 0.0))

    with HeadlessBrowser(executable) as browser:
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
        browser.wait_for(
            "Math.abs(viewer.scene_tree.find(['arrows', '0']).object.position.x - 0.5)"
            " < 1e-6"
        )
        assert browser.evaluate(SCALE) == pytest.approx(LENGTH_M, rel=1e-6)
        assert browser.errors == []
