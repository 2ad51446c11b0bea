"""The loop knows the camera of the page's picture, or that it does not know it."""

import numpy as np
import pytest
from meshcat_page import MeshcatPage
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.visualization.meshcat import start_meshcat
from drake_haptics.web.live_page import PageCamera, look_from_the_front

GUESS = look_from_the_front(np.zeros(3), 0.1)
# Meshcat's own, which a page sends as it opens, and one that a run has aimed.
OPENING = RigidTransform(RollPitchYaw(-1.9, 0.0, 0.0), [0.0, -3.0, 1.0])
AIMED = RigidTransform(RollPitchYaw(-2.2, 0.0, 0.6), [0.1, -0.14, 0.16])


def look(view, camera, X_WC):
    """Lets the page send a pose; returns where the loop then takes the camera to be."""
    view.send_camera(X_WC)
    # The loop looks again and again.
    camera.look()
    camera.look()
    return np.array(camera.numbers[9:])


def test_a_camera_that_is_aimed_is_not_that_with_which_a_page_opens():
    """Else a cup would have a scale of half a meter beside it for two seconds."""
    meshcat = start_meshcat()
    camera = PageCamera(meshcat, GUESS, is_aimed=True)
    camera.look()
    assert np.isnan(camera.numbers[9:]).all()
    with MeshcatPage(meshcat) as view:
        assert np.isnan(look(view, camera, OPENING)).all()
        assert look(view, camera, AIMED) == pytest.approx(AIMED.translation())
        assert look(view, camera, OPENING) == pytest.approx(OPENING.translation())
        look(view, camera, AIMED)
    camera.look()
    with MeshcatPage(meshcat) as view:
        assert look(view, camera, OPENING) == pytest.approx(AIMED.translation())
        assert look(view, camera, GUESS) == pytest.approx(GUESS.translation())


def test_a_camera_that_nobody_aims_is_known_at_once():
    meshcat = start_meshcat()
    camera = PageCamera(meshcat, GUESS, is_aimed=False)
    np.testing.assert_array_equal(camera.numbers[9:], GUESS.translation())
    with MeshcatPage(meshcat) as view:
        assert look(view, camera, OPENING) == pytest.approx(OPENING.translation())
